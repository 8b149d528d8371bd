// SPDX-License-Identifier: Apache-2.0
// What the library of one precision exports.
#include <dlfcn.h>
#include <fmt/format.h>

#include "physics/bullet/precision.hpp"
#include "physics/bullet/world.hpp"

namespace moraine::bullet {
namespace {

std::string_view file_of(const void* symbol) {
  Dl_info info{};
  return dladdr(symbol, &info) && info.dli_fname ? info.dli_fname : "";
}

/// A program that has loaded a Bullet for everyone would lend it to this library as well, whatever its precision.
void check_precision() {
  const void* symbols[] = {reinterpret_cast<void*>(&btAlignedAllocInternal), &gCalculateCombinedFrictionCallback,
                           &gDeactivationTime};
  for (const void* symbol : symbols)
    if ((file_of(symbol).find("-float64") != std::string_view::npos) != is_double)
      throw IoError(fmt::format("engine {} was given Bullet in another precision, {}: this program must not link to it",
                                engine_name, file_of(symbol)));
}

/// Naming these constants here makes them part of this library; see exports.map.
void check_constants() {
  const void* constants[] = {&btTransform::getIdentity(), &btMatrix3x3::getIdentity()};
  for (const void* constant : constants)
    if (file_of(constant) != file_of(reinterpret_cast<void*>(&check_precision)))
      throw IoError(fmt::format("engine {} was given constants of {}", engine_name, file_of(constant)));
}

}  // namespace
}  // namespace moraine::bullet

extern "C" std::unique_ptr<moraine::World> moraine_make_world(const moraine::WorldSettings& settings,
                                                              const moraine::Vec3& origin) {
  moraine::bullet::check_precision();
  moraine::bullet::check_constants();
  return std::make_unique<moraine::bullet::BulletWorld>(settings, origin);
}
