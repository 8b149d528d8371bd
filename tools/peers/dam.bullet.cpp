// SPDX-License-Identifier: Apache-2.0
// The collapse of apps/scenes/dam.yaml in Bullet, as a user of it would write: the default broad phase, dispatcher and
// solver in one world. Bodies never sleep; all else is as Bullet has it. What the engine `bullet` is measured against.
//   stock_bullet LAYOUT FINAL NAME=VALUE ...     friction, dt [s], steps, iterations, length, width [m] of the box
#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using Values = std::map<std::string, double>;

class Dam {
 public:
  explicit Dam(const Values& v) : friction_(std::sqrt(static_cast<btScalar>(v.at("friction")))) {  // of a pair: product
    world_.setGravity({0, 0, btScalar(-9.81)});
    world_.getSolverInfo().m_numIterations = static_cast<int>(v.at("iterations"));
    const auto length = static_cast<btScalar>(v.at("length")), width = static_cast<btScalar>(v.at("width"));
    for (const auto& [normal, at] : {std::pair{btVector3(1, 0, 0), btScalar(0)},
                                     {btVector3(-1, 0, 0), -length},
                                     {btVector3(0, 1, 0), btScalar(0)},
                                     {btVector3(0, -1, 0), -width},
                                     {btVector3(0, 0, 1), btScalar(0)}}) {
      shapes_.push_back(std::make_unique<btStaticPlaneShape>(normal, at));
      add(shapes_.back().get(), 0, btVector3(0, 0, 0));
    }
  }

  /// Of 1 kg.
  void add_sphere(btScalar radius, const btVector3& at) {
    if (!sphere_) sphere_ = std::make_unique<btSphereShape>(radius);
    add(sphere_.get(), 1, at);
  }

  void step(btScalar dt) { world_.stepSimulation(dt, 0); }

  /// Rows of id, x, y, z.
  void write(std::FILE* out) const {
    int id = 0;
    for (const auto& body : bodies_) {
      if (body->isStaticObject()) continue;
      const btVector3& at = body->getWorldTransform().getOrigin();
      std::fprintf(out, "%d %.9g %.9g %.9g\n", ++id, at.x(), at.y(), at.z());
    }
  }

  ~Dam() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

 private:
  void add(btCollisionShape* shape, btScalar mass, const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(at);
    info.m_friction = friction_;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  btScalar friction_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btSphereShape> sphere_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

Values values(int count, char** arguments) {
  Values all;
  for (int i = 0; i < count; ++i) {
    const std::string text = arguments[i];
    const auto at = text.find('=');
    if (at != std::string::npos) all[text.substr(0, at)] = std::atof(text.c_str() + at + 1);
  }
  return all;
}

/// Rows of a data file of LAMMPS: id, type, diameter, density, x, y, z.
void read_layout(const char* file, Dam& dam) {
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && line != "Atoms") {
  }
  while (std::getline(in, line)) {
    std::istringstream row(line);
    double id = 0, type = 0, diameter = 0, density = 0, x = 0, y = 0, z = 0;
    if (row >> id >> type >> diameter >> density >> x >> y >> z)
      dam.add_sphere(btScalar(diameter / 2), btVector3(btScalar(x), btScalar(y), btScalar(z)));
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  const Values v = values(count - 3, arguments + 3);
  Dam dam(v);
  read_layout(arguments[1], dam);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < static_cast<int>(v.at("steps")); ++k) dam.step(static_cast<btScalar>(v.at("dt")));
  std::printf("Loop time of %g\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  std::FILE* out = std::fopen(arguments[2], "w");
  if (out == nullptr) return 4;
  dam.write(out);
  return std::fclose(out) == 0 ? 0 : 4;
}
