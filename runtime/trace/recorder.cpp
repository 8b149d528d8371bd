// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/recorder.hpp"

#include "runtime/trace/chrome.hpp"

namespace moraine::runtime {
namespace {

constexpr std::int64_t rounds_per_flush = 256;

}  // namespace

Recorder::Recorder(const TraceOptions& options, const TraceSettings& settings, Transport& transport, int workers)
    : options_(options), transport_(transport), buffers_(static_cast<std::size_t>(workers)) {
  if (transport.rank() == 0) writer_.emplace(raw_file(), settings);
}

Recorder::~Recorder() {
  if (!writer_ || !is_chrome_file(options_.file)) return;
  try {
    if (unconverted_) make_json();
    std::filesystem::remove(raw_file());
  } catch (...) {  // the compact form stays
  }
}

/// JSON is made from the compact form when all is known, or when the run has failed.
std::filesystem::path Recorder::raw_file() const {
  std::filesystem::path file = options_.file;
  return is_chrome_file(file) ? file.replace_extension(".part") : file;
}

bool Recorder::in_window(const Epoch& epoch) const {
  const std::int64_t first = epoch.first_round / options_.rounds_per_step;
  const std::int64_t last = (epoch.first_round + epoch.rounds - 1) / options_.rounds_per_step;
  return last >= options_.from && (options_.to < 0 || first < options_.to);
}

void Recorder::begin_epoch(const Epoch& epoch) { recording_ = in_window(epoch) && in_window_++ % options_.every == 0; }

void Recorder::task_done(const TaskRecord& record) {
  Buffer& buffer = at(record.worker);
  TaskRecord& kept = buffer.tasks.emplace_back(record);
  kept.rank = transport_.rank();
  kept.epoch = epoch_;
  kept.bytes_sent = static_cast<std::uint32_t>(buffer.carried.bytes.sent);
  kept.bytes_received = static_cast<std::uint32_t>(buffer.carried.bytes.received);
  kept.counters = buffer.carried.counters;
}

void Recorder::plan(Model& model, const StepGraph& graph, const Epoch& epoch) {
  if (!recording_) return;
  if (transport_.rank() == 0) lists_.epochs.push_back({epoch.first_round, epoch.rounds, epoch_});
  for (const SubModelId id : graph.ids)
    lists_.owners.push_back({epoch_, id, transport_.rank(), 0, model.sub_model(id).memory()});
  for (NodeId node = 0; node < graph.node_count(); ++node)
    lists_.costs.push_back({epoch_, graph.sub_model(node), graph.stage(node), 0, graph.cost[node]});
}

void Recorder::sent(const std::vector<Mail::Sent>& messages) {
  if (!recording_) return;
  for (const Mail::Sent& s : messages)
    lists_.messages.push_back({epoch_, s.message.from, s.message.to, static_cast<std::int16_t>(s.message.sent_in),
                               static_cast<std::int16_t>(s.message.read_in), s.messages, s.bytes});
}

void Recorder::balanced(const BalanceRoundRecord& round, const std::vector<MoveRecord>& moves) {
  if (!recording_ || transport_.rank() != 0) return;
  lists_.balance.push_back(round);
  lists_.balance.back().epoch = epoch_;
  for (const MoveRecord& m : moves) lists_.moves.emplace_back(m).epoch = epoch_;
}

void Recorder::end_epoch(std::vector<PhaseRecord> phases, const Epoch& epoch) {
  for (PhaseRecord& p : phases) {
    p.epoch = epoch_;
    p.rank = transport_.rank();
  }
  if (recording_) {
    lists_.phases.insert(lists_.phases.end(), phases.begin(), phases.end());
    unwritten_rounds_ += epoch.rounds;
  }
  ++epoch_;
  if (unwritten_rounds_ >= rounds_per_flush) flush();
}

void Recorder::collect_tasks() {
  for (Buffer& buffer : buffers_) {
    lists_.tasks.insert(lists_.tasks.end(), buffer.tasks.begin(), buffer.tasks.end());
    buffer.tasks.clear();
  }
}

void Recorder::flush() {
  collect_tasks();
  unconverted_ = true;
  for (const Bytes& packed : transport_.gather(0, pack(lists_))) writer_->append(packed);
  lists_ = {};
  unwritten_rounds_ = 0;
}

void Recorder::finish() {
  flush();
  if (!writer_) return;
  writer_->finish();
  if (is_chrome_file(options_.file)) make_json();
}

void Recorder::make_json() {
  write_chrome(read_trace_file(raw_file()), options_.file);
  unconverted_ = false;
}

}  // namespace moraine::runtime
