// SPDX-License-Identifier: Apache-2.0
#include "output/hdf5_file.hpp"

#include <fmt/format.h>

#include "physics/errors.hpp"

namespace moraine {
namespace {

constexpr hsize_t kChunk = 8192;  // rows, of tables that grow by many

/// Errors are reported by return values; the library's own print-out is switched off before its first use.
hid_t open_file(const std::filesystem::path& path, bool go_on) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return go_on ? H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
               : H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
}

hid_t number_type(const Column& column) {
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64, H5T_NATIVE_UINT32, H5T_NATIVE_UINT8};
  return types[column.values.index()];
}

/// A column of several components is a table of as many columns; of one, a plain list.
int rank_of(const Column& column) { return column.components > 1 ? 2 : 1; }

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path path, bool go_on)
    : path_(std::move(path)), file_(open_file(path_, go_on), H5Fclose) {
  check(file_, go_on ? "cannot go on with the file; move it away to begin another" : "cannot create the file");
}

hid_t Hdf5File::check(hid_t result, const std::string& what) const {
  if (result < 0) throw IoError(fmt::format("{}: HDF5: {}", path_.string(), what));
  return result;
}

void Hdf5File::group(const std::string& name) {
  const Hdf5Handle made(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  check(made, "cannot create group " + name);
}

Hdf5Handle Hdf5File::open(const std::string& object) {
  return {check(H5Oopen(file_, object.c_str(), H5P_DEFAULT), "cannot open " + object), H5Oclose};
}

void Hdf5File::attribute(const std::string& object, const char* name, const std::vector<std::int64_t>& values) {
  const Hdf5Handle owner = open(object);
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle made(H5Acreate2(owner, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(made, fmt::format("cannot create attribute {}", name));
  check(H5Awrite(made, H5T_NATIVE_INT64, values.data()), fmt::format("cannot write attribute {}", name));
}

void Hdf5File::attribute(const std::string& object, const char* name, std::int64_t value) {
  const Hdf5Handle owner = open(object);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const bool exists = check(H5Aexists(owner, name), "cannot look for an attribute") > 0;
  const Hdf5Handle made(exists ? H5Aopen(owner, name, H5P_DEFAULT)
                               : H5Acreate2(owner, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
  check(made, fmt::format("cannot create attribute {}", name));
  check(H5Awrite(made, H5T_NATIVE_INT64, &value), fmt::format("cannot write attribute {}", name));
}

void Hdf5File::attribute(const std::string& object, const char* name, const std::string& text) {
  const Hdf5Handle owner = open(object);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  check(H5Tset_size(type, text.size()), "cannot size a text");
  const Hdf5Handle made(H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(made, fmt::format("cannot create attribute {}", name));
  check(H5Awrite(made, type, text.data()), fmt::format("cannot write attribute {}", name));
}

Hdf5Handle Hdf5File::create_table(const std::string& name, const Column& rows) {
  const hsize_t none[] = {0, rows.components}, unlimited[] = {H5S_UNLIMITED, rows.components};
  const hsize_t chunk[] = {rows.tuples() > 1 ? kChunk : 256, rows.components};
  const Hdf5Handle space(H5Screate_simple(rank_of(rows), none, unlimited), H5Sclose);
  const Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_chunk(layout, rank_of(rows), chunk), "cannot set chunks");
  check(H5Pset_shuffle(layout), "cannot set shuffling");
  check(H5Pset_deflate(layout, 1), "cannot set compression");
  return {check(H5Dcreate2(file_, name.c_str(), number_type(rows), space, H5P_DEFAULT, layout, H5P_DEFAULT),
                "cannot create table " + name),
          H5Dclose};
}

bool Hdf5File::has(const std::string& name) const {
  return check(H5Lexists(file_, name.c_str(), H5P_DEFAULT), "cannot look for " + name) > 0;
}

Hdf5Handle Hdf5File::open_table(const std::string& name) {
  return {check(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), "cannot open table " + name), H5Dclose};
}

void Hdf5File::append(const std::string& name, const Column& rows) {
  const Hdf5Handle table = has(name) ? open_table(name) : create_table(name, rows);
  if (rows.tuples() == 0) return;
  hsize_t size[2] = {}, begin[2] = {}, count[] = {rows.tuples(), rows.components};
  check(H5Sget_simple_extent_dims(Hdf5Handle(H5Dget_space(table), H5Sclose), size, nullptr), "cannot measure " + name);
  begin[0] = size[0];
  size[0] += count[0];
  check(H5Dset_extent(table, size), "cannot grow table " + name);
  const Hdf5Handle target(H5Dget_space(table), H5Sclose),
      source(H5Screate_simple(rank_of(rows), count, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(target, H5S_SELECT_SET, begin, nullptr, count, nullptr), "cannot select in " + name);
  check(H5Dwrite(table, number_type(rows), source, target, H5P_DEFAULT, rows.bytes().data()), "cannot write " + name);
}

void Hdf5File::append(const std::string& name, std::int64_t row) {
  append(name, Column{name, 1, std::vector<std::int64_t>{row}});
}

std::int64_t Hdf5File::number(const std::string& object, const char* name) {
  const Hdf5Handle attribute(H5Aopen_by_name(file_, object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::int64_t value = 0;
  check(attribute, fmt::format("cannot open attribute {}", name));
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), fmt::format("cannot read attribute {}", name));
  return value;
}

std::vector<double> Hdf5File::numbers(const std::string& name) {
  if (!has(name)) return {};
  const Hdf5Handle table = open_table(name), space(H5Dget_space(table), H5Sclose);
  std::vector<double> values(
      static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space), "cannot measure " + name)));
  check(H5Dread(table, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "cannot read " + name);
  return values;
}

void Hdf5File::keep(const std::string& name, std::int64_t rows) {
  if (rows == 0 && !has(name)) return;
  const Hdf5Handle table = open_table(name);
  hsize_t size[2] = {};
  check(H5Sget_simple_extent_dims(Hdf5Handle(H5Dget_space(table), H5Sclose), size, nullptr), "cannot measure " + name);
  if (size[0] < static_cast<hsize_t>(rows)) check(-1, fmt::format("table {} has lost rows", name));
  size[0] = static_cast<hsize_t>(rows);
  check(H5Dset_extent(table, size), "cannot shorten table " + name);
}

void Hdf5File::flush() { check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "cannot write"); }

void Hdf5File::close() { check(file_.close(), "cannot close the file"); }

}  // namespace moraine
