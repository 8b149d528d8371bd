// SPDX-License-Identifier: Apache-2.0
// A scene as plain data: what exists at t = 0 and how long it runs. Knows no engine, no files, no threads.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "physics/scene/settings.hpp"
#include "physics/scene/study_settings.hpp"
#include "physics/shape.hpp"
#include "physics/types.hpp"

namespace moraine {

struct Material {
  std::string name;
  double density = 0;      ///< [kg/m^3]
  double friction = 0;     ///< Coulomb coefficient of the material against itself
  double restitution = 0;  ///< normal restitution of the material against itself, 0 .. 1
  // For engines whose contacts are springs:
  double rolling_friction = 0;  ///< torque / (normal force * radius), of the material against itself
  double normal_stiffness = 0;  ///< of a contact with itself [N/m]; 0: the engine's default
  double young = 0;             ///< modulus [Pa]; 0: contacts are linear springs
  double poisson = 0.25;        ///< ratio; used with young
};

/// Values that hold for a pair of materials.
struct PairLaw {
  double friction = 0;
  double restitution = 0;
  double rolling_friction = 0;
};

/// Every pair's law; symmetric. Unless a scene states a pair, its values are the geometric means.
class MaterialTable {
 public:
  std::vector<Material> materials;
  std::vector<PairLaw> pairs;  ///< materials.size() squared, row-major

  const PairLaw& pair(std::uint32_t a, std::uint32_t b) const { return pairs[a * materials.size() + b]; }
  bool any_friction() const;
  bool any_restitution() const;
};

struct Element {
  ElementId id = 0;
  std::uint32_t shape = 0;     ///< index into Scene::shapes
  std::uint32_t material = 0;  ///< index into MaterialTable::materials
  double mass = 0;             ///< [kg]; volume times density unless the scene states it
  ElementState state;
};

/// The half space below the plane is solid; the normal points to where elements may be.
struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};
/// Triangles in the boundary's frame; both sides are solid.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
/// A solid of the scene's shape table, fixed or driven.
struct Solid {
  std::uint32_t shape = 0;
};

/// Prescribed motion from `start` to `stop` [s]: at rest before and after. With `ramp` [s] the speed rises and falls
/// as a half cosine over that time at both ends, and the distance travelled is still velocity * (stop - start - ramp).
struct Motion {
  Twist velocity;              ///< linear [m/s]; angular [rad/s] about `centre`
  Vec3 centre = Vec3::Zero();  ///< of rotation, world frame at t = 0 [m]
  double start = 0;
  double stop = std::numeric_limits<double>::infinity();
  double ramp = 0;

  bool moves() const { return !velocity.linear.isZero(0) || !velocity.angular.isZero(0); }
  /// Pose and velocity at time t of a body that was at `initial` at t = 0.
  Pose pose(const Pose& initial, double t) const;
  Twist twist(const Pose& initial, double t) const;
};

struct Boundary {
  std::variant<Plane, TriangleMesh, Solid> geometry;
  Pose pose;  ///< of the geometry's frame at t = 0
  std::uint32_t material = 0;
  Motion motion;
};

/// A central spring and dashpot between two elements that breaks for good when longer than break_length.
struct Bond {
  ElementId a = 0, b = 0;   ///< a < b
  double rest_length = 0;   ///< [m]
  double stiffness = 0;     ///< [N/m]
  double damping = 0;       ///< [N s/m]
  double break_length = 0;  ///< [m]
};

/// Random speeds that were added to the elements' own, so that runs can be told apart by a seed.
struct Perturbation {
  double speed = 0;  ///< standard deviation of each velocity component [m/s]
  std::uint64_t seed = 1;
};

struct Scene {
  std::string name;
  std::string source;  ///< the file it was read from
  Vec3 gravity = {0, 0, -9.81};
  MaterialTable materials;
  std::vector<Shape> shapes;
  std::vector<Element> elements;  ///< ascending id
  std::vector<Boundary> boundaries;
  std::vector<Bond> bonds;    ///< ascending (a, b)
  Perturbation perturbation;  ///< contained in the elements' velocities
  TimeSettings time;
  RunSettings run;
  OutputSettings output;
  StudySettings study;
  std::vector<std::string> warnings;

  const Shape& shape_of(const Element& e) const { return shapes[e.shape]; }
  /// Mean bounding diameter of the elements [m]: the length unit inside engines. 1 if there are none.
  double typical_diameter() const;
  /// Mean mass of the elements [kg]: the mass unit inside engines. 1 if there are none.
  double typical_mass() const;
};

}  // namespace moraine
