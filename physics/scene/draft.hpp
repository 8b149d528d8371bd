// SPDX-License-Identifier: Apache-2.0
// A scene while it is being read, and the readers of its sections.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "physics/scene/node.hpp"
#include "physics/scene/scene.hpp"

namespace moraine {

/// A shape of the scene's table and the pose of its own frame in the frame it was written in.
struct PlacedShape {
  std::uint32_t index = 0;
  Pose frame;
};

/// Where an element was written, kept small because there may be millions.
struct Source {
  std::uint32_t text = 0;  ///< index into Draft::sources
  int line = 0;            ///< 0: the text says it all
};

class Draft {
 public:
  explicit Draft(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Scene scene;

  /// Adds a geometry to the shape table; equal spheres share a row. Errors: InputError without a place.
  PlacedShape add_shape(Geometry geometry);
  /// Adds an element; without an id it gets the next one.
  void add_element(Element element, std::optional<ElementId> id, const Source& source);
  /// The text of a place that many elements share.
  std::uint32_t add_source(const std::string& text);
  /// The id that the next element without one gets.
  void set_next_id(ElementId id) { next_id_ = id; }
  ElementId next_id() const { return static_cast<ElementId>(next_id_); }
  /// Sorts the elements by id. Errors: InputError naming an id given twice and both places.
  void finish_elements();

  /// A path of the scene file: relative to its folder.
  std::filesystem::path resolve(const std::string& path) const { return folder_ / path; }

 private:
  std::string place(const Source& source) const;

  std::filesystem::path folder_;
  std::map<double, std::uint32_t> spheres_;  ///< by radius
  std::vector<Source> element_sources_;
  std::vector<std::string> sources_;
  std::uint64_t next_id_ = 0;
};

void read_materials(const Node& root, Draft& draft);
void read_elements(const Node& root, Draft& draft);
void read_boundaries(const Node& root, Draft& draft);
void read_bonds(const Node& root, Draft& draft);
void read_time(const Node& root, TimeSettings& time);
void read_run(const Node& root, RunSettings& run);
void read_output(const Node& root, OutputSettings& output);
/// `parameters`: names that the scene declares.
void read_study(const Node& root, std::span<const std::string> parameters, StudySettings& study);
void read_perturbation(const Node& root, Scene& scene);

/// The material an entry names; the scene's only one if it names none.
std::uint32_t read_material(const Node& entry, const Scene& scene);
/// `at` and `rotation` of an entry.
Pose read_pose(const Node& entry);
/// `velocity` and `angular_velocity` of an entry.
Twist read_twist(const Node& entry);
/// One shape: a map with one of the keys sphere, box, capsule, hull, compound.
PlacedShape read_shape(const Node& shape, Draft& draft);
/// A geometry made by the caller; errors get the place of `node`.
PlacedShape add_shape(const Node& node, Geometry geometry, Draft& draft);
/// `vertices` or a file; errors get the place of `node`.
TriangleMesh read_mesh(const Node& node, const Draft& draft);

/// The pose of a body whose shape was written in the frame `written`.
inline Pose body_pose(const Pose& written, const Pose& frame) {
  return {written.position + written.orientation * frame.position,
          (written.orientation * frame.orientation).normalized()};
}

}  // namespace moraine
