// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same with every compiler and library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "physics/types.hpp"

namespace moraine {

/// Uniform in [0, 1) from 53 of 64 random bits.
inline double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

/// A stream of numbers drawn one after the other.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * unit_interval(engine_()); }
  Vec3 in_box(const Bounds& box) {
    const double x = uniform(box.min.x(), box.max.x());
    const double y = uniform(box.min.y(), box.max.y());
    return {x, y, uniform(box.min.z(), box.max.z())};
  }
  /// Uniform over all orientations. Source: Shoemake (1992).
  Quat orientation() {
    using std::numbers::pi;
    const double u = uniform(0, 1), a = uniform(0, 2 * pi), b = uniform(0, 2 * pi);
    const double s = std::sqrt(1 - u), c = std::sqrt(u);
    return {c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)};
  }

 private:
  std::mt19937_64 engine_;
};

/// A well-mixed value for a key. Source: SplitMix64 (Steele, Lea & Flood 2014).
inline std::uint64_t mixed(std::uint64_t key) {
  key += 0x9e3779b97f4a7c15u;
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return key ^ (key >> 31);
}

/// A standard normal number that belongs to (seed, a, b), whatever was drawn before. Source: Box & Muller (1958).
inline double normal_of(std::uint64_t seed, std::uint32_t a, std::uint32_t b) {
  const std::uint64_t key = mixed(mixed(seed) ^ (std::uint64_t{a} << 32 | b));
  const double radius = std::sqrt(-2 * std::log(1 - unit_interval(key)));
  return radius * std::cos(2 * std::numbers::pi * unit_interval(mixed(key)));
}

}  // namespace moraine
