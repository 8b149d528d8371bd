// SPDX-License-Identifier: Apache-2.0
// LAMMPS text dump, one file for all frames. OVITO reads radius and quaternion by these column names; type is the
// sub-model plus one.
#include <fmt/format.h>

#include <iterator>

#include "output/file.hpp"
#include "output/writers.hpp"

namespace moraine {
namespace {

Bounds bounds_of(const Scene& scene, const Frame::Bodies& bodies) {
  Bounds box;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    box.add(bodies.state[i].pose.position, scene.shapes[bodies.shape[i]].bounding_radius);
  }
  return box.empty() ? Bounds{Vec3::Zero(), Vec3::Zero()} : box;
}

std::string header(const Frame& frame, const Bounds& box) {
  std::string text = fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ss ss ss\n",
                                 frame.step, frame.elements.size());
  for (int axis = 0; axis < 3; ++axis) text += fmt::format("{} {}\n", box.min[axis], box.max[axis]);
  return text + "ITEM: ATOMS id type radius x y z vx vy vz quatw quati quatj quatk\n";
}

void append_atom(std::string& text, const Scene& scene, const Frame::Bodies& bodies, std::size_t i) {
  const auto& [p, q] = bodies.state[i].pose;
  const Vec3& v = bodies.state[i].twist.linear;
  fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {} {} {} {} {} {}\n", bodies.id[i],
                 bodies.sub_model[i] + 1, scene.shapes[bodies.shape[i]].bounding_radius, p.x(), p.y(), p.z(), v.x(),
                 v.y(), v.z(), q.w(), q.x(), q.y(), q.z());
}

class LammpsDumpWriter : public Writer {
 public:
  LammpsDumpWriter(const Scene& scene, const std::filesystem::path& folder)
      : scene_(scene), file_(folder / "dump.lammpstrj") {}
  void write(const Frame& frame) override {
    std::string text = header(frame, bounds_of(scene_, frame.elements));
    for (std::size_t i = 0; i < frame.elements.size(); ++i) append_atom(text, scene_, frame.elements, i);
    file_.write(text);
    file_.flush();
  }
  void finish() override { file_.close(); }

 private:
  const Scene& scene_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<Writer> make_lammps_dump(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<LammpsDumpWriter>(scene, folder);
}

}  // namespace moraine
