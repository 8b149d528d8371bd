// SPDX-License-Identifier: Apache-2.0
// The factories behind the table of formats, one per source file.
#pragma once

#include "output/writer.hpp"

namespace moraine {

/// True if a run goes on after a restart and `file` is there from before.
inline bool goes_on(const Scene& scene, const std::filesystem::path& file) {
  return !scene.run.restart.empty() && std::filesystem::exists(file);
}

std::unique_ptr<Writer> make_pvd(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_vtkhdf(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_lammps_dump(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_csv(const Scene& scene, const std::filesystem::path& folder);

}  // namespace moraine
