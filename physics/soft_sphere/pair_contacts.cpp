// SPDX-License-Identifier: Apache-2.0
#include "physics/soft_sphere/pair_contacts.hpp"

namespace moraine::soft_sphere {

void PairContacts::list(const native::SizedGrid& grid, const Bodies& bodies, double skin,
                        std::span<const LastingPair> lasting) {
  pairs_.build(grid, bodies.ball, bodies.ghost, skin);
  open_.assign(pairs_.size(), 0);
  if (laws_.friction()) sliding_.resize(pairs_.size());
  if (laws_.rolling()) rolling_.resize(pairs_.size());
  root_mass_.resize(pairs_.size());
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    root_mass_[k] =
        1 / std::sqrt(bodies.moving[pairs_.lower()[k]].inverse_mass + bodies.moving[pairs_.higher()[k]].inverse_mass);
  touching_.clear();
  for (const LastingPair& c : lasting) {
    const std::size_t k = pairs_.find(c.low, c.high);
    if (k == pairs_.size()) continue;
    open_[k] = 1;
    touching_.push_back(static_cast<std::uint32_t>(k));
    if (laws_.friction()) sliding_[k] = c.springs.sliding;
    if (laws_.rolling()) rolling_[k] = c.springs.rolling;
  }
}

Springs PairContacts::springs(std::size_t pair) const {
  return {laws_.friction() ? sliding_[pair] : Vec3::Zero(), laws_.rolling() ? rolling_[pair] : Vec3::Zero()};
}

void PairContacts::lasting(std::vector<LastingPair>& out) const {
  out.clear();
  for (const std::uint32_t k : touching_) out.push_back({pairs_.lower()[k], pairs_.higher()[k], springs(k)});
}

void PairContacts::act(Bodies& bodies, double h) {
  find_touching(bodies);
  with_parts(laws_, [&](auto parts) { act_on_touching<decltype(parts)>(bodies, h); });
}

/// Without branches: whether a listed pair touches cannot be guessed.
void PairContacts::find_touching(const Bodies& bodies) {
  const std::size_t count = pairs_.size();
  const std::uint32_t *low = pairs_.lower().data(), *high = pairs_.higher().data();
  const native::Ball* balls = bodies.ball.data();
  touching_.resize(count + 1);
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const native::Ball &a = balls[low[k]], &b = balls[high[k]];
    const double reach = a.radius + b.radius;
    const bool touches = (a.centre - b.centre).squaredNorm() < reach * reach;
    touching_[found] = static_cast<std::uint32_t>(k);
    found += touches;
    open_[k] &= static_cast<std::uint8_t>(touches);
  }
  touching_.resize(found);
}

double PairContacts::energy(const Bodies& bodies) const {
  double sum = 0;
  for (const std::uint32_t k : touching_) {
    const Place i = pairs_.lower()[k], j = pairs_.higher()[k];
    const double a = bodies.ball[i].radius, b = bodies.ball[j].radius;
    const double overlap = a + b - (bodies.position[i] - bodies.position[j]).norm();
    const ContactLaw& law = laws_.of(bodies.moving[i].material, bodies.moving[j].material);
    const double share = bodies.ghost[i] || bodies.ghost[j] ? 0.5 : 1;
    sum += share * elastic_energy(laws_, law, a * b / (a + b), overlap, springs(k));
  }
  return sum;
}

template <class Uses>
void PairContacts::act_on_touching(Bodies& bodies, double h) {
  for (const std::uint32_t k : touching_) {
    const Place i = pairs_.lower()[k], j = pairs_.higher()[k];
    double arm_i = 0, arm_j = 0;
    const Meeting m = meet(bodies, i, j, root_mass_[k], arm_i, arm_j);
    Springs s;
    if (open_[k]) {
      if constexpr (Uses::friction) s.sliding = sliding_[k];
      if constexpr (Uses::rolling) s.rolling = rolling_[k];
    }
    const Push p = push<Uses>(laws_.of(bodies.moving[i].material, bodies.moving[j].material), m, h, s);
    open_[k] = 1;
    bodies.load[i].force += p.force;
    bodies.load[j].force -= p.force;
    if constexpr (Uses::friction) {
      sliding_[k] = s.sliding;
      bodies.load[i].torque += arm_i * p.moment;
      bodies.load[j].torque += arm_j * p.moment;
    }
    if constexpr (Uses::rolling) {
      rolling_[k] = s.rolling;
      bodies.load[i].torque += p.couple;
      bodies.load[j].torque -= p.couple;
    }
  }
}

}  // namespace moraine::soft_sphere
