// SPDX-License-Identifier: Apache-2.0
// The `elements` section: packings, lists and files.
#include <fmt/format.h>

#include <algorithm>

#include "physics/errors.hpp"
#include "physics/scene/draft.hpp"
#include "physics/scene/packing.hpp"
#include "physics/scene/random.hpp"
#include "physics/scene/table_file.hpp"

namespace moraine {
namespace {

constexpr std::int64_t most_elements = 1'000'000'000;
constexpr ElementId last_id = UINT32_MAX - 1;

/// What all elements of an entry have in common.
struct Entry {
  const Node& node;
  Draft& draft;
  std::uint32_t material = 0;
  std::optional<double> mass;
  Twist twist;
  std::uint32_t source = 0;

  double mass_of(std::uint32_t shape) const {
    return mass ? *mass : draft.scene.materials.materials[material].density * draft.scene.shapes[shape].volume;
  }
  /// Adds an element at rest relative to the entry's velocity.
  void add(std::uint32_t shape, const Pose& pose) const {
    draft.add_element({0, shape, material, mass_of(shape), {pose, twist}}, std::nullopt, {source, 0});
  }
};

std::optional<double> read_mass(const Node& node) {
  const auto mass = node.find("mass");
  return mass ? std::optional(mass->positive()) : std::nullopt;
}

std::uint64_t read_seed(const Node& node) { return static_cast<std::uint64_t>(node.integer("seed", 1, 0)); }

// --- hcp, cubic

Vec3 swapped_xy(const Vec3& v) { return {v.y(), v.x(), v.z()}; }

/// Points of the lattice with its rows along x.
std::vector<Vec3> lattice_points(const Node& node, const Lattice& lattice, bool swap) {
  const auto turned = [swap](const Vec3& v) { return swap ? swapped_xy(v) : v; };
  const auto count = static_cast<std::size_t>(node.integer("count", most_elements, 0, most_elements));
  if (node.one_of({"box", "cells"}) == "box") {
    if (const auto at = node.find("at")) at->fail("'at' goes with 'cells', expected the place in 'box'");
    const Bounds box = node.at("box").box();
    return pack_lattice(lattice, Bounds{turned(box.min), turned(box.max)}, count);
  }
  std::array<std::int64_t, 3> cells{};
  const std::vector<Node> numbers = node.at("cells").items("three numbers of spheres [x, y, z]", 3);
  for (std::size_t a = 0; a < 3; ++a) cells[a] = numbers[a].integer(1, most_elements);
  if (swap) std::swap(cells[0], cells[1]);
  return pack_lattice(lattice, cells, turned(node.vector("at", Vec3::Zero())), count);
}

bool read_rows_along_y(const Node& node) {
  const auto rows = node.find("rows");
  if (!rows) return false;
  const std::string axis = rows->text();
  if (axis != "x" && axis != "y") rows->fail(fmt::format("unknown axis '{}', expected x or y", axis));
  return axis == "y";
}

void read_lattice(const Entry& entry, Lattice::Kind kind) {
  const Node& node = entry.node;
  node.allow({"packing", "shape", "material", "mass", "id_start", "velocity", "angular_velocity", "box", "cells", "at",
              "count", "spacing", "jitter", "seed", "rows"});
  const Node shape_node = node.at("shape", "the shape of the spheres");
  const std::uint32_t shape = read_shape(shape_node, entry.draft).index;
  const Sphere* sphere = entry.draft.scene.shapes[shape].sphere();
  if (!sphere) shape_node.fail("a lattice packs spheres only, expected {sphere: radius}");
  const Lattice lattice{kind, 2 * sphere->radius, node.positive("spacing", 1)};

  const bool swap = read_rows_along_y(node);
  std::vector<Vec3> points = lattice_points(node, lattice, swap);
  if (swap) std::transform(points.begin(), points.end(), points.begin(), swapped_xy);
  const std::int64_t count = node.integer("count", static_cast<std::int64_t>(points.size()), 0);
  if (points.size() < static_cast<std::size_t>(count)) {
    node.at("count").fail(fmt::format("only {} spheres fit, expected room for {}", points.size(), count));
  }
  if (points.empty() && count != 0) node.fail("no sphere fits into the box, expected a larger box or smaller spheres");
  const double shake = node.not_negative("jitter", 0);
  if (shake > 0) jitter(points, shake * lattice.diameter, read_seed(node));
  for (const Vec3& p : points) entry.add(shape, {p, Quat::Identity()});
}

// --- random

/// One of the shapes a random packing mixes; spheres may have radii of their own.
struct Choice {
  double weight = 1;
  PlacedShape shape;
  std::optional<std::pair<double, double>> radii;  ///< [m]
};

Choice read_choice(const Node& node, Draft& draft) {
  const auto sphere = node.find("sphere");
  if (!sphere || !sphere->is_map()) return {1, read_shape(node, draft), std::nullopt};
  node.allow({"sphere"});
  sphere->allow({"uniform"});
  const Node uniform = sphere->at("uniform", "[least, greatest] radius");
  const std::vector<Node> ends = uniform.items("[least, greatest] radius", 2);
  const std::pair radii(ends[0].positive(), ends[1].positive());
  if (radii.first > radii.second)
    uniform.fail("the least radius is greater than the greatest, expected [least, greatest]");
  return {1, {}, radii};
}

std::vector<Choice> read_choices(const Node& node, Draft& draft) {
  const Node shape = node.at("shape", "a shape or a list of shapes");
  std::vector<Choice> choices;
  if (shape.is_list()) {
    for (const Node& item : shape.items("a list of shapes")) choices.push_back(read_choice(item, draft));
    if (choices.empty()) shape.fail("no shapes, expected at least one");
  } else {
    choices.push_back(read_choice(shape, draft));
  }
  if (const auto weights = node.find("weights")) {
    const auto items = weights->items(fmt::format("{} weights, one for each shape", choices.size()), choices.size());
    for (std::size_t i = 0; i < items.size(); ++i) choices[i].weight = items[i].positive();
  }
  return choices;
}

const Choice& pick(const std::vector<Choice>& choices, Random& random) {
  double total = 0;
  for (const Choice& c : choices) total += c.weight;
  double at = random.uniform(0, total);
  for (const Choice& c : choices) {
    at -= c.weight;
    if (at < 0) return c;
  }
  return choices.back();
}

void read_random(const Entry& entry) {
  const Node& node = entry.node;
  node.allow({"packing", "shape", "weights", "material", "mass", "id_start", "velocity", "angular_velocity", "box",
              "count", "seed"});
  const Bounds box = node.at("box", "the box to fill").box();
  const auto count = static_cast<std::size_t>(node.at("count", "how many elements").integer(0, most_elements));
  const std::vector<Choice> choices = read_choices(node, entry.draft);
  const std::uint64_t seed = read_seed(node);

  Random random(mixed(seed));
  std::vector<std::uint32_t> shapes;
  std::vector<double> radii;
  for (std::size_t i = 0; i < count; ++i) {
    const Choice& choice = pick(choices, random);
    shapes.push_back(
        choice.radii ? entry.draft.add_shape(Sphere{random.uniform(choice.radii->first, choice.radii->second)}).index
                     : choice.shape.index);
    radii.push_back(entry.draft.scene.shapes[shapes.back()].bounding_radius);
  }
  const auto centres = pack_random(box, radii, seed);
  if (!centres) {
    node.at("count").fail(fmt::format("{} elements do not fit without overlap, expected fewer or a larger box", count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool round = entry.draft.scene.shapes[shapes[i]].sphere() != nullptr;
    entry.add(shapes[i], {(*centres)[i], round ? Quat::Identity() : random.orientation()});
  }
}

// --- list

void read_item(const Entry& entry, const Node& item, const std::optional<PlacedShape>& common, std::uint32_t source) {
  item.allow({"id", "at", "rotation", "velocity", "angular_velocity", "shape", "material", "mass"});
  const auto own = item.find("shape");
  if (!own && !common) item.fail("the item has no 'shape', expected one here or for the whole list");
  const PlacedShape shape = own ? read_shape(*own, entry.draft) : *common;
  item.at("at", "a position [x, y, z]");

  Entry mine = entry;
  if (item.find("material")) mine.material = read_material(item, entry.draft.scene);
  if (item.find("mass")) mine.mass = read_mass(item);
  mine.twist.linear = item.vector("velocity", entry.twist.linear);
  mine.twist.angular = item.vector("angular_velocity", entry.twist.angular);
  const auto id_node = item.find("id");
  const auto id = id_node ? std::optional(static_cast<ElementId>(id_node->integer(0, last_id))) : std::nullopt;
  const Pose pose = body_pose(read_pose(item), shape.frame);
  entry.draft.add_element({0, shape.index, mine.material, mine.mass_of(shape.index), {pose, mine.twist}}, id,
                          {source, item.line()});
}

void read_list(const Entry& entry) {
  const Node& node = entry.node;
  node.allow({"packing", "shape", "material", "mass", "id_start", "velocity", "angular_velocity", "items"});
  std::optional<PlacedShape> common;
  if (const auto shape = node.find("shape")) common.emplace(read_shape(*shape, entry.draft));
  const std::uint32_t source = entry.draft.add_source(node.file());
  for (const Node& item : node.at("items", "a list of elements").items("a list of elements")) {
    read_item(entry, item, common, source);
  }
}

// --- file

std::vector<TableRow> read_table(const Node& node, const std::filesystem::path& path) {
  const Node file = node.at("file");
  const std::string extension = path.extension().string();
  const std::string format = node.text("format", extension == ".csv" ? "csv" : "lammps");
  try {
    if (format == "csv") return read_csv(path);
    if (format == "lammps") return read_lammps(path);
  } catch (const InputError& e) {
    if (!std::filesystem::exists(path)) file.fail(e.what());
    throw;
  }
  node.at("format").fail(fmt::format("unknown format '{}', expected csv or lammps", format));
}

void read_file(const Entry& entry) {
  const Node& node = entry.node;
  node.allow({"packing", "shape", "material", "mass", "id_start", "velocity", "angular_velocity", "file", "format"});
  const std::filesystem::path path = entry.draft.resolve(node.at("file", "the name of a table").text());
  const std::vector<TableRow> rows = read_table(node, path);
  std::optional<PlacedShape> common;
  if (const auto shape = node.find("shape")) common.emplace(read_shape(*shape, entry.draft));
  const std::uint32_t source = entry.draft.add_source(path.string());
  for (const TableRow& row : rows) {
    if (row.radius && common) node.at("shape").fail("the file has radii of its own, expected no shape here");
    if (!row.radius && !common) node.fail("the file has no radii, expected a shape here");
    const PlacedShape shape = row.radius ? entry.draft.add_shape(Sphere{*row.radius}) : *common;
    const double volume = entry.draft.scene.shapes[shape.index].volume;
    const double mass = row.density && !entry.mass ? *row.density * volume : entry.mass_of(shape.index);
    const Pose pose = body_pose({row.position, Quat::Identity()}, shape.frame);
    entry.draft.add_element({0, shape.index, entry.material, mass, {pose, row.twist.value_or(entry.twist)}}, row.id,
                            {source, row.line});
  }
}

void read_entry(const Node& node, Draft& draft) {
  const Node packing = node.at("packing", "one of hcp, cubic, random, list, file");
  Entry entry{
      node, draft, read_material(node, draft.scene), read_mass(node), read_twist(node), draft.add_source(node.place())};
  draft.set_next_id(static_cast<ElementId>(node.integer("id_start", draft.next_id(), 0, last_id)));
  const std::string kind = packing.text();
  if (kind == "hcp") return read_lattice(entry, Lattice::Kind::hcp);
  if (kind == "cubic") return read_lattice(entry, Lattice::Kind::cubic);
  if (kind == "random") return read_random(entry);
  if (kind == "list") return read_list(entry);
  if (kind == "file") return read_file(entry);
  packing.fail(fmt::format("unknown packing '{}', expected one of hcp, cubic, random, list, file", kind));
}

}  // namespace

void read_elements(const Node& root, Draft& draft) {
  if (const auto list = root.find("elements")) {
    for (const Node& entry : list->items("a list of packings")) read_entry(entry, draft);
  }
  draft.finish_elements();
  if (draft.scene.elements.empty()) draft.scene.warnings.emplace_back("the scene has no elements");
}

}  // namespace moraine
