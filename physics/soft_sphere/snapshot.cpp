// SPDX-License-Identifier: Apache-2.0
// A soft-sphere world to bytes and back. Lists are not saved: they never influence what is computed.
#include "physics/bytes.hpp"
#include "physics/soft_sphere/world.hpp"

namespace moraine::soft_sphere {
namespace {

constexpr std::uint32_t magic = 0x5353424dU;  // "MBSS"
constexpr std::uint32_t version = 1;

struct BodyImage {
  std::uint32_t id, slot, shape, material, ghost, reserved;
  double mass, position[3], orientation[4], velocity[3], spin[3];
};
struct ContactImage {
  std::uint32_t a, b, with_boundary, reserved;
  double normal[3], point[3], overlap, sliding[3], rolling[3];
};

void put(const Vec3& v, double* to) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}
Vec3 vec(const double* v) { return {v[0], v[1], v[2]}; }

BodyImage image(const Bodies& bodies, Place p) {
  BodyImage i{};
  const Bodies::Entry& e = bodies.entries[p];
  i.id = e.id;
  i.slot = e.slot;
  i.shape = e.shape;
  i.material = bodies.moving[p].material;
  i.ghost = bodies.ghost[p];
  i.mass = e.mass;
  put(bodies.position[p], i.position);
  for (int k = 0; k < 4; ++k) i.orientation[k] = bodies.orientation[p].coeffs()[k];
  put(bodies.moving[p].velocity, i.velocity);
  put(bodies.moving[p].spin, i.spin);
  return i;
}

Body body(const BodyImage& i) {
  const double* q = i.orientation;
  return {i.id,
          i.shape,
          i.material,
          i.mass,
          i.ghost ? Role::ghost : Role::real,
          {{vec(i.position), Quat(q[3], q[0], q[1], q[2])}, {vec(i.velocity), vec(i.spin)}}};
}

ContactImage image(std::uint32_t a, std::uint32_t b, bool with_boundary, const Springs& springs) {
  ContactImage i{};
  i.a = a;
  i.b = b;
  i.with_boundary = with_boundary;
  put(springs.sliding, i.sliding);
  put(springs.rolling, i.rolling);
  return i;
}
Springs springs(const ContactImage& i) { return {vec(i.sliding), vec(i.rolling)}; }

ContactImage image(const LastingWallContact& c) {
  ContactImage i = image(c.ball, c.wall, true, c.springs);
  put(c.normal, i.normal);
  put(c.point, i.point);
  i.overlap = c.overlap;
  return i;
}
ContactImage image(const ContactMemory& m) {
  ContactImage i = image(m.a, m.b, m.with_boundary, {m.sliding, m.rolling});
  put(m.normal, i.normal);
  return i;
}

ContactImage image(const LastingPair& c) { return image(c.low, c.high, false, c.springs); }

template <class Values>
void put_images(ByteWriter& w, const Values& values) {
  std::vector<ContactImage> images;
  for (const auto& v : values) images.push_back(image(v));
  w.put_all(std::span<const ContactImage>(images));
}
std::vector<ContactImage> get_images(ByteReader& r) {
  std::vector<ContactImage> images;
  r.get_all(images);
  return images;
}

}  // namespace

void SoftSphereWorld::save(std::vector<std::byte>& out) const {
  ByteWriter w(out);
  w.put(magic);
  w.put(version);
  std::vector<BodyImage> bodies;
  for (Place p = 0; p < bodies_.size(); ++p) bodies.push_back(image(bodies_, p));
  w.put_all(std::span<const BodyImage>(bodies));
  w.put(static_cast<std::uint64_t>(bodies_.slots()));
  w.put_all(std::span<const Slot>(bodies_.free_slots()));
  std::vector<LastingPair> pairs = lasting_;
  if (listed_) pairs_.lasting(pairs);
  put_images(w, pairs);
  put_images(w, walls_.lasting());
  put_images(w, memory_);
  w.put_all(std::span<const BondSprings::Entry>(bonds_.entries()));
}

void SoftSphereWorld::load(std::span<const std::byte> in) {
  ByteReader r(in);
  if (r.get<std::uint32_t>() != magic || r.get<std::uint32_t>() != version)
    throw IoError("not a saved soft_sphere world of this version");
  std::vector<BodyImage> bodies;
  r.get_all(bodies);
  bodies_.clear();
  for (const BodyImage& i : bodies) bodies_.add(body(i), settings_.scene->shapes[i.shape]);
  for (Place p = 0; p < bodies.size(); ++p) bodies_.entries[p].slot = bodies[p].slot;
  const auto slots = r.get<std::uint64_t>();
  std::vector<Slot> free;
  r.get_all(free);
  bodies_.restore_slots(slots, std::move(free));

  lasting_.clear();
  for (const ContactImage& i : get_images(r)) lasting_.push_back({i.a, i.b, springs(i)});
  walls_.lasting().clear();
  for (const ContactImage& i : get_images(r))
    walls_.lasting().push_back({i.a, i.b, vec(i.normal), vec(i.point), i.overlap, springs(i)});
  memory_.clear();
  for (const ContactImage& i : get_images(r))
    memory_.push_back({i.a, i.b, i.with_boundary != 0, vec(i.normal), vec(i.sliding), vec(i.rolling)});
  std::vector<BondSprings::Entry> bonds;
  r.get_all(bonds);
  bonds_.clear();
  for (const BondSprings::Entry& e : bonds) bonds_.add(e.bond, e.a, e.b);
  listed_ = false;
}

}  // namespace moraine::soft_sphere
