// SPDX-License-Identifier: Apache-2.0
// A model whose sub-models only talk, check all they hear, and remember it: whatever goes wrong throws or changes them.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runtime/records.hpp"
#include "runtime/sub_model.hpp"

namespace moraine::runtime::test {

inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = (a ^ (b + 0x9E3779B97F4A7C15ULL)) * 0xBF58476D1CE4E5B9ULL;
  return x ^ (x >> 29);
}

struct Rumour {
  SubModelId from = 0;
  int stage = 0;
  std::int64_t number = 0;
  std::int64_t in_epoch = 0;
  std::uint64_t memory = 0;
};

class Gossip final : public SubModel {
 public:
  Gossip(SubModelId id, const std::vector<Stage>& stages) : memory(id), id_(id), stages_(stages) { forget_links(); }

  std::span<const SubModelId> sources(int stage) const override { return sources_of[index(stage)]; }
  std::span<const SubModelId> targets(int stage) const override { return targets_of[index(stage)]; }
  double counted_work(int stage) const override { return cost ? cost(stage) : 1.0; }
  void save(std::vector<std::byte>& out) const override {
    write_records(out, std::vector{memory});
    write_records(out, std::vector{last_});
  }
  void load(std::span<const std::byte> in) override {
    memory = read_records<std::uint64_t>(in).at(0);
    last_ = read_records<Round>(in).at(0);
    last_stage_ = static_cast<int>(stages_.size()) - 1;
  }

  void run(int stage, const Round& round, Port& port) override {
    if (running_.exchange(true)) throw std::logic_error("two tasks of one sub-model at once");
    check_order(stage, round);
    for (const SubModelId from : sources(stage)) listen(stage, round, from, port.received(from));
    if (on_task) on_task(stage, round);
    memory = mix(memory, static_cast<std::uint64_t>(round.number * 16 + stage));
    const Rumour rumour{id_, stage, round.number, round.in_epoch, memory};
    for (const SubModelId to : targets(stage))
      if (speaks(rumour, to)) port.send(to, std::as_bytes(std::span(&rumour, 1)));
    running_ = false;
  }

  void forget_links() {
    sources_of.assign(stages_.size(), {});
    targets_of.assign(stages_.size(), {});
  }

  std::uint64_t memory;
  std::vector<std::vector<SubModelId>> sources_of;
  std::vector<std::vector<SubModelId>> targets_of;
  std::function<double(int)> cost;
  std::function<void(int, const Round&)> on_task;

 private:
  static std::size_t index(int stage) { return static_cast<std::size_t>(stage); }

  /// Now and then one has nothing to say.
  static bool speaks(const Rumour& r, SubModelId to) {
    return mix(r.from * 64U + to, static_cast<std::uint64_t>(r.in_epoch)) % 5 != 0;
  }

  void check_order(int stage, const Round& round) {
    const bool next_stage = stage == last_stage_ + 1 && round.in_epoch == last_.in_epoch;
    const bool next_round = stage == 0 && round.in_epoch == last_.in_epoch + 1;
    const bool next_epoch = stage == 0 && round.opening();
    const bool last_was_last = last_stage_ + 1 == static_cast<int>(stages_.size());
    if (!next_stage && !(last_was_last && (next_round || next_epoch))) throw std::logic_error("stages out of order");
    last_stage_ = stage;
    last_ = round;
  }

  void listen(int stage, const Round& round, SubModelId from, std::span<const std::byte> bytes) {
    const int said_in = stages_[index(stage)].receives;
    const std::int64_t in_epoch = round.in_epoch - (said_in < stage ? 0 : 1);
    Rumour expected{from, said_in, 0, in_epoch, 0};
    const bool silent = in_epoch < 0 || !speaks(expected, id_);
    if (silent != bytes.empty()) throw std::logic_error("a message is missing or comes from nowhere");
    if (silent) return;
    Rumour heard;
    if (bytes.size() != sizeof heard) throw std::logic_error("a message has the wrong size");
    std::memcpy(&heard, bytes.data(), sizeof heard);
    if (heard.from != from || heard.stage != said_in || heard.in_epoch != in_epoch)
      throw std::logic_error("a message of another sender, stage or round");
    memory = mix(memory, heard.memory);
  }

  SubModelId id_;
  const std::vector<Stage>& stages_;
  std::atomic<bool> running_ = false;
  int last_stage_ = static_cast<int>(stages_.size()) - 1;
  Round last_{-1, -1};
};

class GossipModel : public Model {
 public:
  GossipModel(std::size_t size, std::vector<Stage> stages) : stages_(std::move(stages)) {
    for (SubModelId id = 0; id < size; ++id) members_.push_back(std::make_unique<Gossip>(id, stages_));
  }

  std::span<const Stage> stages() const override { return stages_; }
  std::size_t size() const override { return members_.size(); }
  Gossip& sub_model(SubModelId id) override { return *members_[id]; }
  EpochPlan begin_epoch(std::int64_t, std::int64_t at_most) override { return {at_most}; }

  /// What `from` says in the stage that `read_in` receives from now goes to `to`. Call in ascending order.
  void link(SubModelId from, SubModelId to, int read_in) {
    const int sent_in = stages_[static_cast<std::size_t>(read_in)].receives;
    members_[from]->targets_of[static_cast<std::size_t>(sent_in)].push_back(to);
    members_[to]->sources_of[static_cast<std::size_t>(read_in)].push_back(from);
  }

  std::vector<std::uint64_t> memories() const {
    std::vector<std::uint64_t> out;
    for (const auto& member : members_) out.push_back(member->memory);
    return out;
  }

 private:
  std::vector<Stage> stages_;
  std::vector<std::unique_ptr<Gossip>> members_;
};

/// Up to five stages, each with at most one reader, before or after it.
inline std::vector<Stage> random_stages(std::mt19937& random) {
  static constexpr const char* names[] = {"a", "b", "c", "d", "e"};
  const std::size_t count = 1 + random() % 5;
  std::vector<int> unread;
  for (std::size_t s = 0; s < count; ++s) unread.push_back(static_cast<int>(s));
  std::vector<Stage> stages;
  for (std::size_t t = 0; t < count; ++t) {
    stages.push_back({names[t], Stage::none});
    if (random() % 3 == 0) continue;
    const auto chosen = unread.begin() + static_cast<std::ptrdiff_t>(random() % unread.size());
    stages.back().receives = *chosen;
    unread.erase(chosen);
  }
  return stages;
}

/// Other neighbours in every epoch, many of them in one direction only, some talking to themselves.
class RandomGossip final : public GossipModel {
 public:
  RandomGossip(unsigned seed, std::size_t size) : RandomGossip(std::mt19937(seed), seed, size) {}

  EpochPlan begin_epoch(std::int64_t next_round, std::int64_t at_most) override {
    std::mt19937 random(seed_ * 7919U + static_cast<unsigned>(next_round));
    for (SubModelId id = 0; id < size(); ++id) sub_model(id).forget_links();
    for (int t = 0; t < static_cast<int>(stages().size()); ++t) {
      if (stages()[static_cast<std::size_t>(t)].receives == Stage::none) continue;
      for (SubModelId from = 0; from < size(); ++from)
        for (SubModelId to = 0; to < size(); ++to)
          if (random() % size() < 2) link(from, to, t);
    }
    return {std::min<std::int64_t>(at_most, 1 + random() % 9)};
  }

 private:
  RandomGossip(std::mt19937 random, unsigned seed, std::size_t size)
      : GossipModel(size, random_stages(random)), seed_(seed) {}
  unsigned seed_;
};

}  // namespace moraine::runtime::test
