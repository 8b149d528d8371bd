// SPDX-License-Identifier: Apache-2.0
// A YAML file with its overrides: where every value came from, and the parameters its numbers may use.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/scene/expression.hpp"
#include "physics/scene/reader.hpp"

namespace moraine {

class Document {
 public:
  /// Reads the file, applies the overrides and evaluates the parameters. `top_keys`: allowed at the top level.
  Document(const std::filesystem::path& file, const std::vector<Override>& overrides,
           std::span<const std::string_view> top_keys);

  const std::string& file() const { return file_; }
  const YAML::Node& root() const { return root_; }
  const Expressions& expressions() const { return expressions_; }

  /// The place of a value for error texts: `file:line:column`, or the override that set it.
  std::string place(const std::string& path, const YAML::Mark& mark) const;
  [[noreturn]] void fail(const std::string& path, const YAML::Mark& mark, const std::string& what) const;

 private:
  void load();
  void apply(const Override& change);
  std::string resolve(const Override& change) const;
  YAML::Node value_of(const Override& change) const;
  void check_step(const Override& change, const YAML::Node& parent, const std::string& key) const;
  void drop_rival(const std::string& path);
  void read_parameters();
  [[noreturn]] void refuse(const Override& change, const std::string& why) const;

  std::string file_;
  YAML::Node root_;
  Expressions expressions_;
  std::map<std::string, std::string> origins_;  ///< path to override
  std::vector<std::string_view> top_keys_;
};

/// `a, b, c`
std::string listing(std::span<const std::string_view> words);
/// `; did you mean 'word'?` for the word most like `given`, or nothing if none is.
std::string suggestion(std::string_view given, std::span<const std::string_view> words);

}  // namespace moraine
