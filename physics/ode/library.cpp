// SPDX-License-Identifier: Apache-2.0
// What ODE's library exports, and what it makes of the things that ODE has only
// one of in a process.
#include <dlfcn.h>

#include <cstdarg>
#include <cstdio>
#include <string>

#include "physics/errors.hpp"
#include "physics/ode/world.hpp"

/// QuickStep shuffles its rows with ODE's public dRandInt, whose one seed in a
/// process would join all worlds and threads. The dynamic loader lets this one
/// take its place: a number that follows from n alone (the mixing step of
/// SplitMix64, Steele et al. 2014), so every shuffle of so many rows is the
/// same, whoever did what before.
extern "C" int dRandInt(int n) {
  std::uint64_t z = static_cast<std::uint64_t>(n) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  return n > 0 ? static_cast<int>(z % static_cast<std::uint64_t>(n)) : 0;
}

namespace moraine::ode {
namespace {

[[noreturn]] void fail(int, const char* text, va_list arguments) {
  char message[256];
  std::vsnprintf(message, sizeof message, text, arguments);
  throw InvalidStateError("engine ode: " + std::string(message));
}

/// In the program and what it links to. RTLD_DEFAULT would look in this library and what it links to as well.
bool program_links_to_ode() { return dlsym(dlopen(nullptr, RTLD_LAZY), "dWorldQuickStep") != nullptr; }

void start() {
  if (program_links_to_ode())
    throw IoError(
        "engine ode: this program must not link to ODE: its random "
        "numbers would join all worlds");
  if (!dInitODE2(0) || !dAllocateODEDataForThread(dAllocateMaskAll)) throw IoError("engine ode: ODE cannot be started");
  dSetErrorHandler(fail);
  dSetDebugHandler(fail);
}

}  // namespace
}  // namespace moraine::ode

extern "C" std::unique_ptr<moraine::World> moraine_make_world(const moraine::WorldSettings& settings,
                                                              const moraine::Vec3& origin) {
  static const bool started = (moraine::ode::start(), true);
  static_cast<void>(started);
  return std::make_unique<moraine::ode::OdeWorld>(settings, origin);
}
