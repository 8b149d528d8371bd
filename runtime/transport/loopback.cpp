// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/loopback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "runtime/message_plan.hpp"

namespace moraine::runtime {

/// The letter box of the one task of a sub-model that is open.
class LoopbackTransport::Box final : public Port {
 public:
  Box(LoopbackTransport& owner, SubModelId id) : owner_(owner), id_(id) {}

  void open(int stage, std::int64_t round) {
    stage_ = stage;
    round_ = round;
    for (std::size_t i = first(owner_.first_out_); i < last(owner_.first_out_); ++i) clear(owner_.links_[i], i);
  }

  void close() {
    if (owner_.poison_ && !nothing_before())
      for (std::size_t i = first(owner_.first_in_); i < last(owner_.first_in_); ++i) destroy(slot_in(i));
  }

  std::span<const std::byte> received(SubModelId from) const override {
    const std::size_t i = find(owner_.from_, owner_.first_in_, from, "source");
    if (nothing_before()) return {};
    const Slot& slot = slot_in(i);
    const MessageHeader expected{receives(), from, id_, sent_round()};
    if (slot.header != expected) refuse(slot.header, expected);
    return slot.bytes;
  }

  void send(SubModelId to, std::span<const std::byte> bytes) override {
    Slot& slot = owner_.links_[find(owner_.to_, owner_.first_out_, to, "target")][parity(round_)];
    if (slot.sent) throw std::logic_error(fmt::format("sub-model {} sends twice to {} in stage {}", id_, to, stage_));
    slot.sent = true;
    slot.bytes.assign(bytes.begin(), bytes.end());
  }

 private:
  static std::size_t parity(std::int64_t round) { return static_cast<std::size_t>(round & 1); }
  std::size_t first(const std::vector<std::size_t>& offsets) const { return offsets[owner_.node(id_, stage_)]; }
  std::size_t last(const std::vector<std::size_t>& offsets) const { return offsets[owner_.node(id_, stage_) + 1]; }
  int receives() const { return owner_.receives_[static_cast<std::size_t>(stage_)]; }
  std::int64_t sent_round() const { return receives() < stage_ ? round_ : round_ - 1; }
  bool nothing_before() const { return sent_round() < 0; }
  Slot& slot_in(std::size_t i) const { return owner_.links_[owner_.in_[i]][parity(sent_round())]; }

  void clear(Link& link, std::size_t i) const {
    Slot& slot = link[parity(round_)];
    slot.header = {stage_, id_, owner_.to_[i], round_};
    slot.sent = false;
    slot.bytes.clear();
  }

  static void destroy(Slot& slot) {
    slot.header = {};
    std::fill(slot.bytes.begin(), slot.bytes.end(), std::byte{0xDB});
  }

  std::size_t find(const std::vector<SubModelId>& ids, const std::vector<std::size_t>& offsets, SubModelId id,
                   const char* what) const {
    const auto begin = ids.begin() + static_cast<std::ptrdiff_t>(first(offsets));
    const auto end = ids.begin() + static_cast<std::ptrdiff_t>(last(offsets));
    const auto at = std::lower_bound(begin, end, id);
    if (at == end || *at != id)
      throw std::logic_error(fmt::format("sub-model {} is not a {} of {} in stage {}", id, what, id_, stage_));
    return static_cast<std::size_t>(at - ids.begin());
  }

  [[noreturn]] static void refuse(const MessageHeader& got, const MessageHeader& expected) {
    const auto text = [](const MessageHeader& h) {
      return fmt::format("stage {} {} -> {} round {}", h.stage, h.from, h.to, h.round);
    };
    throw std::logic_error(fmt::format("expected the message of {}, found {}", text(expected), text(got)));
  }

  LoopbackTransport& owner_;
  SubModelId id_;
  int stage_ = 0;
  std::int64_t round_ = 0;
};

LoopbackTransport::LoopbackTransport(bool poison) : poison_(poison) {}
LoopbackTransport::~LoopbackTransport() = default;

std::size_t LoopbackTransport::node(SubModelId sub_model, int stage) const {
  return sub_model * stages_ + static_cast<std::size_t>(stage);
}

void LoopbackTransport::lay_out(Model& model) {
  const std::vector<Message> plan = plan_messages(model);
  const std::size_t nodes = model.size() * stages_;
  links_.resize(plan.size());
  to_.resize(plan.size());
  from_.resize(plan.size());
  in_.resize(plan.size());
  first_out_.assign(nodes + 1, 0);
  first_in_.assign(nodes + 1, 0);
  for (const Message& m : plan) {
    ++first_out_[node(m.from, m.sent_in) + 1];
    ++first_in_[node(m.to, m.read_in) + 1];
  }
  std::partial_sum(first_out_.begin(), first_out_.end(), first_out_.begin());
  std::partial_sum(first_in_.begin(), first_in_.end(), first_in_.begin());
  // The plan ascends by sender, so a receiver's list does too.
  std::vector<std::size_t> free(first_in_.begin(), first_in_.end());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const std::size_t at = free[node(plan[i].to, plan[i].read_in)]++;
    in_[at] = i;
    from_[at] = plan[i].from;
    to_[i] = plan[i].to;
    links_[i][0].header = links_[i][1].header = {};
  }
}

void LoopbackTransport::begin_epoch(Model& model) {
  stages_ = model.stages().size();
  receives_.clear();
  for (const Stage& stage : model.stages()) receives_.push_back(stage.receives);
  lay_out(model);
  box_.resize(std::min(box_.size(), model.size()));
  while (box_.size() < model.size()) box_.push_back(std::make_unique<Box>(*this, static_cast<SubModelId>(box_.size())));
}

Port& LoopbackTransport::open(SubModelId sub_model, int stage, std::int64_t round) {
  box_[sub_model]->open(stage, round);
  return *box_[sub_model];
}

void LoopbackTransport::close(SubModelId sub_model) { box_[sub_model]->close(); }

}  // namespace moraine::runtime
