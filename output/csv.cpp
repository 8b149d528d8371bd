// SPDX-License-Identifier: Apache-2.0
// A table of the elements per frame, with numbers that read back to the same doubles.
#include <fmt/format.h>

#include <iterator>

#include "output/file.hpp"
#include "output/frame_name.hpp"
#include "output/writers.hpp"

namespace moraine {
namespace {

constexpr const char* kHeader = "id,sub_model,shape,radius,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";

void append_row(std::string& text, const Scene& scene, const Frame::Bodies& bodies, std::size_t i) {
  const auto& [pose, twist] = bodies.state[i];
  const auto& [p, q] = pose;
  const auto& [v, w] = twist;
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", bodies.id[i],
                 bodies.sub_model[i], bodies.shape[i], scene.shapes[bodies.shape[i]].bounding_radius, p.x(), p.y(),
                 p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
}

class CsvWriter : public Writer {
 public:
  CsvWriter(const Scene& scene, const std::filesystem::path& folder) : scene_(scene), folder_(folder / kFrames) {
    make_folder(folder_);
  }
  void write(const Frame& frame) override {
    OutputFile file(folder_ / frame_name("elements", frame.step, "csv"));
    file.write(kHeader);
    std::string row;
    for (std::size_t i = 0; i < frame.elements.size(); ++i) {
      row.clear();
      append_row(row, scene_, frame.elements, i);
      file.write(row);
    }
    file.close();
  }

 private:
  const Scene& scene_;
  std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<Writer> make_csv(const Scene& scene, const std::filesystem::path& folder) {
  return std::make_unique<CsvWriter>(scene, folder);
}

}  // namespace moraine
