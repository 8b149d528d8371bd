// SPDX-License-Identifier: Apache-2.0
// Typed, checked access to the values of a document. Every error names place, what is wrong and what was expected.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "physics/scene/document.hpp"
#include "physics/types.hpp"

namespace moraine {

class Node {
 public:
  Node(const Document& document, const YAML::Node& node, std::string path, YAML::Mark mark);
  Node(const Node&) = default;
  Node& operator=(const Node&) = delete;  // yaml-cpp would change the document

  static Node root(const Document& document);

  bool is_map() const { return node_.IsMap(); }
  bool is_list() const { return node_.IsSequence(); }
  bool is_scalar() const { return node_.IsScalar(); }
  /// The text of a scalar, unchecked; empty for others.
  const std::string& raw() const { return node_.Scalar(); }

  /// Refuses keys that are not in the list, and keys given twice. Errors also if this is not a map.
  void allow(std::span<const std::string_view> keys) const;
  void allow(std::initializer_list<std::string_view> keys) const { allow(std::span(keys.begin(), keys.size())); }
  std::optional<Node> find(const std::string& key) const;
  Node at(const std::string& key, const std::string& expected = "it") const;
  /// The one key of `keys` that is present.
  std::string one_of(std::initializer_list<std::string_view> keys) const;
  std::vector<std::pair<std::string, Node>> entries() const;

  /// Items of a list; error if it is none or has not `count` items (0: any number).
  std::vector<Node> items(const std::string& expected, std::size_t count = 0) const;

  double number() const;
  double positive() const;
  double not_negative() const;
  double within(double low, double high) const;
  std::int64_t integer(std::int64_t low, std::int64_t high = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean() const;
  std::string text() const;
  Vec3 vector() const;
  Vec3 positive_vector() const;
  Vec3 direction() const;  ///< normalized
  Bounds box() const;      ///< [[min], [max]]

  /// The value of a key, or `fallback` if there is none.
  double number(const std::string& key, double fallback) const;
  double positive(const std::string& key, double fallback) const;
  double not_negative(const std::string& key, double fallback) const;
  std::int64_t integer(const std::string& key, std::int64_t fallback, std::int64_t low,
                       std::int64_t high = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean(const std::string& key, bool fallback) const;
  std::string text(const std::string& key, const std::string& fallback) const;
  Vec3 vector(const std::string& key, const Vec3& fallback) const;

  const std::string& file() const { return document_->file(); }
  int line() const { return mark().line + 1; }
  std::string place() const { return document_->place(path_, mark()); }
  [[noreturn]] void fail(const std::string& what) const { document_->fail(path_, mark(), what); }

 private:
  YAML::Mark mark() const;
  std::string label() const;
  std::string kind() const;
  void check_duplicates() const;

  const Document* document_;
  YAML::Node node_;
  std::string path_;
  YAML::Mark parent_mark_;
};

}  // namespace moraine
