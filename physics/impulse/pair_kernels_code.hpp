// SPDX-License-Identifier: Apache-2.0
// The kernels themselves, once per processor: included by files that are compiled with different options. Formulas are
// explained in contact_row.hpp and step_rule.hpp.
#pragma once

#include "physics/impulse/advance_kernel_code.hpp"
#include "physics/impulse/near_kernel_code.hpp"

namespace moraine::impulse {
namespace {

// ---- which pairs may meet

/// The eight pairs from place `at` in a list; those behind its end repeat the last.
struct PairIndices {
  std::uint32_t pair[batch_lanes], a[batch_lanes], b[batch_lanes];
};
MORAINE_INLINE PairIndices indices(const PairTable& table, const std::uint32_t* pairs, std::size_t at,
                                   std::size_t count) {
  PairIndices i;
  for (std::size_t k = 0; k < batch_lanes; ++k) {
    const std::size_t place = at + k < count ? at + k : count - 1;
    i.pair[k] = pairs != nullptr ? pairs[place] : static_cast<std::uint32_t>(place);
    i.a[k] = table.lower[i.pair[k]];
    i.b[k] = table.higher[i.pair[k]];
  }
  return i;
}

/// Those within reach.
MORAINE_INLINE std::size_t find_close(const PairFindTask& task) {
  std::uint32_t* end = task.close;
  for (std::size_t at = task.begin; at < task.end; at += batch_lanes) {
    const PairIndices i = indices(task.table, nullptr, at, task.end);
    const Four a = gather(task.bodies.position, i.a, 4), b = gather(task.bodies.position, i.b, 4);
    const Wide between = a.xyz - b.xyz;
    const F8 limit = a.w + b.w + all(task.numbers.reach);
    end = append(end, i.pair, bits(dot(between, between) < limit * limit) & in_use(at, task.end));
  }
  return static_cast<std::size_t>(end - task.close);
}

/// How eight pairs lie.
struct Lie {
  Wide normal;  ///< unit, towards a
  F8 gap;
};
MORAINE_INLINE Lie lie(const BodyArrays& bodies, const std::uint32_t* of_a, const std::uint32_t* of_b) {
  const Four a = gather(bodies.position, of_a, 4), b = gather(bodies.position, of_b, 4);
  const Wide between = a.xyz - b.xyz;
  const F8 distance = root(dot(between, between)), inverse = all(1) / distance;
  const I8 apart = distance > all(0);
  return {{choose(apart, inverse * between.x, all(0)), choose(apart, inverse * between.y, all(0)),
           choose(apart, inverse * between.z, all(1))},
          distance - a.w - b.w};
}

/// By the materials of the bodies.
MORAINE_INLINE F8 law(float PairConstants::*which, const PairLaws& table, const BodyArrays& bodies,
                      const std::uint32_t* a, const std::uint32_t* b) {
  if (table.materials == 1) return all(table.of[0].*which);
  PairBatch::Lanes out;
  for (std::size_t k = 0; k < batch_lanes; ++k)
    out[k] = table.of[bodies.material[a[k]] * table.materials + bodies.material[b[k]]].*which;
  return load(out);
}

/// Speed after the impact, 0 if it is too slow to rebound.
MORAINE_INLINE F8 rebound_of(const F8& closing, const F8& restitution, const StepNumbers& n) {
  return choose(closing > all(n.threshold), restitution * closing, all(0));
}
/// Of these none carries, so that they may meet when they overlap.
MORAINE_INLINE I8 alone(const BodyArrays& bodies, const std::uint32_t* a, const std::uint32_t* b) {
  std::int32_t alone[batch_lanes];
  for (std::size_t k = 0; k < batch_lanes; ++k) alone[k] = (bodies.carries[a[k]] | bodies.carries[b[k]]) != 0 ? 0 : -1;
  I8 out;
  __builtin_memcpy(&out, alone, sizeof out);
  return out;
}

/// Of those within reach, the ones that close fast enough.
template <bool Restitution>
std::size_t find_meeting(const PairFindTask& task) {
  const StepNumbers& n = task.numbers;
  const std::size_t count = find_close(task);
  std::uint32_t* end = task.out;
  for (std::size_t at = 0; at < count; at += batch_lanes) {
    const PairIndices i = indices(task.table, task.close, at, count);
    const Lie l = lie(task.bodies, i.a, i.b);
    const F8 closing = dot(l.normal, gather(task.bodies.moving, i.b, 8).xyz - gather(task.bodies.moving, i.a, 8).xyz);
    F8 range = smaller(all(n.slack) + all(n.h) * larger(closing, all(0)), all(n.reach));
    if constexpr (Restitution) {
      const F8 rebound = rebound_of(closing, law(&PairConstants::restitution, task.laws, task.bodies, i.a, i.b), n);
      range = choose((rebound > all(0)) & alone(task.bodies, i.a, i.b), all(0), range);
    }
    end = append(end, i.pair, bits(l.gap < range) & in_use(at, count));
  }
  return static_cast<std::size_t>(end - task.out);
}

// ---- solving

/// Two bodies of every lane.
struct Bodies8 {
  Four velocity_a, velocity_b;  ///< with 0
  Four turning_a, turning_b;    ///< with the inverse masses
};

MORAINE_INLINE Bodies8 read(const PairBatch& batch, const float* moving) {
  return {gather(moving, batch.a, 8), gather(moving, batch.b, 8), gather(moving + 4, batch.a, 8),
          gather(moving + 4, batch.b, 8)};
}

/// Gives the bodies an impulse, the tangential part of which is `side`, and writes them back.
template <bool Friction>
MORAINE_INLINE void apply(const PairBatch& batch, Bodies8 m, const Wide& impulse, const Wide& side, const Wide& normal,
                          float* moving) {
  const F8 of_a = m.turning_a.w, of_b = m.turning_b.w;
  m.velocity_a.xyz = m.velocity_a.xyz + of_a * impulse;
  m.velocity_b.xyz = m.velocity_b.xyz - of_b * impulse;
  scatter(m.velocity_a, moving, batch.a, 8);
  scatter(m.velocity_b, moving, batch.b, 8);
  if constexpr (Friction) {
    const Wide turned = all(2.5F) * cross(side, normal);
    m.turning_a.xyz = m.turning_a.xyz + of_a * turned;
    m.turning_b.xyz = m.turning_b.xyz + of_b * turned;
    scatter(m.turning_a, moving + 4, batch.a, 8);
    scatter(m.turning_b, moving + 4, batch.b, 8);
  }
}

/// Bodies that carry start a step with the velocity of that load: in a contact that lasts, that is
/// no impact, and a rebound from it would raise energy. After an impact, rebounds of the steps that follow get smaller.
template <bool Restitution>
MORAINE_INLINE void prepare(PairBatch& batch, const PairStartTask& task, const Lie& l, const F8& carried) {
  const StepNumbers& n = task.numbers;
  F8 rebound = all(0);
  F8 approach = all(n.closing) * larger(l.gap, all(0)) -
                smaller(all(n.opening) * larger(-l.gap, all(0)), all(StepNumbers::push_limit));
  if constexpr (Restitution) {
    const Wide before_a = gather(task.bodies.before, batch.a, 4).xyz,
               before_b = gather(task.bodies.before, batch.b, 4).xyz;
    const I8 none_carries = alone(task.bodies, batch.a, batch.b);
    const F8 restitution = law(&PairConstants::restitution, task.laws, task.bodies, batch.a, batch.b);
    const F8 fresh = rebound_of(dot(l.normal, before_b - before_a), restitution, n);
    const F8 limit = all(-StepNumbers::again) * carried;
    const F8 again = choose(limit > all(n.threshold), smaller(fresh, limit), all(0));
    rebound = choose(none_carries | (carried == all(0)), fresh, again);
    const I8 bounces = (rebound > all(0)) & none_carries;
    approach = choose(bounces, -rebound, approach);
    rebound = choose(bounces, rebound, -rebound);
  }
  store(approach, batch.approach);
  store(rebound, batch.rebound);
}

/// The places of eight pairs among those that carry something.
struct CarriedPlaces {
  std::uint32_t of[batch_lanes];
};
MORAINE_INLINE CarriedPlaces places(const PairCarried& carried, const PairBatch& batch) {
  CarriedPlaces places;
  for (std::size_t k = 0; k < batch_lanes; ++k) {
    const std::uint32_t place = batch.pair[k] - carried.first;
    places.of[k] = place < carried.count ? place : carried.count;
  }
  return places;
}

template <bool Friction, bool Restitution>
void start_all(const PairStartTask& task) {
  for (std::size_t at = 0; at < task.count; at += batch_lanes) {
    PairBatch& batch = task.batches[at / batch_lanes];
    for (std::size_t k = 0; k < batch_lanes; ++k) {
      batch.pair[k] = task.pairs[at + k < task.count ? at + k : at];
      batch.a[k] = task.table.lower[batch.pair[k]];
      batch.b[k] = task.table.higher[batch.pair[k]];
    }
    const Lie l = lie(task.bodies, batch.a, batch.b);
    const Bodies8 m = read(batch, task.bodies.moving);
    const Four carried = gather(task.carried.of, places(task.carried, batch).of, 4);
    prepare<Restitution>(batch, task, l, carried.w);
    Wide side{};
    if constexpr (Friction) side = carried.xyz - dot(carried.xyz, l.normal) * l.normal;
    const F8 push = larger(carried.w, all(0));
    store(l.normal, batch.normal);
    store(side, batch.side);
    store(push, batch.push);
    apply<Friction>(batch, m, push * l.normal + side, side, l.normal, task.bodies.moving);
  }
}

/// How a contact yields.
struct Soft {
  F8 mass_scale, yielding;
};
template <bool Friction>
MORAINE_INLINE void correct(PairBatch& batch, const PairTask& task, const Soft& soft, const F8& approach) {
  const Bodies8 m = read(batch, task.bodies.moving);
  const F8 mass = all(1) / (m.turning_a.w + m.turning_b.w);
  const Wide normal = load(batch.normal);
  Wide slip = m.velocity_a.xyz - m.velocity_b.xyz;
  if constexpr (Friction) slip = slip - cross(m.turning_a.xyz + m.turning_b.xyz, normal);
  const F8 parting = dot(normal, slip), before = load(batch.push);
  const F8 push = larger(before - soft.mass_scale * mass * (parting + approach) - soft.yielding * before, all(0));
  store(push, batch.push);
  Wide impulse = (push - before) * normal, change{};
  if constexpr (Friction) {
    const F8 friction = law(&PairConstants::friction, task.laws, task.bodies, batch.a, batch.b);
    const Wide old = load(batch.side), across = slip - parting * normal;
    const Wide wanted = old - (all(2.0F / 7) * mass) * across;
    const F8 limit = friction * push, size2 = larger(dot(wanted, wanted), all(1e-30F));
    const Wide side = (limit / root(larger(size2, limit * limit))) * wanted;
    store(side, batch.side);
    change = side - old;
    impulse = impulse + change;
  }
  apply<Friction>(batch, m, impulse, change, normal, task.bodies.moving);
}

template <bool Friction>
void sweep_all(const PairTask& task) {
  const F8 zero = all(0);
  for (std::size_t k = 0; k < task.count; ++k) {
    PairBatch& batch = task.batches[k];
    const F8 approach = load(batch.approach);
    const I8 hard = (approach > zero) | (load(batch.rebound) > zero);
    const Soft soft{choose(hard, all(1), all(task.numbers.mass_scale)),
                    choose(hard, zero, all(task.numbers.impulse_scale))};
    correct<Friction>(batch, task, soft, approach);
  }
}

/// Contacts that met within the step get the normal that they have now.
MORAINE_INLINE void turn(PairBatch& batch, const I8& met, const BodyArrays& bodies) {
  if (bits(met) == 0) return;
  const Wide between = gather(bodies.position, batch.a, 4).xyz - gather(bodies.position, batch.b, 4).xyz;
  const Wide old = load(batch.normal);
  const F8 distance = root(dot(between, between));
  const I8 turns = met & (distance > all(0));
  store(Wide{choose(turns, between.x / distance, old.x), choose(turns, between.y / distance, old.y),
             choose(turns, between.z / distance, old.z)},
        batch.normal);
}

/// Speed after the impact, of soft contacts too.
MORAINE_INLINE F8 speed_after(const PairBatch& batch) {
  const F8 rebound = load(batch.rebound);
  return larger(rebound, -rebound);
}

template <bool Friction>
void relax_all(const PairTask& task) {
  const F8 zero = all(0);
  for (std::size_t k = 0; k < task.count; ++k) {
    PairBatch& batch = task.batches[k];
    const I8 carries = load(batch.push) > zero, apart = load(batch.approach) > zero;
    const F8 approach = choose(carries, -speed_after(batch), choose(apart, all(1e10F), zero));
    turn(batch, carries & apart, task.bodies);
    correct<Friction>(batch, task, {all(1), zero}, approach);
  }
}

// ---- from one step to the next

MORAINE_INLINE std::uint32_t place_of(const PairTable& table, const PairRows& rows, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t row = a - rows.first;
  if (row >= rows.count) return ~0U;
  const auto wanted = static_cast<std::int32_t>(b);
  for (std::uint32_t k = rows.begin[row]; k < rows.begin[row + 1]; k += batch_lanes) {
    I8 higher;
    __builtin_memcpy(&higher, table.higher + k, sizeof higher);
    const unsigned found = bits(higher == wanted) & in_use(k, rows.begin[row + 1]);
    if (found != 0) return k + static_cast<std::uint32_t>(__builtin_ctz(found));
  }
  return ~0U;
}

void place(const PairPlaceTask& task) {
  for (std::size_t i = 0; i < task.count; ++i) {
    PairBatch& batch = task.batches[i];
    for (std::size_t k = 0; k < batch_lanes; ++k)
      batch.pair[k] = place_of(task.table, task.rows, batch.a[k], batch.b[k]);
  }
}

MORAINE_INLINE void carry(const PairBatch& batch, const PairCarried& to) {
  const F8 rebound = speed_after(batch);
  const I8 goes_on = rebound <= all(0);
  const Wide side = load(batch.side);
  const F8 zero = all(0), push = load(batch.push);
  scatter({{choose(goes_on, side.x, zero), choose(goes_on, side.y, zero), choose(goes_on, side.z, zero)},
           choose(goes_on, push, choose(push > zero, -rebound, zero))},
          to.of, places(to, batch).of, 4);
}

void carry(const PairCarryTask& task) {
  for (std::size_t k = 0; k < task.count; ++k) carry(task.batches[k], task.to);
}

std::size_t find(const PairFindTask& task) {
  return task.features.restitution ? find_meeting<true>(task) : find_meeting<false>(task);
}
void start(const PairStartTask& task) {
  if (task.features.friction)
    task.features.restitution ? start_all<true, true>(task) : start_all<true, false>(task);
  else
    task.features.restitution ? start_all<false, true>(task) : start_all<false, false>(task);
}
void sweep(const PairTask& task) { task.features.friction ? sweep_all<true>(task) : sweep_all<false>(task); }
void relax(const PairTask& task) { task.features.friction ? relax_all<true>(task) : relax_all<false>(task); }

constexpr PairKernels kernels_of_this_file{near, find, start, sweep, relax, place, carry, advance};

#undef MORAINE_INLINE

}  // namespace
}  // namespace moraine::impulse
