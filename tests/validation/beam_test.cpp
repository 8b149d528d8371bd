// SPDX-License-Identifier: Apache-2.0
// A bonded beam hangs as its bonds' equilibrium says, whole and cut.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <vector>

#include "tests/support/model_run.hpp"

namespace moraine {
namespace {

using test::example;
using test::ModelRun;
using test::set;

constexpr std::size_t per_row = 12;

/// Ids: 12 along x, then 3 along y, then 3 along z.
std::size_t sphere(std::size_t along, std::size_t across, std::size_t up) {
  return along + per_row * (across + 3 * up);
}

/// How far the two middle columns are below the three spheres in the notches, compared with the start.
double sag(const std::vector<Vec3>& at, const std::vector<Vec3>& start) {
  const auto fall = [&](std::size_t i) { return start[i].z() - at[i].z(); };
  double middle = 0;
  for (std::size_t k = 0; k < 9; ++k) middle += (fall(sphere(5, k % 3, k / 3)) + fall(sphere(6, k % 3, k / 3))) / 18;
  const double left = (fall(sphere(0, 0, 0)) + fall(sphere(0, 2, 0))) / 2;
  return middle - (left + fall(sphere(per_row - 1, 1, 0))) / 2;
}

std::vector<Vec3> positions(const std::vector<ElementState>& states) {
  std::vector<Vec3> out;
  for (const ElementState& s : states) out.push_back(s.pose.position);
  return out;
}

/// The bonds as a truss that is held where the notches hold: each direction that a notch blocks is a fixed coordinate.
class Truss {
 public:
  explicit Truss(const Scene& scene) : scene_(scene), place_(3 * scene.elements.size(), 0) {
    for (const std::size_t left : {sphere(0, 0, 0), sphere(0, 2, 0)}) place_[3 * left] = place_[3 * left + 2] = held;
    const std::size_t right = sphere(per_row - 1, 1, 0);
    place_[3 * right + 1] = place_[3 * right + 2] = held;
    for (int& p : place_)
      if (p != held) p = free_++;
    for (const Element& e : scene.elements) at_.push_back(e.state.pose.position);
  }

  /// Newton's method for the least of elastic and potential energy, its load raised in steps. The factorisation tells
  /// whether what it finds is stable, and so the only answer around.
  std::vector<Vec3> hang() {
    for (const double load : {0.25, 0.5, 0.75, 1.0})
      for (int k = 0; k < 8; ++k) iterate(load);
    EXPECT_LT(last_move_, 1e-10);
    return at_;
  }

 private:
  static constexpr int held = -1;

  void iterate(double load) {
    pull_ = Eigen::VectorXd::Zero(free_);
    stiffness_ = Eigen::MatrixXd::Zero(free_, free_);
    for (std::size_t i = 0; i < at_.size(); ++i) add(pull_, i, load * scene_.elements[i].mass * scene_.gravity);
    for (const Bond& b : scene_.bonds) add(b);
    const Eigen::LDLT<Eigen::MatrixXd> factors(stiffness_);
    ASSERT_TRUE(factors.isPositive());
    const Eigen::VectorXd move = factors.solve(pull_);
    last_move_ = move.norm();
    for (std::size_t c = 0; c < place_.size(); ++c)
      if (place_[c] != held) at_[c / 3][static_cast<Eigen::Index>(c % 3)] += move[place_[c]];
  }

  void add(const Bond& bond) {
    const Vec3 d = at_[bond.a] - at_[bond.b];
    const double length = d.norm(), tension = bond.stiffness * (length - bond.rest_length);
    const Vec3 n = d / length;
    add(pull_, bond.a, -tension * n);
    add(pull_, bond.b, tension * n);
    const Eigen::Matrix3d along = n * n.transpose();
    const Eigen::Matrix3d block = bond.stiffness * along + tension / length * (Eigen::Matrix3d::Identity() - along);
    add(bond.a, bond.a, block);
    add(bond.b, bond.b, block);
    add(bond.a, bond.b, -block);
    add(bond.b, bond.a, -block);
  }

  void add(Eigen::VectorXd& to, std::size_t i, const Vec3& force) const {
    for (std::size_t c = 0; c < 3; ++c)
      if (place_[3 * i + c] != held) to[place_[3 * i + c]] += force[static_cast<Eigen::Index>(c)];
  }

  void add(std::size_t i, std::size_t j, const Eigen::Matrix3d& block) {
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        if (place_[3 * i + r] != held && place_[3 * j + c] != held)
          stiffness_(place_[3 * i + r], place_[3 * j + c]) +=
              block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
  }

  const Scene& scene_;
  std::vector<int> place_;  ///< of each coordinate among those that are free
  int free_ = 0;
  std::vector<Vec3> at_;
  Eigen::VectorXd pull_;
  Eigen::MatrixXd stiffness_;
  double last_move_ = 0;
};

struct Way {
  const char* engine;
  int parts;
  std::vector<Override> more = {};
};

void PrintTo(const Way& w, std::ostream* out) { *out << w.engine << " in " << w.parts; }

class BondedBeam : public testing::TestWithParam<Way> {};

TEST_P(BondedBeam, HangsAsItsBondsSay) {
  std::vector<Override> overrides = GetParam().more;
  overrides.push_back(set("run.engine", GetParam().engine));
  overrides.push_back(set("run.sub_models", GetParam().parts));
  ModelRun run(example("bonded_beam", overrides));
  const std::vector<Vec3> start = positions(run.model().states());
  run.go();
  const double hung = sag(positions(run.model().states()), start);
  const double wanted = sag(Truss(run.scene()).hang(), start);
  RecordProperty("sag", fmt::format("{:.5f}", hung));
  RecordProperty("truss", fmt::format("{:.5f}", wanted));
  EXPECT_GT(wanted, 0.35);
  EXPECT_NEAR(hung, wanted, 0.01 * wanted);
  EXPECT_EQ(run.model().statistics().bonds_broken, 0U);
  EXPECT_LT(run.model().statistics().linear_residual, 1e-5);
}

/// The finer it is cut, the more substeps it takes: in seven it is 1.3 % off with the scene's 16.
const std::vector<Way> ways = {
    {"bullet", 1},
    {"bullet", 2},
    {"bullet", 3},
    {"bullet", 7, {set("time.substeps", 32)}},
    {"impulse", 1},
    {"impulse", 3},
    {"soft_sphere", 3, {set("time.substeps", 66)}},
};

INSTANTIATE_TEST_SUITE_P(Ways, BondedBeam, testing::ValuesIn(ways),
                         [](const auto& test) { return fmt::format("{}_in_{}", test.param.engine, test.param.parts); });

}  // namespace
}  // namespace moraine
