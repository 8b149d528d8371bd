// SPDX-License-Identifier: Apache-2.0
// These sources are compiled twice, for Bullet in float32 and in float64.
#pragma once

#include <LinearMath/btScalar.h>

#include <cstdint>
#include <string_view>
#include <type_traits>

namespace moraine::bullet {

inline constexpr bool is_double = sizeof(btScalar) == sizeof(double);
inline constexpr std::string_view engine_name = is_double ? "bullet64" : "bullet";
/// An integer with as many bits as btScalar.
using ScalarBits = std::conditional_t<is_double, std::uint64_t, std::uint32_t>;

}  // namespace moraine::bullet
