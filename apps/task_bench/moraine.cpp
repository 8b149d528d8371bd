// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstring>
#include <memory>

#include "runtime/records.hpp"
#include "runtime/simulation.hpp"
#include "systems.hpp"

namespace moraine::task_bench {
namespace {

using runtime::Round;
using runtime::SubModelId;

/// One stage, which reads the messages of the step before. Nothing is computed in the opening round.
class PointModel final : public runtime::SubModel {
 public:
  PointModel(const Problem& problem, Point point) : problem_(problem), point_(point), value_(first_value(point)) {}

  std::span<const SubModelId> sources(int) const override { return problem_.graph.sources[point_]; }
  std::span<const SubModelId> targets(int) const override { return problem_.graph.targets[point_]; }
  double counted_work(int) const override { return 1; }

  void run(int, const Round& round, runtime::Port& port) override {
    if (!round.opening()) advance(round.number, port);
    for (const SubModelId to : targets(0)) port.send(to, std::as_bytes(std::span(&value_, 1)));
  }

  void save(std::vector<std::byte>& out) const override { runtime::write_records(out, std::vector{value_}); }
  void load(std::span<const std::byte> in) override { value_ = runtime::read_records<std::uint64_t>(in).at(0); }
  std::uint64_t value() const { return value_; }

 private:
  void advance(std::int64_t step, const runtime::Port& port) {
    Task task(problem_, point_, step, value_);
    for (const SubModelId from : sources(0)) {
      std::uint64_t value = 0;
      std::memcpy(&value, port.received(from).data(), sizeof value);
      task.take(value);
    }
    value_ = task.run();
  }

  const Problem& problem_;
  Point point_;
  std::uint64_t value_;
};

class Points final : public runtime::Model {
 public:
  explicit Points(const Problem& problem) {
    for (Point p = 0; p < problem.graph.width(); ++p) points_.push_back(std::make_unique<PointModel>(problem, p));
  }
  std::span<const runtime::Stage> stages() const override { return stages_; }
  std::size_t size() const override { return points_.size(); }
  PointModel& sub_model(SubModelId id) override { return *points_[id]; }
  runtime::EpochPlan begin_epoch(std::int64_t, std::int64_t at_most) override { return {at_most}; }

  std::uint64_t checksum() const {
    std::uint64_t sum = 0;
    for (SubModelId id = 0; id < points_.size(); ++id)
      if (placement().holds(id)) sum += points_[id]->value();
    return sum;
  }

 private:
  std::vector<runtime::Stage> stages_{{"advance", 0}};
  std::vector<std::unique_ptr<PointModel>> points_;
};

}  // namespace

Outcome run_moraine(const Problem& problem, const std::string& scheduler, int threads, runtime::Transport& transport) {
  Points model(problem);
  runtime::Options options{
      .threads = threads, .scheduler = scheduler, .processor_time = false, .transport = &transport};
  options.balance.balancer = "none";
  runtime::Simulation simulation(model, options);
  const auto begin = std::chrono::steady_clock::now();
  simulation.run(0, problem.steps);
  const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Ranks that share cores may run one after the other, so that only their meeting at the end says how long all took.
  return {transport.ranks() > 1 ? all : simulation.load().elapsed, model.checksum()};
}

}  // namespace moraine::task_bench
