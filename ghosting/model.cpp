// SPDX-License-Identifier: Apache-2.0
#include "ghosting/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "ghosting/check.hpp"
#include "ghosting/collect.hpp"
#include "ghosting/fields.hpp"
#include "ghosting/neighbours.hpp"
#include "physics/errors.hpp"
#include "physics/inner_radius.hpp"
#include "runtime/balance/initial_owners.hpp"

namespace moraine {
namespace {

constexpr std::int64_t rounds_between_cuts = 64;
constexpr double averaged_from = 0.8;       // of the run: boundary forces are means over the rest
constexpr std::int64_t longest_epoch = 64;  // rounds; sub-models can move and be saved between epochs only

/// Followers must be there before they are needed: see SubModel::borders_due.
double follower_speed(const ModelContext& context) {
  if (!context.followers()) return std::numeric_limits<double>::infinity();
  return context.skin / (8 * context.world.substep);
}

std::uint32_t element_index(const Scene& scene, ElementId id) {
  const auto at = std::lower_bound(scene.elements.begin(), scene.elements.end(), id,
                                   [](const Element& e, ElementId wanted) { return e.id < wanted; });
  return static_cast<std::uint32_t>(at - scene.elements.begin());
}

std::vector<ElementState> states_of(const Scene& scene) {
  std::vector<ElementState> states;
  states.reserve(scene.elements.size());
  for (const Element& e : scene.elements) states.push_back(e.state);
  return states;
}

/// Blocks of as many sub-models as the scene says. Errors: InputError unless they are all there are.
runtime::Owners stated_placement(const std::vector<int>& counts, std::size_t parts, int ranks) {
  const auto stated = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  if (counts.size() != static_cast<std::size_t>(ranks) || stated != parts)
    throw InputError(
        fmt::format("run.owners: {} sub-models on {} ranks, expected {} on {}", stated, counts.size(), parts, ranks));
  runtime::Owners owners;
  for (int rank = 0; rank < ranks; ++rank) owners.insert(owners.end(), static_cast<std::size_t>(counts[rank]), rank);
  return owners;
}

/// Blocks of sub-models, with about as many elements on each rank unless the scene says otherwise.
runtime::Owners first_placement(const Scene& scene, const std::vector<std::vector<std::uint32_t>>& members, int ranks) {
  if (ranks > 1 && !scene.run.owners.empty()) return stated_placement(scene.run.owners, members.size(), ranks);
  std::vector<double> load;
  for (const auto& m : members) load.push_back(static_cast<double>(m.size()));
  return runtime::initial_owners(load, std::vector<double>(static_cast<std::size_t>(ranks), 1.0));
}

}  // namespace

Features features_of(const Scene& scene) {
  Features f;
  f.friction = scene.materials.any_friction();
  f.restitution = scene.materials.any_restitution();
  f.bonds = !scene.bonds.empty();
  f.spheres_only = std::all_of(scene.elements.begin(), scene.elements.end(),
                               [&](const Element& e) { return scene.shape_of(e).sphere(); });
  f.rotation = f.friction || !f.spheres_only ||
               std::any_of(scene.elements.begin(), scene.elements.end(),
                           [](const Element& e) { return !e.state.twist.angular.isZero(0); });
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

CoupledModel::CoupledModel(const Scene& scene, runtime::Transport& transport) : transport_(transport) {
  context_.scene = &scene;
  context_.engine = &find_engine(scene.run.engine, scene);
  coupling_row_ = &find_coupling(scene.run.coupling, *context_.engine);
  coupling_ = coupling_row_->make();
  context_.coupling = coupling_.get();
  context_.world = world_settings(scene);
  for (const Bond& b : scene.bonds)
    context_.bond_ends.push_back({element_index(scene, b.a), element_index(scene, b.b)});
  context_.skin = (scene.run.skin > 0 ? scene.run.skin : coupling_row_->skin) * context_.world.length_unit;
  context_.enclosure = Enclosure(scene);
  context_.rest = rest_limits(context_.world, scene.run.skip_threshold);
  context_.driven = DrivenBoundaries(scene);
  context_.start = deepest_overlap(scene);
  for (const Shape& s : scene.shapes) context_.inner_radius.push_back(inner_radius(s.geometry));
  if (!scene.shapes.empty()) context_.least_inner_radius = std::ranges::min(context_.inner_radius);
  context_.advised = context_.engine->advised_step(scene);
  context_.speed_limit = std::min(runaway_speed(scene), follower_speed(context_));
  check_engine(scene, *context_.engine);
  parts_ = part_count(scene, *context_.engine, context_.world.limits);
  split_ = &find_split(scene.run.split, scene, parts_);
  cut(states_of(scene), {});
  for (const Report& r : reports()) accounts_.opening += r.ledger;
}

CoupledModel::~CoupledModel() = default;

/// Makes the sub-models held here from the elements' states and what their contacts remember; used at the start and
/// whenever membership is cut again.
void CoupledModel::cut(std::span<const ElementState> states, std::span<const ContactMemory> memory) {
  std::vector<Vec3> positions;
  positions.reserve(states.size());
  for (const ElementState& s : states) positions.push_back(s.pose.position);
  std::vector<std::uint32_t> alive = alive_bonds();
  owners_ = split_->split({positions, scene().gravity, parts_});
  std::vector<std::vector<std::uint32_t>> members(parts_), bonds(parts_);
  for (std::uint32_t e = 0; e < owners_.size(); ++e) members[owners_[e]].push_back(e);
  for (const std::uint32_t b : alive) {
    const auto [first, second] = context_.bond_ends[b];
    if (owners_[first] == owners_[second]) bonds[owners_[first]].push_back(b);
  }
  if (placement().owner.empty()) place({transport_.rank(), first_placement(scene(), members, transport_.ranks())});
  const std::vector<std::vector<ContactMemory>> remembered = by_part(memory);
  sub_models_.clear();
  sub_models_.resize(parts_);
  for (SubModelId id = 0; id < parts_; ++id) {
    if (!placement().holds(id)) continue;
    std::vector<ElementState> own;
    own.reserve(members[id].size());
    for (const std::uint32_t e : members[id]) own.push_back(states[e]);
    sub_models_[id] = std::make_unique<SubModel>(context_, id, std::move(members[id]), own, bonds[id], remembered[id]);
  }
  share_after_cut_ = -1;
  rounds_at_cut_ = epoch_begin_;
}

/// Of every contact once, ascending; those across a cut are known on both sides. Collective.
std::vector<ContactMemory> CoupledModel::contact_memory() const {
  std::vector<ContactMemory> all;
  for (const runtime::Bytes& told : collect(*this, transport_, [&](SubModelId id) {
         const std::vector<ContactMemory> own = sub_models_[id]->world().contact_memory();
         runtime::Bytes out;
         ByteWriter w(out);
         fields::all(w, own);
         return out;
       })) {
    std::vector<ContactMemory> own;
    ByteReader r(told);
    fields::all(r, own);
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

void CoupledModel::adopt(runtime::SubModelId id, std::span<const std::byte> saved) {
  sub_models_[id] = std::make_unique<SubModel>(context_, id);
  sub_models_[id]->load(saved);
}

std::vector<Report> CoupledModel::reports() const {
  std::vector<Report> all;
  for (const runtime::Bytes& told : collect(*this, transport_, [&](SubModelId id) {
         runtime::Bytes out;
         ByteWriter w(out);
         Report report = sub_models_[id]->report();
         fields::all(w, report);
         return out;
       })) {
    ByteReader r(told);
    fields::all(r, all.emplace_back());
  }
  return all;
}

std::vector<std::uint32_t> CoupledModel::alive_bonds() const {
  return scene().bonds.empty() || sub_models_.empty() ? alive_bonds(std::vector<Report>{}) : alive_bonds(reports());
}

std::vector<std::uint32_t> CoupledModel::alive_bonds(const std::vector<Report>& reports) const {
  std::vector<bool> alive(scene().bonds.size(), true);
  for (const std::uint32_t b : accounts_.broken_bonds) alive[b] = false;
  for (const Report& r : reports)
    for (const std::uint32_t b : r.broken_bonds) alive[b] = false;
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = 0; b < alive.size(); ++b)
    if (alive[b]) out.push_back(b);
  return out;
}

/// Epochs end where the model says. Being stopped earlier, for a frame, must not change anything.
runtime::EpochPlan CoupledModel::begin_epoch(std::int64_t next_round, std::int64_t at_most) {
  const bool restored = next_round == epoch_begin_ && next_round < epoch_end_;
  const bool interrupted = !restored && next_round < epoch_end_;
  if (interrupted) {
    if (next_round == marked_round()) accounts_.mark(reports(), next_round);
    for (const auto& part : sub_models_)
      if (part) part->go_on();
  } else if (!restored) {
    epoch_begin_ = next_round;
    open_epoch();
  }
  if (next_round < marked_round()) at_most = std::min(at_most, marked_round() - next_round);
  return {std::min(at_most, epoch_end_ - next_round), !interrupted && !restored};
}

std::int64_t CoupledModel::marked_round() const {
  return static_cast<std::int64_t>(averaged_from * static_cast<double>(scene().time.steps * scene().time.substeps));
}

void CoupledModel::conclude(std::int64_t round) { look(round, overlaps().max); }

std::vector<Report> CoupledModel::look(std::int64_t round, double overlap) {
  context_.enclosure.move(static_cast<double>(round) * context_.world.substep);
  std::vector<Report> now = reports();
  accounts_.note_extremes(now);
  if (round <= marked_round()) accounts_.mark(now, round);
  guard_log_.look(watch(now, overlap), round / scene().time.substeps);
  return now;
}

Watch CoupledModel::watch(const std::vector<Report>& now, double overlap) {
  const ModelStatistics s = accounts_.statistics(now, speed_unit(), 0);
  Watch w{context_, {}, accounts_, s.linear_residual, s.angular_residual, 0, overlap};
  for (const Report& r : now) w.extremes.note(r.extremes);
  w.disagreement = guard_log_.disagreement_since(accounts_, now) / speed_unit();
  return w;
}

void CoupledModel::open_epoch() {
  std::vector<Report> now = look(epoch_begin_);
  ghosts_at_epoch_ = ghosts(now);
  if (share_after_cut_ < 0 && epoch_begin_ > rounds_at_cut_) share_after_cut_ = ghost_share();
  check_invariants(*this);
  if (should_recut()) {
    const std::vector<ElementState> present = states();
    const std::vector<ContactMemory> memory = contact_memory();
    accounts_.take_over(now);
    cut(present, memory);
    now = reports();
  }
  settle_neighbours(now);
  for (const auto& part : sub_models_)
    if (part) part->canonicalise();
}

double CoupledModel::ghost_share() const {
  return static_cast<double>(ghosts_at_epoch_) / static_cast<double>(std::max<std::size_t>(1, owners_.size()));
}

/// The share right after a cut is what this scene costs at best; cutting again must promise something.
bool CoupledModel::should_recut() const {
  if (parts_ < 2 || epoch_begin_ < rounds_at_cut_ + rounds_between_cuts || share_after_cut_ < 0) return false;
  const double share = ghost_share();
  return share > scene().run.recut_ghost_share && share > 1.3 * share_after_cut_;
}

/// By bounds, and by bonds across cuts, which also tie sub-models that are apart.
void CoupledModel::settle_neighbours(const std::vector<Report>& reports) {
  std::vector<Reach> reaches;
  for (const Report& r : reports) reaches.push_back({r.bounds, r.max_speed});
  const double now = static_cast<double>(epoch_begin_) * context_.world.substep;
  const double driven = driven_speed(scene(), all_of(reaches), now, now + longest_epoch * context_.world.substep);
  const Neighbourhood near = find_neighbours(reaches, driven, context_.world.length_unit, scene().gravity.norm(),
                                             context_.world.substep, longest_epoch);
  epoch_end_ = epoch_begin_ + near.rounds;

  std::map<std::pair<SubModelId, SubModelId>, std::vector<std::uint32_t>> pairs;
  for (const auto& pair : near.pairs) pairs[pair];
  for (const std::uint32_t b : alive_bonds(reports)) {
    const auto [first, second] = context_.bond_ends[b];
    const SubModelId low = std::min(owners_[first], owners_[second]), high = std::max(owners_[first], owners_[second]);
    if (low != high) pairs[{low, high}].push_back(b);
  }
  std::vector<std::vector<SubModel::Neighbour>> neighbours(parts_);
  const auto join = [&](SubModelId at, SubModelId other, const std::vector<std::uint32_t>& bonds) {
    if (!placement().holds(at)) return;
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
    if (!placement().holds(id)) continue;
    std::sort(neighbours[id].begin(), neighbours[id].end(), [](auto& a, auto& b) { return a.id < b.id; });
    sub_models_[id]->set_neighbours(neighbours[id]);
  }
}

/// All states, where one rank has them all.
std::vector<ElementState> CoupledModel::own_states() const {
  std::vector<ElementState> out(owners_.size());
  for (const auto& part : sub_models_)
    for (std::size_t i = 0; i < part->members().size(); ++i) out[part->members()[i]] = part->state(i);
  return out;
}

std::vector<ElementState> CoupledModel::states(std::optional<int> root) const {
  if (transport_.ranks() == 1) return own_states();
  const std::vector<runtime::Bytes> told = collect(
      *this, transport_,
      [&](SubModelId id) {
        runtime::Bytes out;
        ByteWriter w(out);
        for (std::size_t i = 0; i < sub_models_[id]->members().size(); ++i) {
          const ElementState s = sub_models_[id]->state(i);
          fields::all(w, s);
        }
        return out;
      },
      root);
  std::vector<ElementState> out;
  if (told.empty()) return out;
  out.reserve(owners_.size());
  std::vector<ByteReader> readers(told.begin(), told.end());
  for (const SubModelId owner : owners_) fields::all(readers[owner], out.emplace_back());
  return out;
}

double CoupledModel::speed_unit() const { return context_.world.length_unit / context_.world.time_unit; }

ModelStatistics CoupledModel::statistics(std::int64_t round) const {
  const double since = static_cast<double>(round - accounts_.marked_round) * context_.world.substep;
  return accounts_.statistics(reports(), speed_unit(), since);
}

OverlapStatistics CoupledModel::overlaps() const {
  struct Sums {
    double max = 0, sum = 0;
    std::uint64_t count = 0;
  };
  const auto told = collect(*this, transport_, [&](SubModelId id) {
    Sums own;
    sub_models_[id]->world().each_contact([&](const Contact& c) {
      // Both sides know a contact across a cut if ghosts are followers.
      if (context_.followers() && owners_[element_index(scene(), c.a)] != id) return;
      const double overlap = c.overlap / context_.world.length_unit;
      if (overlap > 0) own = {std::max(own.max, overlap), own.sum + overlap, own.count + 1};
    });
    runtime::Bytes out;
    ByteWriter(out).put(own);
    return out;
  });
  Sums all;
  for (const runtime::Bytes& b : told) {
    const Sums one = ByteReader(b).get<Sums>();
    all = {std::max(all.max, one.max), all.sum + one.sum, all.count + one.count};
  }
  return {all.max, all.count == 0 ? 0 : all.sum / static_cast<double>(all.count)};
}

void CoupledModel::save_common(std::vector<std::byte>& out) const {
  ByteWriter w(out);
  fields::all(w, owners_, epoch_begin_, epoch_end_, share_after_cut_, rounds_at_cut_, accounts_, guard_log_);
}

void CoupledModel::load_common(std::span<const std::byte> in) {
  ByteReader r(in);
  fields::all(r, owners_, epoch_begin_, epoch_end_, share_after_cut_, rounds_at_cut_, accounts_, guard_log_);
}

}  // namespace moraine
