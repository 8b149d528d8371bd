// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/mail.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace moraine::runtime {
namespace {

std::size_t parity(std::int64_t round) { return static_cast<std::size_t>(round & 1); }

std::string text(const Envelope& e) {
  return fmt::format("stage {} {} -> {} round {} of epoch {}", e.stage, e.from, e.to, e.round, e.epoch);
}

}  // namespace

/// The letter box of the one task of a sub-model that is open.
class Mail::Box final : public Port {
 public:
  Box(Mail& owner, SubModelId id) : owner_(owner), id_(id) {}

  void open(int stage, std::int64_t round) {
    stage_ = stage;
    round_ = round;
    for (std::size_t i = first(owner_.first_out_); i < last(owner_.first_out_); ++i) clear(line_out(i));
  }

  Carried close() {
    Carried carried;
    for (std::size_t i = first(owner_.first_out_); i < last(owner_.first_out_); ++i)
      carried.sent += owner_.post(line_out(i), round_);
    for (std::size_t i = first(owner_.first_in_); i < last(owner_.first_in_); ++i) {
      if (!nothing_before()) carried.received += slot_in(i).bytes.size();
      if (owner_.poison_ && !nothing_before()) destroy(slot_in(i));
      owner_.was_read(owner_.in_[i], sent_round());
    }
    return carried;
  }

  std::span<const std::byte> received(SubModelId from) const override {
    const std::size_t i = find(owner_.from_, owner_.first_in_, from, "source");
    if (nothing_before()) return {};
    const Slot& slot = slot_in(i);
    const Envelope expected{receives(), from, id_, sent_round(), owner_.epoch_};
    if (slot.envelope != expected) refuse(slot.envelope, expected);
    return slot.bytes;
  }

  void send(SubModelId to, std::span<const std::byte> bytes) override {
    Slot& slot = line_out(find(owner_.to_, owner_.first_out_, to, "target")).slots[parity(round_)];
    if (slot.sent) throw std::logic_error(fmt::format("sub-model {} sends twice to {} in stage {}", id_, to, stage_));
    slot.sent = true;
    slot.bytes.assign(bytes.begin(), bytes.end());
  }

 private:
  std::size_t first(const std::vector<std::size_t>& offsets) const { return offsets[owner_.node(id_, stage_)]; }
  std::size_t last(const std::vector<std::size_t>& offsets) const { return offsets[owner_.node(id_, stage_) + 1]; }
  int receives() const { return owner_.receives_[static_cast<std::size_t>(stage_)]; }
  std::int64_t sent_round() const { return receives() < stage_ ? round_ : round_ - 1; }
  bool nothing_before() const { return sent_round() < 0; }
  Line& line_out(std::size_t i) const { return owner_.lines_[owner_.out_[i]]; }
  Slot& slot_in(std::size_t i) const { return owner_.lines_[owner_.in_[i]].slots[parity(sent_round())]; }

  void clear(Line& line) const {
    Slot& slot = line.slots[parity(round_)];
    slot.envelope = {stage_, id_, line.message.to, round_, owner_.epoch_};
    slot.sent = false;
    slot.bytes.clear();
  }

  static void destroy(Slot& slot) {
    slot.envelope = {};
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

  [[noreturn]] static void refuse(const Envelope& got, const Envelope& expected) {
    throw std::logic_error(fmt::format("expected the message of {}, found {}", text(expected), text(got)));
  }

  Mail& owner_;
  SubModelId id_;
  int stage_ = 0;
  std::int64_t round_ = 0;
};

Mail::Mail(Transport& transport, bool poison, RunClock clock) : transport_(transport), poison_(poison), clock_(clock) {}
Mail::~Mail() = default;

std::size_t Mail::node(SubModelId sub_model, int stage) const {
  return sub_model * stages_ + static_cast<std::size_t>(stage);
}

void Mail::lay_out(Model& model) {
  const std::vector<Message> plan = plan_messages(model);
  const Placement& placement = model.placement();
  const std::size_t nodes = model.size() * stages_;
  lines_.resize(plan.size());
  first_out_.assign(nodes + 1, 0);
  first_in_.assign(nodes + 1, 0);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Message& m = plan[i];
    Line& line = lines_[i];
    line.message = m;
    line.from_here = placement.holds(m.from);
    line.to_rank = placement.holds(m.to) ? placement.rank : placement.owner[m.to];
    line.messages = line.bytes = 0;
    line.slots[0].envelope = line.slots[1].envelope = {};
    if (line.from_here) ++first_out_[node(m.from, m.sent_in) + 1];
    if (line.to_rank == placement.rank) ++first_in_[node(m.to, m.read_in) + 1];
  }
  std::partial_sum(first_out_.begin(), first_out_.end(), first_out_.begin());
  std::partial_sum(first_in_.begin(), first_in_.end(), first_in_.begin());
  out_.resize(first_out_.back());
  to_.resize(first_out_.back());
  in_.resize(first_in_.back());
  from_.resize(first_in_.back());
  // The plan ascends by sender, then by receiver, so both lists do.
  std::vector<std::size_t> free_out(first_out_.begin(), first_out_.end()), free_in(first_in_.begin(), first_in_.end());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Message& m = plan[i];
    if (lines_[i].from_here) {
      const std::size_t at = free_out[node(m.from, m.sent_in)]++;
      out_[at] = i;
      to_[at] = m.to;
    }
    if (lines_[i].to_rank == placement.rank) {
      const std::size_t at = free_in[node(m.to, m.read_in)]++;
      in_[at] = i;
      from_[at] = m.from;
    }
  }
}

void Mail::begin_epoch(Model& model, const Epoch& epoch) {
  ++epoch_;
  rounds_ = epoch.rounds_with_opening();
  stages_ = model.stages().size();
  receives_.clear();
  for (const Stage& stage : model.stages()) receives_.push_back(stage.receives);
  lay_out(model);
  box_.resize(std::min(box_.size(), model.size()));
  while (box_.size() < model.size()) box_.push_back(std::make_unique<Box>(*this, static_cast<SubModelId>(box_.size())));
  const std::lock_guard lock(mutex_);
  arrivals_.assign(lines_.size(), {});
  for (std::size_t i = 0; i < lines_.size(); ++i) arrivals_[i].unread[1] = lines_[i].message.next_round();
  ready_.clear();
}

Port& Mail::open(SubModelId sub_model, int stage, std::int64_t round) {
  box_[sub_model]->open(stage, round);
  return *box_[sub_model];
}

Mail::Carried Mail::close(SubModelId sub_model) { return box_[sub_model]->close(); }

/// A message for the round after the last one has no reader. Returns its length.
std::uint64_t Mail::post(Line& line, std::int64_t round) {
  const Slot& slot = line.slots[parity(round)];
  ++line.messages;
  line.bytes += slot.bytes.size();
  const bool travels = line.to_rank != transport_.rank() && !(line.message.next_round() && round + 1 == rounds_);
  if (travels) transport_.send(line.to_rank, pack(slot.envelope, clock_.now(), slot.bytes));
  return slot.bytes.size();
}

void Mail::poll(const StepGraph& graph, std::vector<Arrival>& arrived) {
  while (const std::optional<Parcel> parcel = transport_.receive()) take_in(*parcel);
  const std::lock_guard lock(mutex_);
  for (const Ready& r : ready_)
    arrived.push_back({{graph.node(graph.place_of(r.message.to), r.message.read_in), r.round},
                       r.message.from,
                       r.message.sent_in,
                       r.sent_at});
  ready_.clear();
}

void Mail::take_in(const Parcel& parcel) {
  const auto [envelope, sent_at, content] = unpack(parcel);
  const std::size_t line = line_of(envelope);
  Slot slot;
  slot.envelope = envelope;
  slot.sent = true;
  slot.sent_at = sent_at;
  slot.bytes.assign(content.begin(), content.end());
  const std::lock_guard lock(mutex_);
  arrivals_[line].waiting.push_back(std::move(slot));
  deliver(line);
}

std::size_t Mail::line_of(const Envelope& e) const {
  const auto at = std::lower_bound(lines_.begin(), lines_.end(), Message{e.from, e.stage, e.to, 0},
                                   [](const Line& line, const Message& m) { return line.message < m; });
  const bool known = at != lines_.end() && at->message.from == e.from && at->message.sent_in == e.stage &&
                     at->message.to == e.to && !at->from_here;
  if (!known || e.epoch != epoch_) throw std::logic_error(fmt::format("nobody expects the message of {}", text(e)));
  return static_cast<std::size_t>(at - lines_.begin());
}

/// Moves what waits into slots that have been read.
void Mail::deliver(std::size_t line) {
  Arrivals& arrivals = arrivals_[line];
  while (!arrivals.waiting.empty()) {
    Slot& next = arrivals.waiting.front();
    const std::int64_t round = next.envelope.round;
    if (arrivals.unread[parity(round)]) return;
    arrivals.unread[parity(round)] = true;
    ready_.push_back({lines_[line].message, lines_[line].message.next_round() ? round + 1 : round, next.sent_at});
    lines_[line].slots[parity(round)] = std::move(next);
    arrivals.waiting.pop_front();
  }
}

void Mail::was_read(std::size_t line, std::int64_t sent_round) {
  if (lines_[line].from_here) return;
  const std::lock_guard lock(mutex_);
  arrivals_[line].unread[parity(sent_round)] = false;
  deliver(line);
}

std::vector<Mail::Sent> Mail::sent() const {
  std::vector<Sent> out;
  for (const Line& line : lines_)
    if (line.from_here) out.push_back({line.message, line.messages, line.bytes});
  return out;
}

void Mail::close_epoch() {
  ++totals_.epochs;
  for (const Line& line : lines_) {
    if (!line.from_here) continue;
    totals_.messages += static_cast<double>(line.messages);
    totals_.bytes += static_cast<double>(line.bytes);
    totals_.between_ranks += line.to_rank == transport_.rank() ? 0 : static_cast<double>(line.messages);
    ++totals_.pairs;
  }
}

}  // namespace moraine::runtime
