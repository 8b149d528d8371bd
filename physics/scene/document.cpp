// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <numeric>
#include <sstream>

#include "physics/errors.hpp"

namespace moraine {
namespace {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '.');) parts.push_back(part);
  return parts;
}

/// The path without its last key; empty at the top.
std::string above(const std::string& path) {
  const auto dot = path.find_last_of('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

/// Levenshtein distance.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replace}));
    }
  }
  return row.back();
}

std::vector<std::string_view> keys_of(const YAML::Node& map) {
  std::vector<std::string_view> keys;
  if (!map.IsDefined() || !map.IsMap()) return keys;
  for (const auto& entry : map) keys.push_back(entry.first.Scalar());
  return keys;
}

bool contains(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A child that exists, by key or index; undefined if there is none.
YAML::Node child(const YAML::Node& parent, const std::string& key) {
  if (!parent.IsSequence()) return parent[key];
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error != std::errc() || end != key.data() + key.size()) return YAML::Node(YAML::NodeType::Undefined);
  return index < parent.size() ? parent[index] : YAML::Node(YAML::NodeType::Undefined);
}

void put(YAML::Node& parent, const std::string& key, const YAML::Node& value) {
  if (parent.IsSequence()) {
    parent[std::stoul(key)] = value;
  } else {
    parent[key] = value;
  }
}

}  // namespace

std::string listing(std::span<const std::string_view> words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string suggestion(std::string_view given, std::span<const std::string_view> words) {
  std::string_view best;
  std::size_t least = std::min<std::size_t>(3, given.size() / 2 + 1);
  for (const std::string_view word : words) {
    const std::size_t distance = edits(given, word);
    if (distance < least) {
      least = distance;
      best = word;
    }
  }
  return best.empty() ? "" : fmt::format("; did you mean '{}'?", best);
}

Document::Document(const std::filesystem::path& file, const std::vector<Override>& overrides,
                   std::span<const std::string_view> top_keys)
    : file_(file.string()), top_keys_(top_keys.begin(), top_keys.end()) {
  load();
  for (const Override& change : overrides) apply(change);
  read_parameters();
}

void Document::load() {
  std::ifstream in(file_, std::ios::binary);
  if (!in || std::filesystem::is_directory(file_)) throw InputError(file_ + ": cannot read, expected a scene file");
  std::stringstream text;
  text << in.rdbuf();
  try {
    root_ = YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw InputError(fmt::format("{}:{}:{}: {}, expected YAML", file_, e.mark.line + 1, e.mark.column + 1, e.msg));
  }
  if (!root_.IsMap()) fail("", root_.Mark(), fmt::format("not a scene, expected the keys {}", listing(top_keys_)));
}

void Document::refuse(const Override& change, const std::string& why) const {
  throw InputError(fmt::format("{} {}={}: {}", change.origin, change.key, change.value, why));
}

/// The path an override means.
std::string Document::resolve(const Override& change) const {
  const std::vector<std::string> parts = split_path(change.key);
  const bool malformed = parts.empty() || change.key.back() == '.' || std::count(parts.begin(), parts.end(), "") > 0;
  if (malformed) refuse(change, "not a name, expected a parameter or a path such as run.engine");
  const YAML::Node section = static_cast<const YAML::Node&>(root_)["parameters"];
  const std::vector<std::string_view> parameters = keys_of(section);
  if (parts.size() == 1 && contains(parameters, change.key)) return "parameters." + change.key;
  if (contains(top_keys_, parts.front())) return change.key;
  std::vector<std::string_view> known = parameters;
  known.insert(known.end(), top_keys_.begin(), top_keys_.end());
  refuse(change, fmt::format("'{}' is neither a parameter ({}) nor a key of the scene ({}){}", parts.front(),
                             parameters.empty() ? "there are none" : listing(parameters), listing(top_keys_),
                             suggestion(parts.front(), known)));
}

YAML::Node Document::value_of(const Override& change) const {
  try {
    return YAML::Load(change.value);
  } catch (const YAML::Exception& e) {
    refuse(change, e.msg + ", expected a YAML value");
  }
}

/// Refuses to go below a value, or to an item that a list does not have.
void Document::check_step(const Override& change, const YAML::Node& parent, const std::string& key) const {
  if (parent.IsScalar())
    refuse(change, fmt::format("'{}' would be below a value, expected a map or a list there", key));
  if (parent.IsSequence() && !child(parent, key).IsDefined()) {
    refuse(change,
           fmt::format("a list of {} has no item '{}', expected a number below {}", parent.size(), key, parent.size()));
  }
}

void Document::apply(const Override& change) {
  const std::string path = resolve(change);
  const std::vector<std::string> keys = split_path(path);
  const YAML::Node value = value_of(change);
  YAML::Node parent;
  parent.reset(root_);
  std::string reached;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string& key = keys[i];
    check_step(change, parent, key);
    reached += (i > 0 ? "." : "") + key;
    const YAML::Node found = child(parent, key);
    const bool last = i + 1 == keys.size();
    const bool make = last || !found.IsDefined() || found.IsNull();
    if (make) {
      origins_[reached] = change.origin + " " + change.key;
      put(parent, key, last ? value : YAML::Node(YAML::NodeType::Map));
    }
    if (!last) parent.reset(child(parent, key));
  }
  drop_rival(path);
}

/// Steps and duration say the same thing: the one set last counts.
void Document::drop_rival(const std::string& path) {
  if (path == "time.steps") root_["time"].remove("duration");
  if (path == "time.duration") root_["time"].remove("steps");
}

void Document::read_parameters() {
  const YAML::Node parameters = static_cast<const YAML::Node&>(root_)["parameters"];
  if (!parameters.IsDefined() || parameters.IsNull()) return;
  if (!parameters.IsMap()) fail("parameters", parameters.Mark(), "not a map, expected name: number or expression");
  for (const auto& entry : parameters) {
    const std::string name = entry.first.Scalar();
    const std::string path = "parameters." + name;
    if (!entry.second.IsScalar()) fail(path, entry.second.Mark(), "not a value, expected a number or an expression");
    try {
      expressions_.define(name, expressions_.evaluate(entry.second.Scalar()));
    } catch (const ExpressionError& e) {
      fail(path, entry.second.Mark(),
           fmt::format(
               "parameter '{}': {}, expected a number or an expression of the parameters above it{}", name, e.what(),
               expressions_.names().empty() ? "" : fmt::format(" ({})", fmt::join(expressions_.names(), ", "))));
    }
  }
}

std::string Document::place(const std::string& path, const YAML::Mark& mark) const {
  for (std::string at = path; !at.empty(); at = above(at)) {
    if (const auto found = origins_.find(at); found != origins_.end()) return found->second;
  }
  return fmt::format("{}:{}:{}", file_, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1);
}

void Document::fail(const std::string& path, const YAML::Mark& mark, const std::string& what) const {
  throw InputError(place(path, mark) + ": " + what);
}

}  // namespace moraine
