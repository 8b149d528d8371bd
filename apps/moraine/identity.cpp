// SPDX-License-Identifier: Apache-2.0
#include "identity.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include "output/scene_table.hpp"
#include "physics/bytes.hpp"
#include "physics/world.hpp"

namespace moraine::app {
namespace {

void put(ByteWriter& w, const std::string& text) { w.put_all(std::span(text.data(), text.size())); }

void put(ByteWriter& w, const Vec3& v) { w.put_all(std::span(v.data(), 3)); }

void put(ByteWriter& w, const Twist& t) {
  put(w, t.linear);
  put(w, t.angular);
}

void put(ByteWriter& w, const Element& e) {
  w.put(e.id);
  w.put(e.shape);
  w.put(e.material);
  w.put(e.mass);
  put(w, e.state.pose.position);
  w.put_all(std::span(e.state.pose.orientation.coeffs().data(), 4));
  put(w, e.state.twist);
}

void put(ByteWriter& w, const Boundary& b) {
  const Motion& m = b.motion;
  put(w, m.velocity);
  put(w, m.centre);
  for (const double x : {m.start, m.stop, m.ramp}) w.put(x);
  w.put(b.material);
}

void put(ByteWriter& w, const Bond& b) {
  w.put(b.a);
  w.put(b.b);
  for (const double x : {b.rest_length, b.stiffness, b.damping, b.break_length}) w.put(x);
}

void put(ByteWriter& w, const Material& m) {
  for (const double x : {m.normal_stiffness, m.young, m.poisson}) w.put(x);
}

void put(ByteWriter& w, const PairLaw& law) {
  for (const double x : {law.friction, law.restitution, law.rolling_friction}) w.put(x);
}

void put(ByteWriter& w, const RunSettings& r, const Engine& engine) {
  for (const std::string* text : {&r.engine_profile, &r.split, &r.coupling}) put(w, *text);
  w.put(r.coupling_leak.value_or(engine.coupling_leak));
  for (const double x : {r.skin, r.recut_ghost_share, r.overlap_recovery, r.max_speed, r.skip_threshold}) w.put(x);
  w.put(r.sub_models);
  w.put(r.iterations);
}

template <class List>
void put_each(ByteWriter& w, const List& list) {
  w.put(static_cast<std::uint64_t>(list.size()));
  for (const auto& item : list) put(w, item);
}

}  // namespace

std::string identity(const Scene& scene) {
  std::vector<std::byte> bytes;
  ByteWriter w(bytes);
  put(w, geometry_text(scene));
  put(w, scene.gravity);
  put_each(w, scene.elements);
  put_each(w, scene.boundaries);
  put_each(w, scene.bonds);
  put_each(w, scene.materials.materials);
  put_each(w, scene.materials.pairs);
  w.put(scene.time.dt);
  w.put(scene.time.substeps);
  const Engine& engine = find_engine(scene.run.engine, scene);
  put(w, std::string(engine.name));
  put(w, scene.run, engine);
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace moraine::app
