// SPDX-License-Identifier: Apache-2.0
// Elements from CSV tables and LAMMPS data files.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "physics/types.hpp"

namespace moraine {

/// One element of a file; what the file does not say stays empty.
struct TableRow {
  int line = 0;  ///< in the file, from 1
  std::optional<ElementId> id;
  Vec3 position = Vec3::Zero();
  std::optional<double> radius;   ///< [m]
  std::optional<double> density;  ///< [kg/m^3]
  std::optional<Twist> twist;
};

/// A header line names the columns: x, y, z and any of id, radius, vx, vy, vz, wx, wy, wz. Lines that are empty or
/// begin with # are skipped. Errors: InputError `file:line: what is wrong, what was expected`.
std::vector<TableRow> read_csv(const std::filesystem::path& file);

/// A LAMMPS data file with atom_style sphere, in SI units: its Atoms and Velocities. Errors: as read_csv.
std::vector<TableRow> read_lammps(const std::filesystem::path& file);

}  // namespace moraine
