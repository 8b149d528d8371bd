// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "output/writers.hpp"
#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr WriterRow kWriters[] = {
    {"pvd", "ParaView/VTK time series: elements.pvd, ghosts.pvd, bonds.pvd with compressed .vtu pieces", make_pvd},
    {"vtkhdf", "one temporal VTKHDF 2 file, elements.vtkhdf, for ParaView 5.12 and newer", make_vtkhdf},
    {"lammps_dump", "LAMMPS text dump, dump.lammpstrj, for OVITO", make_lammps_dump},
    {"csv", "a table per frame, frames/elements_NNNNNN.csv", make_csv},
};

}  // namespace

std::span<const WriterRow> writers() { return kWriters; }

const WriterRow& find_writer(std::string_view name) {
  std::string names;
  for (const WriterRow& row : kWriters) {
    if (row.name == name) return row;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  }
  throw InputError(fmt::format("output format '{}' is unknown, expected one of: {}", name, names));
}

}  // namespace moraine
