// SPDX-License-Identifier: Apache-2.0
#include "capture.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <numeric>

#include "ghosting/collect.hpp"
#include "ghosting/fields.hpp"
#include "ghosting/state_hash.hpp"
#include "run_profile.hpp"

namespace moraine::app {
namespace {

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// A number of each rank.
std::vector<double> over_ranks(runtime::Transport& transport, double own) {
  runtime::Bytes told;
  ByteWriter(told).put(own);
  std::vector<double> all;
  for (const runtime::Bytes& b : transport.all_gather(told)) all.push_back(ByteReader(b).get<double>());
  return all;
}

double sum_over_ranks(runtime::Transport& transport, double own) {
  const std::vector<double> all = over_ranks(transport, own);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

Frame::Bodies capture_elements(const CoupledModel& model) {
  Frame::Bodies out;
  out.state = model.states(0);
  if (out.state.empty()) return out;
  out.sub_model = model.owners();
  for (const Element& e : model.scene().elements) {
    out.id.push_back(e.id);
    out.shape.push_back(e.shape);
  }
  return out;
}

runtime::Bytes ghosts_in(const SubModel& part) {
  std::vector<std::pair<std::uint32_t, Slot>> here;
  for (const HostLink& link : part.host_links())
    for (const Ghost& g : link.ghosts) here.emplace_back(g.element, g.slot);
  std::sort(here.begin(), here.end());
  runtime::Bytes out;
  ByteWriter w(out);
  for (const auto& [element, slot] : here) {
    const ElementState state = part.world().state(slot);
    w.put(element);
    fields::all(w, state);
  }
  return out;
}

Frame::Bodies capture_ghosts(const CoupledModel& model, runtime::Transport& transport) {
  Frame::Bodies out;
  const auto told = collect(
      model, transport, [&](SubModelId id) { return ghosts_in(model.part(id)); }, 0);
  for (std::size_t p = 0; p < told.size(); ++p)
    for (ByteReader r(told[p]); !r.at_end();) {
      const Element& e = model.scene().elements[r.get<std::uint32_t>()];
      out.id.push_back(e.id);
      out.sub_model.push_back(static_cast<SubModelId>(p));
      fields::all(r, out.state.emplace_back());
      out.shape.push_back(e.shape);
    }
  return out;
}

Summary::Balance summarise(const runtime::Rebalance& balance, runtime::Transport& transport, int substeps) {
  Summary::Balance out;
  double seconds = 0;
  for (const runtime::BalanceRoundRecord& r : balance.records()) {
    seconds += r.seconds;
    out.moved_bytes += r.moved_bytes;
    out.rounds.push_back({r.round / substeps, r.imbalance, r.forecast_after, r.gain_seconds, r.cost_seconds,
                          r.carried_out ? r.moves : 0, r.moved_bytes});
  }
  for (const double other : over_ranks(transport, seconds)) out.seconds = std::max(out.seconds, other);
  return out;
}

Summary::Messages summarise_messages(const runtime::Simulation& simulation) {
  runtime::Transport& transport = simulation.transport();
  const runtime::Mail::Totals& own = simulation.messages();
  const double rounds = std::max(1.0, static_cast<double>(simulation.rounds()));
  return {sum_over_ranks(transport, own.messages) / rounds, sum_over_ranks(transport, own.bytes) / rounds,
          sum_over_ranks(transport, own.between_ranks) / rounds,
          sum_over_ranks(transport, own.pairs) / std::max(1.0, own.epochs)};
}

}  // namespace

Frame capture(const CoupledModel& model, runtime::Transport& transport, std::int64_t step) {
  const Scene& scene = model.scene();
  Frame frame;
  frame.step = step;
  frame.time = static_cast<double>(step) * scene.time.dt;
  frame.elements = capture_elements(model);
  frame.ghosts = capture_ghosts(model, transport);
  frame.bonds = model.alive_bonds();
  for (const Boundary& b : scene.boundaries) frame.boundary_poses.push_back(b.motion.pose(b.pose, frame.time));
  return frame;
}

Summary summarise(const CoupledModel& model, runtime::Simulation& simulation, const Spent& spent) {
  const Scene& scene = model.scene();
  const ModelStatistics statistics = model.statistics(scene.time.steps * scene.time.substeps);
  const OverlapStatistics overlaps = model.overlaps();
  runtime::Transport& transport = simulation.transport();
  const runtime::LoadRecord load = all_ranks(simulation.load(), transport);
  const Frame::Bodies elements = capture_elements(model);
  const auto share = [&](double ghosts) {
    return scene.elements.empty() ? 0 : ghosts / static_cast<double>(scene.elements.size());
  };

  Summary s;
  s.scene = scene.name;
  s.engine = model.engine().name;
  s.precision = model.engine().precision;
  s.coupling = model.coupling().name;
  s.split = model.split().name;
  s.scheduler = scene.run.scheduler;
  s.balancer = scene.run.balancer;
  s.ranks = transport.ranks();
  s.threads_per_rank = simulation.threads();
  s.elements = scene.elements.size();
  s.sub_models = static_cast<std::uint32_t>(model.size());
  s.steps = scene.time.steps;
  s.substeps = scene.time.substeps;
  s.dt = scene.time.dt;
  s.time = static_cast<double>(scene.time.steps) * scene.time.dt;
  s.wall_s = spent.wall_s;
  s.loop_wall_s = spent.loop_wall_s;
  s.loop_cpu_s = sum_over_ranks(transport, spent.loop_cpu_s);
  const double element_steps = static_cast<double>(s.elements) * static_cast<double>(spent.rounds);
  s.element_steps_per_s = spent.loop_wall_s > 0 ? element_steps / spent.loop_wall_s : 0;
  s.peak_rss_bytes = static_cast<std::uint64_t>(sum_over_ranks(transport, static_cast<double>(peak_rss_bytes())));
  if (transport.rank() == 0) s.state_hash = fmt::format("{:016x}", state_hash(scene, elements.state));
  s.ghosts = {statistics.ghosts_mean, statistics.ghosts_max, statistics.ghosts_now, share(statistics.ghosts_mean),
              share(static_cast<double>(statistics.ghosts_now))};
  s.bonds = {scene.bonds.size(), statistics.bonds_broken};
  s.momentum_residual = {statistics.linear_residual, statistics.angular_residual};
  s.kinetic_energy = statistics.ledger.kinetic_energy;
  const EnergyAccount& e = statistics.energy;
  s.energy = {e.kinetic, e.potential, e.bond, e.contact, e.work_of_boundaries, e.dissipated, e.gained};
  s.boundary_force = {statistics.boundary_force.x(), statistics.boundary_force.y(), statistics.boundary_force.z()};
  if (statistics.ledger.mass > 0) {
    const Vec3 centre = statistics.ledger.mass_moment / statistics.ledger.mass;
    s.center_of_mass = {centre.x(), centre.y(), centre.z()};
  }
  for (const int percent : {5, 50, 95})
    for (int axis = 0; axis < 3; ++axis)
      s.quantiles[percent][static_cast<std::size_t>(axis)] = quantile(elements.state, axis, percent / 100.0);
  s.x95 = s.quantiles[95][0];
  s.overlap = {overlaps.max, overlaps.mean};
  s.coupling_residual = statistics.coupling_residual;
  s.load = {load.imbalance(), load.utilisation(), load.waiting_fraction(),
            static_cast<std::uint64_t>(simulation.balance().migrations())};
  s.profile = profile_of(simulation);
  s.balance = summarise(simulation.balance(), transport, scene.time.substeps);
  s.messages = summarise_messages(simulation);
  for (std::size_t i = 0; i < load.stages.size(); ++i)
    s.step_share[std::string(SubModel::stages()[i].name)] =
        load.busy() > 0 ? load.stages[i].taken.seconds / load.busy() : 0;
  s.rested = share(statistics.rested_mean);
  s.recuts = statistics.recuts;
  s.warnings = scene.warnings;
  for (std::string& warning : model.warnings()) s.warnings.push_back(std::move(warning));
  return s;
}

}  // namespace moraine::app
