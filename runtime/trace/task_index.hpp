// SPDX-License-Identifier: Apache-2.0
// Finds tasks of a trace by what they are.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include "runtime/trace/trace.hpp"

namespace moraine::runtime {

/// The records must stay where they are. Cost: a hash table of all tasks.
class TaskIndex {
 public:
  explicit TaskIndex(std::span<const TaskRecord> tasks) {
    by_key_.reserve(tasks.size());
    for (const TaskRecord& t : tasks) by_key_.emplace(Key{t.epoch, t.in_epoch, t.sub_model, t.stage}, &t);
  }

  std::size_t size() const { return by_key_.size(); }
  const TaskRecord* find(std::uint32_t epoch, std::int32_t in_epoch, std::uint32_t sub_model,
                         std::int16_t stage) const {
    const auto found = by_key_.find({epoch, in_epoch, sub_model, stage});
    return found == by_key_.end() ? nullptr : found->second;
  }
  /// The task that released `t`; none if nothing did, or if it was not traced.
  const TaskRecord* releasing(const TaskRecord& t) const {
    if (t.release == Release::start) return nullptr;
    return find(t.epoch, t.in_epoch - (t.released_before ? 1 : 0), t.released_by, t.released_stage);
  }
  /// The stage before of the same sub-model, in this round or the one before.
  const TaskRecord* own_before(const TaskRecord& t, int stages) const {
    if (t.stage > 0) return find(t.epoch, t.in_epoch, t.sub_model, static_cast<std::int16_t>(t.stage - 1));
    return find(t.epoch, t.in_epoch - 1, t.sub_model, static_cast<std::int16_t>(stages - 1));
  }

 private:
  struct Key {
    std::uint32_t epoch;
    std::int32_t in_epoch;
    std::uint32_t sub_model;
    std::int16_t stage;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t x = (std::uint64_t{k.epoch} << 40) ^ (static_cast<std::uint64_t>(k.in_epoch) << 28) ^
                        (std::uint64_t{k.sub_model} << 4) ^ static_cast<std::uint64_t>(k.stage);
      x = (x ^ (x >> 31)) * 0xBF58476D1CE4E5B9ULL;
      return static_cast<std::size_t>(x ^ (x >> 29));
    }
  };
  std::unordered_map<Key, const TaskRecord*, Hash> by_key_;
};

}  // namespace moraine::runtime
