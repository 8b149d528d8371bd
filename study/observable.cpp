// SPDX-License-Identifier: Apache-2.0
#include "study/observable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "output/summary.hpp"
#include "physics/errors.hpp"

namespace moraine::study {
namespace {

double centre_at_start(const Scene& scene, int axis) {
  double mass = 0, moment = 0;
  for (const Element& e : scene.elements) {
    mass += e.mass;
    moment += e.mass * e.state.pose.position[axis];
  }
  return mass > 0 ? moment / mass : 0;
}

double quantile_at_start(const Scene& scene, int axis, int percent) {
  std::vector<ElementState> states;
  for (const Element& e : scene.elements) states.push_back(e.state);
  return quantile(states, axis, percent / 100.0);
}

/// How far the reference moved it since the start, at least a diameter.
template <int axis>
double centre_moved(const Scene& scene, double reference) {
  return std::max(std::abs(reference - centre_at_start(scene, axis)), scene.typical_diameter());
}

template <int axis, int percent>
double quantile_moved(const Scene& scene, double reference) {
  return std::max(std::abs(reference - quantile_at_start(scene, axis, percent)), scene.typical_diameter());
}

double one(const Scene&, double) { return 1; }

/// The reference's own, at least what lifts all elements by a diameter.
double energy(const Scene& scene, double reference) {
  const double mass = scene.typical_mass() * static_cast<double>(scene.elements.size());
  const double least = std::max(std::abs(reference), mass * scene.gravity.norm() * scene.typical_diameter());
  return least > 0 ? least : 1;
}

/// The reference's own, at least the weight of an element.
double force(const Scene& scene, double reference) {
  const double least = std::max(std::abs(reference), scene.typical_mass() * scene.gravity.norm());
  return least > 0 ? least : 1;
}

double bonds(const Scene& scene, double) { return std::max(1.0, static_cast<double>(scene.bonds.size())); }

constexpr std::array table{
    Observable{"com_x", "centre of mass along x", "m", "/center_of_mass/0", centre_moved<0>},
    Observable{"com_y", "centre of mass along y", "m", "/center_of_mass/1", centre_moved<1>},
    Observable{"com_z", "centre of mass along z", "m", "/center_of_mass/2", centre_moved<2>},
    Observable{"x05", "5 % of the elements have a smaller x", "m", "/quantiles/5/0", quantile_moved<0, 5>},
    Observable{"x50", "half of the elements have a smaller x", "m", "/quantiles/50/0", quantile_moved<0, 50>},
    Observable{"x95", "95 % of the elements have a smaller x: the front", "m", "/quantiles/95/0",
               quantile_moved<0, 95>},
    Observable{"y05", "5 % of the elements have a smaller y", "m", "/quantiles/5/1", quantile_moved<1, 5>},
    Observable{"y50", "half of the elements have a smaller y", "m", "/quantiles/50/1", quantile_moved<1, 50>},
    Observable{"y95", "95 % of the elements have a smaller y", "m", "/quantiles/95/1", quantile_moved<1, 95>},
    Observable{"z05", "5 % of the elements have a smaller z", "m", "/quantiles/5/2", quantile_moved<2, 5>},
    Observable{"z50", "half of the elements have a smaller z", "m", "/quantiles/50/2", quantile_moved<2, 50>},
    Observable{"z95", "95 % of the elements have a smaller z: the height", "m", "/quantiles/95/2",
               quantile_moved<2, 95>},
    Observable{"overlap_max", "largest overlap", "diameters", "/overlap/max", one},
    Observable{"overlap_mean", "mean overlap", "diameters", "/overlap/mean", one},
    Observable{"kinetic_energy", "at the end", "J", "/kinetic_energy", energy},
    Observable{"dissipated", "energy lost since the start", "J", "/energy/dissipated", energy},
    Observable{"energy_gained", "energy that came from nowhere", "J", "/energy/gained", energy},
    Observable{"floor_force", "of all boundaries along z, mean over the last fifth", "N", "/boundary_force/2", force},
    Observable{"bonds_broken", "bonds that broke, of all", "", "/bonds/broken", bonds},
};

}  // namespace

std::span<const Observable> observables() { return table; }

const Observable& find_observable(std::string_view name, const std::string& place) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Observable& o) { return o.name == name; });
  if (found != table.end()) return *found;
  std::string known;
  for (const Observable& o : table) known += fmt::format("\n  {:<14} {}", o.name, o.help);
  throw InputError(fmt::format("{}: unknown observable '{}', expected one of:{}", place, name, known));
}

std::optional<double> value_of(const Observable& observable, const nlohmann::json& summary) {
  const nlohmann::json::json_pointer pointer{std::string(observable.pointer)};
  if (!summary.contains(pointer) || !summary.at(pointer).is_number()) return std::nullopt;
  return summary.at(pointer).get<double>();
}

}  // namespace moraine::study
