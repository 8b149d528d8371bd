// SPDX-License-Identifier: Apache-2.0
#include "ghosting/messages.hpp"

#include "physics/bytes.hpp"

namespace moraine {
namespace {

// Eigen types do not claim to be trivially copyable; the wire forms below are plain doubles.
struct WireMotion {
  double displacement[3], rotation[3], linear[3], angular[3];
};
struct WireResult {
  std::uint32_t element, reserved;
  WireMotion motion;
};
struct WireBorder {
  double position[3], velocity[3], radius;
};
struct WireOrder {
  std::uint32_t element, carries;
  double share, position[3], orientation[4], linear[3], angular[3];
};
static_assert(sizeof(WireResult) == 104 && sizeof(WireBorder) == 56 && sizeof(WireOrder) == 120);

void put(const Vec3& v, double* to) {
  for (int a = 0; a < 3; ++a) to[a] = v[a];
}
Vec3 vec(const double* v) { return {v[0], v[1], v[2]}; }

WireResult wire(const GhostResult& r) {
  WireResult w{r.element, 0, {}};
  put(r.motion.displacement, w.motion.displacement);
  put(r.motion.rotation, w.motion.rotation);
  put(r.motion.twist.linear, w.motion.linear);
  put(r.motion.twist.angular, w.motion.angular);
  return w;
}
GhostResult plain(const WireResult& w) {
  return {w.element,
          0,
          {vec(w.motion.displacement), vec(w.motion.rotation), {vec(w.motion.linear), vec(w.motion.angular)}}};
}

WireBorder wire(const BorderElement& b) {
  WireBorder w{{}, {}, b.radius};
  put(b.position, w.position);
  put(b.velocity, w.velocity);
  return w;
}
BorderElement plain(const WireBorder& w) { return {vec(w.position), vec(w.velocity), w.radius}; }

WireOrder wire(const GhostOrder& g) {
  WireOrder w{g.element, g.carries, g.share, {}, {}, {}, {}};
  const Quat& q = g.start.pose.orientation;
  put(g.start.pose.position, w.position);
  const double coefficients[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(coefficients, coefficients + 4, w.orientation);
  put(g.start.twist.linear, w.linear);
  put(g.start.twist.angular, w.angular);
  return w;
}
GhostOrder plain(const WireOrder& w) {
  const double* q = w.orientation;
  return {w.element,
          w.carries != 0,
          w.share,
          {{vec(w.position), Quat(q[0], q[1], q[2], q[3])}, {vec(w.linear), vec(w.angular)}}};
}

template <class Wire, class Plain>
void put_all(ByteWriter& w, const std::vector<Plain>& values) {
  w.put(static_cast<std::uint64_t>(values.size()));
  for (const Plain& v : values) w.put(wire(v));
}
template <class Wire, class Plain>
void get_all(ByteReader& r, std::vector<Plain>& values) {
  const auto count = r.get<std::uint64_t>();
  values.clear();
  for (std::uint64_t i = 0; i < count; ++i) values.push_back(plain(r.get<Wire>()));
}

}  // namespace

void StepMessage::write(std::vector<std::byte>& out) const {
  out.clear();
  ByteWriter w(out);
  put_all<WireResult>(w, results);
  w.put(static_cast<std::uint8_t>(border_is_new));
  put_all<WireBorder>(w, border);
  w.put_all(std::span<const std::uint32_t>(broken_bonds));
  w.put(static_cast<std::uint8_t>(resting));
}

void StepMessage::read(std::span<const std::byte> in) {
  ByteReader r(in);
  get_all<WireResult>(r, results);
  border_is_new = r.get<std::uint8_t>() != 0;
  get_all<WireBorder>(r, border);
  r.get_all(broken_bonds);
  resting = r.get<std::uint8_t>() != 0;
}

void BoundMessage::write(std::vector<std::byte>& out) const {
  out.clear();
  ByteWriter w(out);
  double box[7];
  put(bounds.min, box);
  put(bounds.max, box + 3);
  box[6] = max_speed;
  for (const double x : box) w.put(x);
  put_all<WireOrder>(w, ghosts);
  w.put_all(std::span<const std::uint32_t>(broken_bonds));
  w.put(static_cast<std::uint8_t>(resting));
}

void BoundMessage::read(std::span<const std::byte> in) {
  ByteReader r(in);
  double box[7];
  for (double& x : box) x = r.get<double>();
  bounds = {vec(box), vec(box + 3)};
  max_speed = box[6];
  get_all<WireOrder>(r, ghosts);
  r.get_all(broken_bonds);
  resting = r.get<std::uint8_t>() != 0;
}

}  // namespace moraine
