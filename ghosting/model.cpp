// SPDX-License-Identifier: Apache-2.0
#include "ghosting/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "ghosting/auto_count.hpp"
#include "ghosting/check.hpp"
#include "ghosting/neighbours.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr std::int64_t rounds_between_cuts = 64;

void check_shapes(const Scene& scene, const Engine& engine) {
  for (const Element& e : scene.elements)
    if (!engine.supports(scene.shapes[e.shape].geometry))
      throw InputError(
          fmt::format("{}: element {} has a shape that engine {} cannot do", scene.source, e.id, engine.name));
}

void check_step(const Scene& scene, const Engine& engine) {
  const StepLimit limit = engine.step_limit(scene);
  if (scene.time.substep() <= limit.substep) return;
  throw InputError(
      fmt::format("{}: a substep of {:.4g} s is too long for engine {}: the limit is {:.4g} s, set by {}; use "
                  "a smaller time.dt or at least {:.0f} substeps",
                  scene.source, scene.time.substep(), engine.name, limit.substep, limit.reason,
                  std::ceil(scene.time.dt / limit.substep)));
}

/// Followers must be there before they are needed: see SubModel::borders_due.
double follower_speed(const ModelContext& context) {
  if (!context.followers()) return std::numeric_limits<double>::infinity();
  return context.skin / (8 * context.world.substep);
}

std::size_t part_count(const Scene& scene, const Engine& engine, const Limits& limits) {
  const auto asked = static_cast<std::size_t>(std::max(0, scene.run.sub_models));
  const std::size_t parts = asked > 0 ? asked : auto_count(scene.elements.size(), engine, limits);
  if (parts > limits.worlds)
    throw InputError(
        fmt::format("{}: {} sub-models are more than the {} worlds that engine {} ({}) allows in a process",
                    scene.source, parts, limits.worlds, engine.name, scene.run.engine_profile));
  const double capacity = static_cast<double>(limits.packed_spheres()) * (1 - limits.ghost_reserve);
  const double largest = std::ceil(static_cast<double>(scene.elements.size()) / static_cast<double>(parts));
  if (largest > capacity)
    throw InputError(
        fmt::format("{}: {:.0f} elements per sub-model are more than engine {} ({}) holds: {} touching elements, "
                    "{:.0f} % of them kept "
                    "for ghosts; use at least {:.0f} sub-models",
                    scene.source, largest, engine.name, scene.run.engine_profile, limits.packed_spheres(),
                    limits.ghost_reserve * 100, std::ceil(static_cast<double>(scene.elements.size()) / capacity)));
  return parts;
}

/// Nothing in the scene can get this fast: ten times the speed of falling through the whole scene, added to what moves
/// at the start or is driven.
double runaway_speed(const Scene& scene) {
  if (scene.run.max_speed > 0) return scene.run.max_speed;
  Bounds box;
  double speed = 0;
  for (const Element& e : scene.elements) {
    box.add(e.state.pose.position, scene.shape_of(e).bounding_radius);
    speed =
        std::max(speed, e.state.twist.linear.norm() + e.state.twist.angular.norm() * scene.shape_of(e).bounding_radius);
  }
  const double extent = box.empty() ? 1.0 : (box.max - box.min).norm();
  for (const Boundary& b : scene.boundaries)
    if (b.motion.moves())
      speed = std::max(speed, b.motion.velocity.linear.norm() + b.motion.velocity.angular.norm() * extent);
  const double fall = std::sqrt(2 * scene.gravity.norm() * extent);
  const double bond_speed = scene.typical_diameter() / scene.time.substep();
  return 10 * (speed + fall) + (scene.gravity.isZero() && speed == 0 ? bond_speed : 0);
}

std::uint32_t element_index(const Scene& scene, ElementId id) {
  const auto at = std::lower_bound(scene.elements.begin(), scene.elements.end(), id,
                                   [](const Element& e, ElementId wanted) { return e.id < wanted; });
  return static_cast<std::uint32_t>(at - scene.elements.begin());
}

}  // namespace

Features features_of(const Scene& scene) {
  Features f;
  f.friction = scene.materials.any_friction();
  f.restitution = scene.materials.any_restitution();
  f.bonds = !scene.bonds.empty();
  f.spheres_only = std::all_of(scene.elements.begin(), scene.elements.end(),
                               [&](const Element& e) { return scene.shape_of(e).sphere(); });
  return f;
}

WorldSettings world_settings(const Scene& scene) {
  WorldSettings w;
  w.length_unit = scene.typical_diameter();
  w.mass_unit = scene.typical_mass();
  const double g = scene.gravity.norm();
  w.time_unit = g > 0 ? std::sqrt(w.length_unit / g) : 40 * scene.time.substep();
  w.gravity = scene.gravity;
  w.substep = scene.time.substep();
  w.iterations = scene.run.iterations;
  w.overlap_recovery = scene.run.overlap_recovery;
  w.features = features_of(scene);
  w.limits = find_limits(scene.run.engine_profile);
  w.scene = &scene;
  return w;
}

Limits find_limits(std::string_view profile) {
  if (profile == "default") return {};
  // PhysX as Longshaw et al. (2009) used it: 64 scenes, 64,000 shapes, 256,000 contact pairs per scene. A packed sphere
  // takes part in 12 pairs, hence 21,333 of them. A tenth is kept free for ghosts, several times what a compact cut of
  // that size needs.
  if (profile == "physx") return {64'000, 256'000, 64, 0.1};
  throw InputError(fmt::format("unknown engine profile '{}', expected one of: default, physx", profile));
}

CoupledModel::CoupledModel(const Scene& scene) {
  context_.scene = &scene;
  context_.engine = &find_engine(scene.run.engine);
  coupling_row_ = &find_coupling(scene.run.coupling, *context_.engine);
  coupling_ = coupling_row_->make();
  context_.coupling = coupling_.get();
  context_.world = world_settings(scene);
  for (const Bond& b : scene.bonds)
    context_.bond_ends.push_back({element_index(scene, b.a), element_index(scene, b.b)});
  context_.skin = (scene.run.skin > 0 ? scene.run.skin : coupling_row_->skin) * context_.world.length_unit;
  context_.speed_limit = std::min(runaway_speed(scene), follower_speed(context_));
  check_shapes(scene, *context_.engine);
  check_step(scene, *context_.engine);
  parts_ = part_count(scene, *context_.engine, context_.world.limits);
  split_ = &find_split(scene.run.split, scene, parts_);
  std::vector<ElementState> states;
  for (const Element& e : scene.elements) states.push_back(e.state);
  cut(states, {});
  for (const auto& part : sub_models_) opening_ledger_ += part->ledger();
}

CoupledModel::~CoupledModel() = default;

/// Makes all sub-models from the elements' states and what their contacts remember; used at the start and whenever
/// membership is cut again.
void CoupledModel::cut(std::span<const ElementState> states, std::span<const ContactMemory> memory) {
  std::vector<Vec3> positions;
  for (const ElementState& s : states) positions.push_back(s.pose.position);
  owners_ = split_->split({positions, scene().gravity, parts_});
  std::vector<std::vector<std::uint32_t>> members(parts_), bonds(parts_);
  for (std::uint32_t e = 0; e < owners_.size(); ++e) members[owners_[e]].push_back(e);
  for (const std::uint32_t b : alive_bonds()) {
    const auto [first, second] = context_.bond_ends[b];
    if (owners_[first] == owners_[second]) bonds[owners_[first]].push_back(b);
  }
  const std::vector<std::vector<ContactMemory>> remembered = by_part(memory);
  sub_models_.clear();
  for (SubModelId id = 0; id < parts_; ++id) {
    std::vector<ElementState> own;
    for (const std::uint32_t e : members[id]) own.push_back(states[e]);
    sub_models_.push_back(
        std::make_unique<SubModel>(context_, id, std::move(members[id]), own, bonds[id], remembered[id]));
  }
  share_after_cut_ = -1;
  rounds_at_cut_ = rounds_done_;
}

/// Of every contact once, ascending; those across a cut are known on both sides.
std::vector<ContactMemory> CoupledModel::contact_memory() const {
  std::vector<ContactMemory> all;
  for (const auto& part : sub_models_) {
    const std::vector<ContactMemory> own = part->world().contact_memory();
    all.insert(all.end(), own.begin(), own.end());
  }
  const auto key = [](const ContactMemory& m) { return std::tuple(m.a, m.with_boundary, m.b); };
  std::stable_sort(all.begin(), all.end(), [&](auto& a, auto& b) { return key(a) < key(b); });
  const auto same_pair = [&](auto& a, auto& b) { return !a.with_boundary && key(a) == key(b); };
  all.erase(std::unique(all.begin(), all.end(), same_pair), all.end());
  return all;
}

/// What the owners of either element need to know.
std::vector<std::vector<ContactMemory>> CoupledModel::by_part(std::span<const ContactMemory> memory) const {
  std::vector<std::vector<ContactMemory>> out(parts_);
  for (const ContactMemory& m : memory) {
    const SubModelId first = owners_[element_index(scene(), m.a)];
    const SubModelId second = m.with_boundary ? first : owners_[element_index(scene(), m.b)];
    out[first].push_back(m);
    if (second != first) out[second].push_back(m);
  }
  return out;
}

std::vector<std::uint32_t> CoupledModel::alive_bonds() const {
  std::vector<bool> alive(scene().bonds.size(), true);
  for (const std::uint32_t b : broken_) alive[b] = false;
  for (const auto& part : sub_models_)
    for (const std::uint32_t b : part->broken_bonds()) alive[b] = false;
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = 0; b < alive.size(); ++b)
    if (alive[b]) out.push_back(b);
  return out;
}

/// Epochs end where the model says. Being stopped earlier, for a frame, must not change anything.
std::int64_t CoupledModel::begin_epoch(std::int64_t next_round, std::int64_t at_most) {
  rounds_done_ = next_round;
  if (next_round < epoch_end_)
    for (auto& part : sub_models_) part->go_on();
  else
    open_epoch();
  return std::min(at_most, epoch_end_ - next_round);
}

void CoupledModel::open_epoch() {
  note_extremes();
  check_invariants(*this);
  if (should_recut()) {
    const std::vector<ElementState> now = states();
    const std::vector<ContactMemory> memory = contact_memory();
    take_over_accounts();
    cut(now, memory);
    ++closed_.recuts;
  }
  for (auto& part : sub_models_) part->canonicalise();
  settle_neighbours();
}

std::size_t CoupledModel::ghosts_now() const {
  std::size_t ghosts = 0;
  for (const auto& part : sub_models_) ghosts += part->ghost_count();
  return ghosts;
}

double CoupledModel::ghost_share() const {
  return static_cast<double>(ghosts_now()) / static_cast<double>(std::max<std::size_t>(1, owners_.size()));
}

/// The share right after a cut is what this scene costs at best; cutting again must promise something.
bool CoupledModel::should_recut() const {
  if (parts_ < 2 || rounds_done_ < rounds_at_cut_ + rounds_between_cuts || share_after_cut_ < 0) return false;
  const double share = ghost_share();
  return share > scene().run.recut_ghost_share && share > 1.3 * share_after_cut_;
}

void CoupledModel::note_extremes() {
  Ledger sum;
  for (const auto& part : sub_models_) sum += part->ledger();
  ghosts_max_ = std::max(ghosts_max_, ghosts_now());
  speed_sum_max_ = std::max(speed_sum_max_, sum.speed_sum);
  spin_scale_max_ = std::max(spin_scale_max_, sum.spin_scale);
  if (share_after_cut_ < 0 && rounds_done_ > rounds_at_cut_) share_after_cut_ = ghost_share();
}

/// Sub-models about to be replaced leave what they counted.
void CoupledModel::take_over_accounts() {
  rounds_closed_ += sub_models_.front()->rounds();
  for (const auto& part : sub_models_) {
    const Ledger ledger = part->ledger();
    closed_.ledger.given += ledger.given;
    closed_.ledger.exchanged += ledger.exchanged;
    closed_.ledger.exchanged_angular += ledger.exchanged_angular;
    disagreement_closed_ += part->disagreement();
    disagreements_closed_ += part->disagreements();
    ghost_rounds_closed_ += part->ghost_rounds();
    broken_.insert(broken_.end(), part->broken_bonds().begin(), part->broken_bonds().end());
  }
  std::sort(broken_.begin(), broken_.end());
  broken_.erase(std::unique(broken_.begin(), broken_.end()), broken_.end());
}

/// By bounds, and by bonds across cuts, which also tie sub-models that are apart.
void CoupledModel::settle_neighbours() {
  std::vector<Reach> reaches;
  for (const auto& part : sub_models_) reaches.push_back({part->bounds(), part->max_speed()});
  const Neighbourhood near = find_neighbours(reaches, context_.world.length_unit, scene().gravity.norm(),
                                             context_.world.substep, std::numeric_limits<std::int64_t>::max());
  epoch_end_ = rounds_done_ + near.rounds;

  std::map<std::pair<SubModelId, SubModelId>, std::vector<std::uint32_t>> pairs;
  for (const auto& pair : near.pairs) pairs[pair];
  for (const std::uint32_t b : alive_bonds()) {
    const auto [first, second] = context_.bond_ends[b];
    const SubModelId low = std::min(owners_[first], owners_[second]), high = std::max(owners_[first], owners_[second]);
    if (low != high) pairs[{low, high}].push_back(b);
  }
  std::vector<std::vector<SubModel::Neighbour>> neighbours(parts_);
  const auto join = [&](SubModelId at, SubModelId other, const std::vector<std::uint32_t>& bonds) {
    SubModel::Neighbour n{other, reaches[other].bounds, reaches[other].max_speed, {}};
    for (const std::uint32_t b : bonds) {
      const auto [first, second] = context_.bond_ends[b];
      const bool first_here = owners_[first] == at;
      n.bonds.push_back({b, first_here ? first : second, first_here ? second : first});
    }
    neighbours[at].push_back(std::move(n));
  };
  for (const auto& [pair, bonds] : pairs) {
    join(pair.first, pair.second, bonds);
    join(pair.second, pair.first, bonds);
  }
  for (SubModelId id = 0; id < parts_; ++id) {
    std::sort(neighbours[id].begin(), neighbours[id].end(), [](auto& a, auto& b) { return a.id < b.id; });
    sub_models_[id]->set_neighbours(neighbours[id]);
  }
}

std::vector<ElementState> CoupledModel::states() const {
  std::vector<ElementState> out(owners_.size());
  for (const auto& part : sub_models_)
    for (std::size_t i = 0; i < part->members().size(); ++i) out[part->members()[i]] = part->state(i);
  return out;
}

ModelStatistics CoupledModel::statistics() const {
  ModelStatistics s = closed_;
  s.bonds_broken = scene().bonds.size() - alive_bonds().size();
  s.ghosts_now = ghosts_now();
  s.ghosts_max = std::max(ghosts_max_, s.ghosts_now);
  double disagreement = disagreement_closed_;
  std::uint64_t disagreements = disagreements_closed_, ghost_rounds = ghost_rounds_closed_, rounds = rounds_closed_;
  if (!sub_models_.empty()) rounds += sub_models_.front()->rounds();
  for (const auto& part : sub_models_) {
    s.ledger += part->ledger();
    disagreement += part->disagreement();
    disagreements += part->disagreements();
    ghost_rounds += part->ghost_rounds();
  }
  s.ghosts_mean = static_cast<double>(ghost_rounds) / static_cast<double>(std::max<std::uint64_t>(1, rounds));
  const Vec3 linear = s.ledger.momentum.linear - opening_ledger_.momentum.linear - s.ledger.given.linear;
  const Vec3 angular = s.ledger.momentum.angular - opening_ledger_.momentum.angular - s.ledger.given.angular;
  const auto relative = [](double x, double scale) { return scale > 0 ? x / scale : x; };
  s.linear_residual = relative(linear.norm(), std::max({speed_sum_max_, s.ledger.speed_sum, s.ledger.exchanged}));
  s.angular_residual =
      relative(angular.norm(), std::max({spin_scale_max_, s.ledger.spin_scale, s.ledger.exchanged_angular}));
  const double speed = context_.world.length_unit / context_.world.time_unit;
  s.coupling_residual = disagreements == 0 ? 0 : std::sqrt(disagreement / static_cast<double>(disagreements)) / speed;
  return s;
}

OverlapStatistics CoupledModel::overlaps() const {
  OverlapStatistics out;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t p = 0; p < size(); ++p)
    for (const Contact& c : part(p).world().contacts()) {
      // Both sides know a contact across a cut if ghosts are followers.
      if (context_.followers() && owners_[element_index(scene(), c.a)] != p) continue;
      const double overlap = c.overlap / context_.world.length_unit;
      if (overlap <= 0) continue;
      out.max = std::max(out.max, overlap);
      sum += overlap;
      ++count;
    }
  out.mean = count == 0 ? 0 : sum / static_cast<double>(count);
  return out;
}

}  // namespace moraine
