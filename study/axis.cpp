// SPDX-License-Identifier: Apache-2.0
#include "study/axis.hpp"

#include <algorithm>
#include <array>

namespace moraine::study {
namespace {

constexpr std::array names{
    ShortName{"engine", "run.engine", "--engine"},
    ShortName{"dt", "time.dt", "--dt"},
    ShortName{"steps", "time.steps", "--steps"},
    ShortName{"substeps", "time.substeps", "--substeps"},
    ShortName{"iterations", "run.iterations", "--iterations"},
    ShortName{"sub_models", "run.sub_models", "--sub-models"},
    ShortName{"split", "run.split", "--split"},
    ShortName{"coupling", "run.coupling", "--coupling"},
    ShortName{"threads", "run.threads", "--threads"},
    ShortName{"overlap_recovery", "run.overlap_recovery", ""},
    ShortName{"skip_threshold", "run.skip_threshold", "--skip-threshold"},
    ShortName{"skin", "run.skin", ""},
};

bool contains(const std::vector<std::string>& list, const std::string& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// By its short name or its whole key.
Axis* find(AxisBlock& block, std::string_view name) {
  const std::string key = key_of(name);
  const auto found = std::find_if(block.begin(), block.end(), [&](const Axis& a) { return key_of(a.key) == key; });
  return found == block.end() ? nullptr : &*found;
}

void narrow_engines(std::vector<AxisBlock>& blocks, const Axis& engines) {
  std::vector<AxisBlock> kept;
  std::vector<std::string> missing = engines.values;
  for (AxisBlock& block : blocks) {
    Axis* own = find(block, "engine");
    if (!own) own = &block.emplace_back(engines);
    std::erase_if(own->values, [&](const std::string& e) { return !contains(engines.values, e); });
    if (own->values.empty()) continue;
    std::erase_if(missing, [&](const std::string& e) { return contains(own->values, e); });
    kept.push_back(block);
  }
  for (const std::string& engine : missing) kept.push_back({{"engine", {engine}, engines.place}});
  blocks = std::move(kept);
}

void add_combinations(const AxisBlock& block, std::size_t axis, Choices& so_far, std::vector<Choices>& all) {
  if (axis == block.size()) {
    all.push_back(so_far);
    return;
  }
  for (const std::string& value : block[axis].values) {
    so_far.push_back({block[axis].key, value, block[axis].place});
    add_combinations(block, axis + 1, so_far, all);
    so_far.pop_back();
  }
}

}  // namespace

std::span<const ShortName> short_names() { return names; }

std::string key_of(std::string_view name) {
  for (const ShortName& n : names)
    if (n.name == name) return std::string(n.key);
  return std::string(name);
}

std::optional<std::string_view> flag_of(std::string_view key) {
  for (const ShortName& n : names)
    if (n.key == key && !n.flag.empty()) return n.flag;
  return std::nullopt;
}

std::vector<Choices> combinations(std::span<const AxisBlock> blocks) {
  std::vector<Choices> all;
  for (const AxisBlock& block : blocks) {
    Choices none;
    add_combinations(block, 0, none, all);
  }
  return all;
}

void narrow(std::vector<AxisBlock>& blocks, const Axis& axis) {
  const std::string key = key_of(axis.key);
  if (key == "run.engine") return narrow_engines(blocks, axis);
  for (AxisBlock& block : blocks) {
    if (key == "time.substeps") std::erase_if(block, [](const Axis& a) { return a.key == limit_share; });
    if (Axis* own = find(block, axis.key)) {
      *own = axis;
    } else {
      block.push_back(axis);
    }
  }
}

}  // namespace moraine::study
