// SPDX-License-Identifier: Apache-2.0
// LAMMPS text dump, one file for all frames; after a restart it goes on where the run does. OVITO reads radius and
// quaternion by these column names; type is the sub-model plus one.
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

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

/// The next line, if it is whole.
std::optional<std::string> whole_line(std::istream& in) {
  std::string line;
  if (!std::getline(in, line) || in.eof()) return std::nullopt;
  return line;
}

bool skip_lines(std::istream& in, std::uint64_t count) {
  for (; count > 0; --count)
    if (!in.ignore(std::numeric_limits<std::streamsize>::max(), '\n') || in.eof()) return false;
  return true;
}

/// The step of the frame that begins here, if it is whole; then the next one begins.
std::optional<std::int64_t> skip_frame(std::istream& in) {
  if (whole_line(in) != "ITEM: TIMESTEP") return std::nullopt;
  const auto step = whole_line(in), title = whole_line(in), atoms = whole_line(in);
  if (!atoms || !skip_lines(in, 5 + std::stoull(*atoms))) return std::nullopt;
  return std::stoll(*step);
}

/// Bytes of the whole frames before `step`. Cost: reads the file once.
std::uintmax_t length_before(const std::filesystem::path& path, std::int64_t step) {
  std::ifstream in(path, std::ios::binary);
  std::uintmax_t length = 0;
  for (auto next = skip_frame(in); next && *next < step; next = skip_frame(in))
    length = static_cast<std::uintmax_t>(in.tellg());
  return length;
}

class LammpsDumpWriter : public Writer {
 public:
  LammpsDumpWriter(const Scene& scene, const std::filesystem::path& folder)
      : scene_(scene), path_(folder / "dump.lammpstrj"), has_more_(goes_on(scene, path_)), file_(path_, has_more_) {}
  void write(const Frame& frame) override {
    if (std::exchange(has_more_, false)) std::filesystem::resize_file(path_, length_before(path_, frame.step));
    file_.write(header(frame, bounds_of(scene_, frame.elements)));
    std::string row;
    for (std::size_t i = 0; i < frame.elements.size(); ++i) {
      row.clear();
      append_atom(row, scene_, frame.elements, i);
      file_.write(row);
    }
    file_.flush();
  }
  void finish() override { file_.close(); }

 private:
  const Scene& scene_;
  std::filesystem::path path_;
  bool has_more_;  ///< frames from before a restart, not yet cut back to where it goes on
  OutputFile file_;
};

}  // namespace

std::unique_ptr<Writer> make_lammps_dump(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<LammpsDumpWriter>(scene, folder);
}

}  // namespace moraine
