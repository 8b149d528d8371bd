// SPDX-License-Identifier: Apache-2.0
// Heat in an insulated rod of three pieces: rod alone and mpirun -np 2 rod give the same numbers.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "runtime/simulation.hpp"
#include "runtime/transport/mpi_session.hpp"

using namespace moraine::runtime;

class Piece final : public SubModel {
 public:
  Piece(SubModelId id, SubModelId pieces) : id_(id), t_(10, id == 0 ? 1.0 : 0.0) {
    if (id > 0) neighbours_.push_back(id - 1);
    if (id + 1 < pieces) neighbours_.push_back(id + 1);
  }
  std::span<const SubModelId> sources(int) const override { return neighbours_; }
  std::span<const SubModelId> targets(int) const override { return neighbours_; }

  void run(int, const Round& round, Port& port) override {
    if (!round.opening()) conduct(port);
    for (const SubModelId n : neighbours_)
      port.send(n, std::as_bytes(std::span(n < id_ ? &t_.front() : &t_.back(), 1)));
  }
  double counted_work(int) const override { return 10; }
  void save(std::vector<std::byte>& out) const override {
    const auto bytes = std::as_bytes(std::span(t_));
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  void load(std::span<const std::byte> in) override { std::memcpy(t_.data(), in.data(), in.size()); }
  double hottest() const { return t_.front(); }

 private:
  void conduct(const Port& port) {
    const std::vector<double> before = t_;
    double left = t_.front(), right = t_.back();
    for (const SubModelId n : neighbours_)
      std::memcpy(n < id_ ? &left : &right, port.received(n).data(), sizeof(double));
    for (std::size_t i = 0; i < t_.size(); ++i)
      t_[i] += 0.2 * ((i == 0 ? left : before[i - 1]) - 2 * before[i] + (i + 1 == t_.size() ? right : before[i + 1]));
  }

  SubModelId id_;
  std::vector<double> t_;
  std::vector<SubModelId> neighbours_;
};

class Rod final : public Model {
 public:
  std::span<const Stage> stages() const override { return stages_; }
  std::size_t size() const override { return pieces_.size(); }
  SubModel& sub_model(SubModelId id) override { return *pieces_.at(id); }
  EpochPlan begin_epoch(std::int64_t, std::int64_t at_most) override { return {std::min<std::int64_t>(50, at_most)}; }

 private:
  std::vector<Stage> stages_{{"conduct", 0}};  // receives what the others sent in this stage a round ago
  std::vector<std::unique_ptr<Piece>> pieces_ = [] {
    std::vector<std::unique_ptr<Piece>> p;
    for (SubModelId id = 0; id < 3; ++id) p.push_back(std::make_unique<Piece>(id, 3));
    return p;
  }();
};

int main() {
  MpiSession ranks;
  Rod rod;
  Simulation simulation(rod, {.threads = 1, .scheduler = "stealing", .transport = &ranks.transport()});
  simulation.run(0, 400);
  for (const SubModelId id : rod.held())
    std::printf("rank %d has piece %u: %.17g\n", ranks.transport().rank(), id,
                static_cast<Piece&>(rod.sub_model(id)).hottest());
}
