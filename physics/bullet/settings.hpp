// SPDX-License-Identifier: Apache-2.0
// Every Bullet setting that touches physics, order or rounding, set in one place with its reason.
#pragma once

#include <memory>

#include "physics/world.hpp"

class btDiscreteDynamicsWorld;
class btDefaultCollisionConfiguration;
class btRigidBody;

namespace moraine::bullet {

std::unique_ptr<btDefaultCollisionConfiguration> make_configuration();
void apply_world_settings(btDiscreteDynamicsWorld& world, const WorldSettings& settings);
void apply_body_settings(btRigidBody& body, bool spherical);

}  // namespace moraine::bullet
