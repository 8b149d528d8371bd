// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <map>

#include "physics/errors.hpp"

namespace moraine {
namespace {

/// Collects triangles and merges equal corners.
class MeshBuilder {
 public:
  void add(const aiMesh& part) {
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines bound nothing
      std::array<std::uint32_t, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) triangle[k] = corner(part.mVertices[face.mIndices[k]]);
      mesh_.triangles.push_back(triangle);
    }
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t corner(const aiVector3D& v) {
    const auto [at, added] = numbers_.try_emplace({v.x, v.y, v.z}, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.emplace_back(v.x, v.y, v.z);
    return at->second;
  }

  TriangleMesh mesh_;
  std::map<std::array<float, 3>, std::uint32_t> numbers_;
};

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* content = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (!content)
    throw InputError(file.string() + ": cannot read (" + importer.GetErrorString() + "), expected STL or OBJ");
  MeshBuilder builder;
  for (unsigned m = 0; m < content->mNumMeshes; ++m) builder.add(*content->mMeshes[m]);
  TriangleMesh mesh = builder.take();
  if (mesh.triangles.empty()) throw InputError(file.string() + ": holds no triangles, expected at least one");
  for (const Vec3& v : mesh.vertices) {
    if (!v.allFinite()) throw InputError(file.string() + ": a corner is not finite, expected finite coordinates");
  }
  return mesh;
}

}  // namespace moraine
