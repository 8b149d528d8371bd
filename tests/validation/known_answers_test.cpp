// SPDX-License-Identifier: Apache-2.0
// Every case x every engine that can run it x whole and cut. Each leaves a row for the table in docs/accuracy.md.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/validation/cases/case.hpp"

namespace moraine {
namespace {

using test::Case;
using test::Setting;

/// A case that is not met, by how much at most, and why.
struct Miss {
  std::string_view name, engine;  ///< "": all
  bool cut;
  double at_most;
  std::string_view cause;
};

constexpr std::string_view pyramid = "ODE's friction is a pyramid: right along its sides, wrong at 45°";
constexpr std::string_view implicit = "ODE integrates bonds implicitly, which damps them";
constexpr std::string_view turning =
    "a turn per substep is taken with the inertia at its start: first order in the step";
constexpr std::string_view pulling =
    "the dashpot pulls at the end of a contact and friction counts its force there too: 6.7 % more at e = 0.5";
constexpr std::string_view rim =
    "a real contact slips first at its rim (Mindlin & Deresiewicz 1953), one spring as a whole";
constexpr std::string_view dashpot =
    "damping along the surface is half of that across: the curve is nearest to a fifth, with a spring 1.4 times as "
    "stiff";
constexpr Miss misses[] = {
    {"S2 small bounce", "soft_sphere", false, 0.06, "its weight presses on the spring while the contact lasts"},
    {"S2 small bounce", "soft_sphere", true, 0.06, "its weight presses on the spring while the contact lasts"},
    {"S3 block slides", "ode", false, 0.5, pyramid},
    {"S3 block slides", "ode", true, 0.5, pyramid},
    {"S3 block sticks", "ode", false, 0.35, pyramid},
    {"S3 block sticks", "ode", true, 0.35, pyramid},
    {"S6 top", "", false, 0.03, turning},
    {"S6 top", "", true, 0.03, turning},
    {"T3 along a plane, micro-slip", "soft_sphere", false, 0.095, rim},
    {"T3 along a plane, micro-slip", "soft_sphere", true, 0.095, rim},
    {"T3 spin on a plane, slides", "soft_sphere", false, 0.055, pulling},
    {"T3 spin on a plane, slides", "soft_sphere", true, 0.055, pulling},
    {"T3 spin on a plane, micro-slip", "soft_sphere", false, 0.23, dashpot},
    {"T3 spin on a plane, micro-slip", "soft_sphere", true, 0.23, dashpot},
    {"T3 spin on a big ball, slides", "soft_sphere", false, 0.055, pulling},
    {"T3 spin on a big ball, slides", "soft_sphere", true, 0.055, pulling},
    {"B1 pair, energy", "ode", false, 1, implicit},
    {"B1 pair, energy", "ode", true, 1, implicit},
    {"B1 pair, damping", "ode", false, 0.2, implicit},
    {"B1 pair, damping", "ode", true, 0.2, implicit},
};

struct Trial {
  Case what;
  Setting how;
  double tolerance() const { return how.springs() ? what.tolerance_springs : what.tolerance; }
  std::string name() const { return fmt::format("{} {} {}", what.name, how.engine, how.cut ? "cut" : "whole"); }
};
void PrintTo(const Trial& trial, std::ostream* out) { *out << trial.name(); }

const Miss* miss_of(const Trial& t) {
  for (const Miss& m : misses)
    if (m.name == t.what.name && (m.engine.empty() || m.engine == t.how.engine) && m.cut == t.how.cut) return &m;
  return nullptr;
}

/// Appended to the file that MORAINE_KNOWN_ANSWERS names.
void record(const Trial& t, double error, const Miss* miss) {
  if (const char* file = std::getenv("MORAINE_KNOWN_ANSWERS"))
    std::ofstream(file, std::ios::app) << fmt::format("{}|{}|{}|{}|{}|{}|{}\n", t.what.name, t.what.answer,
                                                      t.tolerance(), t.how.engine, t.how.cut ? "cut" : "whole", error,
                                                      miss ? miss->cause : "");
}

class KnownAnswer : public testing::TestWithParam<Trial> {};

TEST_P(KnownAnswer, IsFound) {
  const Trial& t = GetParam();
  const double error = t.what.error(t.how);
  const Miss* miss = miss_of(t);
  record(t, error, miss);
  if (!miss) {
    EXPECT_LE(error, t.tolerance()) << t.what.answer;
    return;
  }
  EXPECT_LE(error, miss->at_most) << "was missed by less: " << miss->cause;
  EXPECT_GT(error, t.tolerance()) << "is met now: no longer a miss";
}

std::vector<Trial> all_trials() {
  std::vector<Trial> out;
  for (const std::vector<Case>& some : {test::one_body(), test::two_bodies(), test::chung_ooi(), test::bonded(),
                                        test::lattices(), test::many_bodies(), test::consistency(), test::orders()})
    for (const Case& c : some)
      for (const Engine& e : engines())
        for (const bool cut : {false, true})
          if (c.runs_with(e)) out.push_back({c, {std::string(e.name), cut}});
  return out;
}

std::string name_of(const testing::TestParamInfo<Trial>& trial) {
  std::string name = trial.param.name();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, KnownAnswer, testing::ValuesIn(all_trials()), name_of);

}  // namespace
}  // namespace moraine
