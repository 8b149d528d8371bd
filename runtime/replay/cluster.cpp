// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/cluster.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <memory>
#include <queue>
#include <tuple>

#include "runtime/schedule/dispatcher.hpp"
#include "runtime/schedule/registry.hpp"

namespace moraine::runtime {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// What is known of a rank while it runs. Its address must not change: the dispatcher refers to its members.
struct Rank {
  Rank(const SchedulerRow& row, StepGraph own, int threads, std::int64_t rounds)
      : graph(std::move(own)),
        scheduler(row.make()),
        dispatcher(*scheduler, graph, threads, rounds),
        free_since(static_cast<std::size_t>(threads), -1.0) {}

  StepGraph graph;
  std::unique_ptr<Scheduler> scheduler;
  Dispatcher dispatcher;
  std::vector<double> free_since;  ///< per worker; negative: since the start
  double sends_until = 0;          ///< its network is busy
};

/// A task that has a core until `end`.
struct Running {
  double end = 0;
  int rank = 0;
  int worker = 0;
  Task task;
  double seconds = 0;
  bool operator<(const Running& o) const { return std::tie(end, rank, worker) > std::tie(o.end, o.rank, o.worker); }
};

/// A message between ranks on its way. Those of a sender and stage arrive in the order of rounds.
struct Travelling {
  double arrival = 0;
  std::uint32_t message = 0;  ///< place in the model's list
  std::int32_t round = 0;
  bool operator<(const Travelling& o) const {
    return std::tie(arrival, round, message) > std::tie(o.arrival, o.round, o.message);
  }
};

/// Rounds of a message's life at its reader. It has two slots, so the message of a round waits until that of two rounds
/// before has been read; messages for the opening round's readers of the round before count as empty ones to be read.
struct Line {
  std::int32_t arrived = -1, delivered = -1, read = -1;
};

class Cluster {
 public:
  Cluster(RecordedModel& model, const Machine& machine, std::int64_t rounds)
      : model_(model), machine_(machine), rounds_(rounds), lines_(model.messages().size()) {
    const SchedulerRow& row = find_scheduler(machine.scheduler);
    owner_ = model.placement().owner;
    out_.busy.assign(static_cast<std::size_t>(machine.ranks), 0.0);
    out_.seconds.assign(model.size(), 0.0);
    for (int rank = 0; rank < machine.ranks; ++rank) {
      model.look_at(rank);
      ranks_.push_back(std::make_unique<Rank>(row, build_step_graph(model), machine.threads, rounds));
    }
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (model.messages()[i].message.next_round()) lines_[i].read = -2;
  }

  ClusterRun run() {
    for (int rank = 0; rank < machine_.ranks; ++rank) {
      ranks_[static_cast<std::size_t>(rank)]->dispatcher.start(starting_);
      begin(rank);
    }
    while (!running_.empty() || !travelling_.empty()) step();
    check_done();
    return std::move(out_);
  }

 private:
  /// What comes first: a task's end or a message.
  void step() {
    const double end = running_.empty() ? never : running_.top().end;
    const double arrival = travelling_.empty() ? never : travelling_.top().arrival;
    now_ = std::max(now_, std::min(end, arrival));
    arrival < end ? arrive() : finish();
  }

  /// `task.end`: seconds that it takes.
  void run(Running task) {
    if (machine_.cores > 0 && running_.size() >= static_cast<std::size_t>(machine_.cores)) {
      waiting_.push_back(task);
      return;
    }
    task.end += now_;
    running_.push(task);
  }

  /// A core that is free takes the task that has waited longest.
  void serve_waiting() {
    if (waiting_.empty() || running_.size() >= static_cast<std::size_t>(machine_.cores)) return;
    const Running task = waiting_.front();
    waiting_.pop_front();
    run(task);
  }

  void finish() {
    const Running ended = running_.top();
    running_.pop();
    Rank& rank = *ranks_[static_cast<std::size_t>(ended.rank)];
    out_.elapsed = now_;
    out_.busy[static_cast<std::size_t>(ended.rank)] += ended.seconds;
    ++out_.tasks;
    rank.free_since[static_cast<std::size_t>(ended.worker)] = now_;
    const SubModelId id = rank.graph.sub_model(ended.task.node);
    out_.seconds[id] += ended.seconds;
    const std::size_t node = model_.node(id, rank.graph.stage(ended.task.node));
    send(ended.rank, node, ended.task.round);
    serve_waiting();
    rank.dispatcher.finish(ended.task, ended.worker, starting_);
    for (const std::uint32_t m : model_.read_by(node)) was_read(m, ended.task.round);
    begin(ended.rank);
  }

  void begin(int rank_number) {
    Rank& rank = *ranks_[static_cast<std::size_t>(rank_number)];
    for (const Assignment& a : starting_) {
      const SubModelId id = rank.graph.sub_model(a.task.node);
      const double seconds = model_.seconds(id, rank.graph.stage(a.task.node), a.task.round) / machine_.speed;
      run({delay(rank, a.worker) + seconds, rank_number, a.worker, a.task, seconds});
    }
    starting_.clear();
  }

  double delay(const Rank& rank, int worker) const {
    const double since = rank.free_since[static_cast<std::size_t>(worker)];
    if (since < 0) return 0;
    return since == now_ ? machine_.overheads.next : machine_.overheads.wake;
  }

  /// A rank's messages leave one after another. One for the round after the last has no reader.
  void send(int from, std::size_t node, std::int64_t round) {
    for (std::size_t i = model_.first_sent(node); i < model_.first_sent(node + 1); ++i) {
      const SizedMessage& m = model_.messages()[i];
      if (owner_[m.message.to] == from || (m.message.next_round() && round + 1 == rounds_)) continue;
      double& until = ranks_[static_cast<std::size_t>(from)]->sends_until;
      until = std::max(until, now_) + m.bytes / machine_.bandwidth;
      travelling_.push({until + machine_.latency, static_cast<std::uint32_t>(i), static_cast<std::int32_t>(round)});
      ++out_.messages;
      out_.bytes += m.bytes;
    }
  }

  void arrive() {
    const Travelling came = travelling_.top();
    travelling_.pop();
    ++lines_[came.message].arrived;
    deliver(came.message);
    begin(owner_[model_.messages()[came.message].message.to]);
  }

  void was_read(std::uint32_t message, std::int64_t reading_round) {
    const Message& m = model_.messages()[message].message;
    if (owner_[m.from] == owner_[m.to]) return;
    lines_[message].read = static_cast<std::int32_t>(m.next_round() ? reading_round - 1 : reading_round);
    deliver(message);
  }

  void deliver(std::uint32_t message) {
    const Message& m = model_.messages()[message].message;
    Line& line = lines_[message];
    Rank& rank = *ranks_[static_cast<std::size_t>(owner_[m.to])];
    while (line.delivered < line.arrived && line.delivered - 1 <= line.read) {
      ++line.delivered;
      const NodeId node = rank.graph.node(rank.graph.place_of(m.to), m.read_in);
      rank.dispatcher.arrived({node, line.delivered + (m.next_round() ? 1 : 0)}, starting_);
    }
  }

  void check_done() const {
    for (const auto& rank : ranks_)
      if (!rank->dispatcher.done()) throw std::logic_error("replay: tasks wait for messages that nobody sends");
  }

  RecordedModel& model_;
  const Machine& machine_;
  std::int64_t rounds_;
  Owners owner_;
  std::vector<std::unique_ptr<Rank>> ranks_;
  std::vector<Line> lines_;  ///< per message
  std::priority_queue<Running> running_;
  std::deque<Running> waiting_;  ///< for a core; `end`: seconds it takes
  std::priority_queue<Travelling> travelling_;
  std::vector<Assignment> starting_;  ///< buffer: of one rank
  double now_ = 0;
  ClusterRun out_;
};

}  // namespace

ClusterRun simulate(RecordedModel& model, const Machine& machine, std::int64_t rounds) {
  return Cluster(model, machine, rounds).run();
}

}  // namespace moraine::runtime
