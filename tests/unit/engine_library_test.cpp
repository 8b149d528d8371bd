// SPDX-License-Identifier: Apache-2.0
// Engines in libraries of their own: found where they should be, and deaf to each other.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "physics/plugin.hpp"
#include "tests/support/engine_scenes.hpp"
#include "tests/support/model_run.hpp"
#include "tests/support/shell.hpp"
#include "tests/support/single_world.hpp"

namespace moraine {
namespace {

namespace fs = std::filesystem;

using test::shell;

const std::string heap = R"(
materials: {rock: {density: 1000, friction: 0.5, restitution: 0.3}}
elements:
  - packing: list
    shape: {box: [0.9, 0.7, 0.8]}
    items:
      - {id: 1, at: [0, 0, 0.6], rotation: {axis: [1, 2, 0], angle: 20}}
      - {id: 2, at: [0.1, 0.2, 1.7], shape: {capsule: {radius: 0.3, length: 0.5}}, rotation: {axis: [1, 0, 0], angle: 80}}
      - {id: 3, at: [0.2, -0.1, 2.6], shape: {hull: {points: [[0.4, 0, 0], [-0.4, 0, 0], [0, 0.4, 0], [0, -0.4, 0], [0, 0, 0.5], [0, 0, -0.5]]}}}
      - {id: 4, at: [9, 0, 5], shape: {sphere: 0.5}, velocity: [1, 0, 0]}
boundaries: [{box: [[-2, -2, 0], [30, 2, 9]], triangulated: true, open_top: true}]
time: {dt: 0.005, steps: 1}
)";

/// Both are stepped in turn; what only one of them resolves tells them apart.
TEST(EngineLibraries, BothPrecisionsWorkInOneProcess) {
  test::SingleWorld single(find_engine("bullet"), scene_of(heap)), twice(find_engine("bullet64"), scene_of(heap));
  for (int k = 0; k < 100; ++k) {
    single.steps(1);
    twice.steps(1);
  }
  for (const ElementId id : single.ids()) {
    EXPECT_LT((single.position(id) - twice.position(id)).norm(), 0.1) << id;
    EXPECT_GT(single.position(id).z(), 0.1) << id << " is on or above the floor";
  }
  EXPECT_NEAR(twice.position(4).x(), 9.5, 1e-12);
  EXPECT_GT(std::abs(single.position(4).x() - 9.5), 1e-9);
  EXPECT_NEAR(single.position(4).x(), 9.5, 5e-5) << "100 times half of what float32 resolves there, all to one side";
}

/// The lines "binding file USER [0] to PROVIDER [0]: ... `SYMBOL'" that the dynamic loader writes of all it resolves.
struct Binding {
  std::string user, provider, symbol;
};

std::vector<Binding> bindings(const std::string& report) {
  std::vector<Binding> out;
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) {
    const auto user = line.find("binding file "), provider = line.find(" to ", user), symbol = line.find('`');
    if (user == std::string::npos || symbol == std::string::npos) continue;
    const auto word = [&](std::size_t at) { return line.substr(at, line.find(' ', at) - at); };
    out.push_back({word(user + 13), word(provider + 4), line.substr(symbol + 1, line.find('\'', symbol) - symbol - 1)});
  }
  return out;
}

/// Both precisions of Bullet's libraries and of ours; 0 for everything else.
int precision(const std::string& file) {
  const std::string name = fs::path(file).filename();
  if (name == "moraine_bullet64.so" || name.find("-float64") != std::string::npos) return 64;
  return name == "moraine_bullet.so" || name.starts_with("libBullet") || name.starts_with("libLinearMath") ? 32 : 0;
}

/// Tables of three numbers in btGjkEpa2.cpp, never written and the same in both precisions; the loader is told to unite
/// them.
bool harmless(const std::string& symbol) { return symbol.starts_with("_ZZN12gjkepa2_impl3EPA6expand"); }

TEST(EngineLibraries, NoSymbolOfOnePrecisionBindsToTheOther) {
  const std::string self = fs::read_symlink("/proc/self/exe");
  const Folder folder;
  const std::string log = (folder.write("log", "").parent_path() / "loader").string();
  const auto ended = shell("LD_BIND_NOW=1 LD_DEBUG=bindings LD_DEBUG_OUTPUT=" + log + " " + self +
                           " --gtest_filter=EngineLibraries.BothPrecisionsWorkInOneProcess && cat " + log + ".*");
  ASSERT_EQ(ended.status, 0) << ended.text.substr(0, 2000);
  std::map<int, int> seen;
  for (const Binding& b : bindings(ended.text)) {
    const int user = precision(b.user), provider = precision(b.provider);
    if (user == 0 || provider == 0 || harmless(b.symbol)) continue;
    EXPECT_EQ(user, provider) << b.user << " uses " << b.symbol << " of " << b.provider;
    ++seen[user];
  }
  EXPECT_GT(seen[32], 100);
  EXPECT_GT(seen[64], 100);
}

/// ODE's one seed in a process would join all worlds and threads; its shuffles must not reach it.
TEST(EngineLibraries, OdeTakesItsRandomNumbersFromUs) {
  test::SingleWorld world(find_engine("ode"), scene_of(test::pile_of(find_engine("ode"))));
  void* ode = dlopen("libode.so.8", RTLD_NOW | RTLD_NOLOAD);
  ASSERT_TRUE(ode);
  const auto seed = reinterpret_cast<unsigned long (*)()>(dlsym(ode, "dRandGetSeed"));
  const unsigned long before = seed();
  world.steps(60);
  EXPECT_GT(world.world().work().contacts, 12U);
  EXPECT_EQ(seed(), before);
}

TEST(EngineLibraries, MissingOneIsNamedWithItsPath) {
  const std::string scene = std::string(MORAINE_SOURCE_DIR) + "/apps/scenes/dam.yaml --set count=10 --steps 1";
  const auto ended = shell("export MORAINE_ENGINES=/nowhere; moraine run --engine bullet64 " + scene);
  EXPECT_EQ(ended.status, 4) << ended.text;
  EXPECT_NE(ended.text.find("/nowhere/moraine_bullet64.so"), std::string::npos) << ended.text;
  EXPECT_EQ(shell("export MORAINE_ENGINES=/nowhere; moraine list").status, 0) << "the table needs no library";
}

TEST(EngineLibraries, FoundInAnInstalledPlace) {
  const Folder folder;
  const fs::path root = folder.write("x", "").parent_path();
  const fs::path built = MORAINE_COMMAND;
  fs::create_directories(root / "bin");
  fs::copy(built, root / "bin/moraine");
  fs::create_directories(root / "lib/moraine");
  for (const char* file : {"moraine_bullet.so", "moraine_bullet64.so"})
    fs::copy(built.parent_path() / "lib/moraine" / file, root / "lib/moraine" / file);
  for (const std::string engine : {"bullet", "bullet64"}) {
    const auto ended = shell(root.string() + "/bin/moraine run " + MORAINE_SOURCE_DIR + "/apps/scenes/dam.yaml --out " +
                             (root / "out").string() + " --set count=10 --steps 1 --engine " + engine);
    EXPECT_EQ(ended.status, 0) << ended.text;
  }
}

}  // namespace
}  // namespace moraine
