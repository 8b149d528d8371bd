// SPDX-License-Identifier: Apache-2.0
// The factories behind the table of formats, one per source file.
#pragma once

#include "output/writer.hpp"

namespace moraine {

std::unique_ptr<Writer> make_pvd(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_vtkhdf(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_lammps_dump(const Scene& scene, const std::filesystem::path& folder);
std::unique_ptr<Writer> make_csv(const Scene& scene, const std::filesystem::path& folder);

}  // namespace moraine
