// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "physics/errors.hpp"

namespace moraine {

PlacedShape Draft::add_shape(Geometry geometry) {
  const auto next = static_cast<std::uint32_t>(scene.shapes.size());
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) {
    if (const auto known = spheres_.find(sphere->radius); known != spheres_.end()) return {known->second, {}};
    scene.shapes.push_back(make_shape(geometry));
    spheres_.emplace(sphere->radius, next);
    return {next, {}};
  }
  PlacedShape placed{next, {}};
  scene.shapes.push_back(make_shape(std::move(geometry), &placed.frame));
  return placed;
}

std::uint32_t Draft::add_source(const std::string& text) {
  sources_.push_back(text);
  return static_cast<std::uint32_t>(sources_.size() - 1);
}

std::string Draft::place(const Source& source) const {
  return source.line > 0 ? fmt::format("{}:{}", sources_[source.text], source.line) : sources_[source.text];
}

void Draft::add_element(Element element, std::optional<ElementId> id, const Source& source) {
  const std::uint64_t chosen = id ? *id : next_id_;
  if (chosen >= UINT32_MAX)
    throw InputError(fmt::format("{}: ids run out, expected at most {}", place(source), UINT32_MAX - 1));
  if (!std::isfinite(element.mass) || !(element.mass > 0)) {
    throw InputError(fmt::format("{}: the mass of element {} is {}, expected positive and finite", place(source),
                                 chosen, element.mass));
  }
  element.id = static_cast<ElementId>(chosen);
  next_id_ = std::max(next_id_, chosen + 1);
  scene.elements.push_back(element);
  element_sources_.push_back(source);
}

void Draft::finish_elements() {
  std::vector<Element>& elements = scene.elements;
  std::vector<std::uint32_t> order(elements.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto by_id = [&](std::uint32_t a, std::uint32_t b) { return elements[a].id < elements[b].id; };
  const bool sorted = std::is_sorted(order.begin(), order.end(), by_id);
  if (!sorted) std::stable_sort(order.begin(), order.end(), by_id);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (elements[order[i]].id != elements[order[i - 1]].id) continue;
    throw InputError(fmt::format("{}: the id {} is given twice, first at {}; expected one element per id",
                                 place(element_sources_[order[i]]), elements[order[i]].id,
                                 place(element_sources_[order[i - 1]])));
  }
  if (sorted) return;
  std::vector<Element> ascending;
  ascending.reserve(elements.size());
  for (const std::uint32_t i : order) ascending.push_back(elements[i]);
  elements = std::move(ascending);
}

}  // namespace moraine
