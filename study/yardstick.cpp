// SPDX-License-Identifier: Apache-2.0
#include "study/yardstick.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"

namespace moraine::study {
namespace {

void check_names(const Scene& scene) {
  for (const Expectation& e : scene.study.expect) find_observable(e.observable, e.place);
  for (const CountedObservable& c : scene.study.observables) find_observable(c.name, c.place);
}

/// What counts: what the scene names, else what it expects, else the usual.
std::vector<CountedObservable> counted(const Scene& scene) {
  if (!scene.study.observables.empty()) return scene.study.observables;
  std::vector<CountedObservable> all;
  for (const Expectation& e : scene.study.expect) all.push_back({e.observable, e.scale, e.place});
  if (!all.empty()) return all;
  for (const char* name : {"com_x", "com_y", "com_z", "x95", "z95", "overlap_mean"}) all.push_back({name, 0, ""});
  if (!scene.bonds.empty()) all.push_back({"bonds_broken", 0, ""});
  return all;
}

const Expectation* expected(const Scene& scene, std::string_view name) {
  const auto& all = scene.study.expect;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Expectation& e) { return e.observable == name; });
  return found == all.end() ? nullptr : &*found;
}

Comparison comparison(const Yardstick::Mark& mark, const Sample& measured) {
  return {std::string(mark.observable->name), measured, mark.reference, mark.scale};
}

}  // namespace

Sample sample_of(const Observable& observable, std::span<const Record> runs) {
  std::vector<double> values;
  for (const Record& r : runs)
    if (const auto value = value_of(observable, r.summary)) values.push_back(*value);
  return sample_of(values);
}

bool Yardstick::needs_reference(const Scene& scene) {
  check_names(scene);
  const std::vector<CountedObservable> all = counted(scene);
  return std::any_of(all.begin(), all.end(), [&](const CountedObservable& c) { return !expected(scene, c.name); });
}

Yardstick::Yardstick(const Scene& scene, std::span<const Record> runs) {
  const std::vector<CountedObservable> all = counted(scene);
  for (const Observable& o : observables()) {
    const auto count = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == o.name; });
    const Expectation* right = expected(scene, o.name);
    Mark mark{&o, 0, right ? exactly(right->value) : sample_of(o, runs), count != all.end()};
    if (!right && mark.reference.count == 0) {
      if (mark.counted) throw InputError(fmt::format("{}: the reference's result has no {}", scene.source, o.name));
      continue;
    }
    mark.scale = o.scale(scene, mark.reference.mean);
    if (mark.counted && count->scale > 0) mark.scale = count->scale;
    if (right && right->scale > 0) mark.scale = right->scale;
    marks_.push_back(mark);
  }
}

std::vector<Comparison> Yardstick::compare(std::span<const Record> runs) const {
  std::vector<Comparison> all;
  for (const Mark& m : marks_)
    if (const Sample s = sample_of(*m.observable, runs); s.count > 0) all.push_back(comparison(m, s));
  return all;
}

std::vector<Comparison> Yardstick::compare_counted(std::span<const Record> runs) const {
  std::vector<Comparison> all;
  for (const Mark& m : marks_)
    if (m.counted) all.push_back(comparison(m, sample_of(*m.observable, runs)));
  return all;
}

std::optional<double> Yardstick::noise() const {
  std::optional<double> most;
  for (const Mark& m : marks_)
    if (m.counted && m.reference.count > 1)
      most = std::max(most.value_or(0), deviation(comparison(m, m.reference)).uncertainty);
  return most;
}

}  // namespace moraine::study
