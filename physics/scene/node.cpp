// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace moraine {

Node::Node(const Document& document, const YAML::Node& node, std::string path, YAML::Mark mark)
    : document_(&document), node_(node), path_(std::move(path)), parent_mark_(mark) {}

Node Node::root(const Document& document) { return {document, document.root(), "", document.root().Mark()}; }

/// Values that an override made have no mark of their own.
YAML::Mark Node::mark() const {
  const YAML::Mark own = node_.Mark();
  return own.is_null() ? parent_mark_ : own;
}

std::string Node::label() const { return path_.empty() ? "the scene" : "'" + path_ + "'"; }

std::string Node::kind() const {
  if (is_map()) return "a map";
  if (is_list()) return "a list";
  return is_scalar() ? "'" + node_.Scalar() + "'" : "empty";
}

void Node::check_duplicates() const {
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (!seen.insert(key).second)
      document_->fail(path_, entry.first.Mark(), "the key '" + key + "' is given twice, expected once");
  }
}

void Node::allow(std::span<const std::string_view> allowed) const {
  if (!is_map()) fail(fmt::format("{} is {}, expected a map with the keys {}", label(), kind(), listing(allowed)));
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (std::find(allowed.begin(), allowed.end(), key) != allowed.end()) continue;
    document_->fail(
        path_.empty() ? key : path_ + "." + key, entry.first.Mark(),
        fmt::format("unknown key '{}', expected one of {}{}", key, listing(allowed), suggestion(key, allowed)));
  }
  check_duplicates();
}

std::optional<Node> Node::find(const std::string& key) const {
  if (!is_map()) return std::nullopt;
  const YAML::Node child = node_[key];
  if (!child.IsDefined()) return std::nullopt;
  return Node(*document_, child, path_.empty() ? key : path_ + "." + key, mark());
}

Node Node::at(const std::string& key, const std::string& expected) const {
  if (std::optional<Node> found = find(key)) return *found;
  if (!is_map()) fail(fmt::format("{} is {}, expected a map with the key '{}'", label(), kind(), key));
  fail(fmt::format("{} has no '{}', expected {}", label(), key, expected));
}

std::string Node::one_of(std::initializer_list<std::string_view> keys) const {
  std::string chosen;
  for (const std::string_view key : keys) {
    if (!find(std::string(key))) continue;
    if (!chosen.empty()) fail(fmt::format("{} has both '{}' and '{}', expected one of them", label(), chosen, key));
    chosen = key;
  }
  if (chosen.empty())
    fail(fmt::format("{} is incomplete, expected one of {}", label(), listing({keys.begin(), keys.size()})));
  return chosen;
}

std::vector<std::pair<std::string, Node>> Node::entries() const {
  if (!is_map()) fail(fmt::format("{} is {}, expected a map", label(), kind()));
  check_duplicates();
  std::vector<std::pair<std::string, Node>> all;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    all.emplace_back(key, Node(*document_, entry.second, path_.empty() ? key : path_ + "." + key, entry.first.Mark()));
  }
  return all;
}

std::vector<Node> Node::items(const std::string& expected, std::size_t count) const {
  if (!is_list()) fail(fmt::format("{} is {}, expected {}", label(), kind(), expected));
  if (count > 0 && node_.size() != count) {
    fail(fmt::format("{} has {} items, expected {}", label(), node_.size(), expected));
  }
  std::vector<Node> all;
  for (const auto& item : node_) {
    all.emplace_back(*document_, item, fmt::format("{}.{}", path_, all.size()), mark());
  }
  return all;
}

double Node::number() const {
  if (!is_scalar()) fail(fmt::format("{} is {}, expected a number or an expression", label(), kind()));
  try {
    return document_->expressions().evaluate(node_.Scalar());
  } catch (const ExpressionError& e) {
    std::vector<std::string_view> names(document_->expressions().names().begin(),
                                        document_->expressions().names().end());
    fail(fmt::format("{}: {}, expected a number or an expression{}", label(), e.what(),
                     names.empty() ? "" : " of the parameters " + listing(names)));
  }
}

double Node::positive() const {
  const double value = number();
  if (!(value > 0)) fail(fmt::format("{} is {}, expected more than 0", label(), value));
  return value;
}

double Node::not_negative() const {
  const double value = number();
  if (!(value >= 0)) fail(fmt::format("{} is {}, expected 0 or more", label(), value));
  return value;
}

double Node::within(double low, double high) const {
  const double value = number();
  if (!(value >= low && value <= high)) fail(fmt::format("{} is {}, expected {} to {}", label(), value, low, high));
  return value;
}

std::int64_t Node::integer(std::int64_t low, std::int64_t high) const {
  const double value = number();
  if (value != std::round(value) || std::abs(value) > 9e15) {
    fail(fmt::format("{} is {}, expected a whole number", label(), value));
  }
  const auto whole = static_cast<std::int64_t>(value);
  if (whole < low) fail(fmt::format("{} is {}, expected a whole number of at least {}", label(), whole, low));
  if (whole > high) fail(fmt::format("{} is {}, expected a whole number of at most {}", label(), whole, high));
  return whole;
}

bool Node::boolean() const {
  bool value = false;
  if (!is_scalar() || !YAML::convert<bool>::decode(node_, value)) {
    fail(fmt::format("{} is {}, expected true or false", label(), kind()));
  }
  return value;
}

std::string Node::text() const {
  if (!is_scalar() || node_.Scalar().empty()) fail(fmt::format("{} is {}, expected a text", label(), kind()));
  return node_.Scalar();
}

Vec3 Node::vector() const {
  const std::vector<Node> parts = items("three numbers [x, y, z]", 3);
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

Vec3 Node::positive_vector() const {
  const Vec3 value = vector();
  if (!(value.array() > 0).all())
    fail(fmt::format("{} has a length that is not more than 0, expected three positive lengths", label()));
  return value;
}

Vec3 Node::direction() const {
  const Vec3 value = vector();
  if (!(value.norm() > 0)) fail(label() + " is the zero vector, expected a direction");
  return value.normalized();
}

Bounds Node::box() const {
  const std::vector<Node> corners = items("two corners [[x, y, z], [x, y, z]]", 2);
  const Bounds box{corners[0].vector(), corners[1].vector()};
  if (!(box.min.array() < box.max.array()).all()) {
    fail(label() + " has no volume, expected the lower corner and then the upper corner");
  }
  return box;
}

double Node::number(const std::string& key, double fallback) const {
  const auto found = find(key);
  return found ? found->number() : fallback;
}

double Node::positive(const std::string& key, double fallback) const {
  const auto found = find(key);
  return found ? found->positive() : fallback;
}

double Node::not_negative(const std::string& key, double fallback) const {
  const auto found = find(key);
  return found ? found->not_negative() : fallback;
}

std::int64_t Node::integer(const std::string& key, std::int64_t fallback, std::int64_t low, std::int64_t high) const {
  const auto found = find(key);
  return found ? found->integer(low, high) : fallback;
}

bool Node::boolean(const std::string& key, bool fallback) const {
  const auto found = find(key);
  return found ? found->boolean() : fallback;
}

std::string Node::text(const std::string& key, const std::string& fallback) const {
  const auto found = find(key);
  return found ? found->text() : fallback;
}

Vec3 Node::vector(const std::string& key, const Vec3& fallback) const {
  const auto found = find(key);
  return found ? found->vector() : fallback;
}

}  // namespace moraine
