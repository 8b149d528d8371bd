// SPDX-License-Identifier: Apache-2.0
// Reads back the frames of a run from its folder, as far as pictures need them.
#pragma once

#include <filesystem>
#include <vector>

#include "output/frame.hpp"

namespace moraine {

/// The recorded frames of a folder written by the pvd format, without its scene file.
class RecordedRun {
 public:
  /// Reads the shape table and the indices, and keeps the frames that all groups have. Errors: IoError naming the path,
  /// also if there are no frames.
  explicit RecordedRun(std::filesystem::path folder);

  /// Name, gravity, time label, shapes and boundaries; no elements, materials or bonds.
  const Scene& scene() const { return scene_; }
  std::size_t size() const { return times_.size(); }
  /// Times of the frames, ascending [s].
  const std::vector<double>& times() const { return times_; }
  /// Elements, ghosts, boundary poses and indices of the bonds that hold. Errors: IoError naming the path.
  /// Cost: reads the frame's files.
  Frame frame(std::size_t number) const;

 private:
  std::filesystem::path folder_;
  Scene scene_;
  std::vector<double> times_;
  std::vector<std::string> elements_, ghosts_, bonds_;  ///< files, one per time; bonds may be none
};

}  // namespace moraine
