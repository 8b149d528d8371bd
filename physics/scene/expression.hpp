// SPDX-License-Identifier: Apache-2.0
// Numbers in a scene file: plain, or expressions of the scene's parameters.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace mu {
class Parser;
}

namespace moraine {

/// What is wrong with an expression; the reader adds the place.
struct ExpressionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Evaluates numbers such as `3.3e3`, `2 * radius` or `round(25 * scale)`.
/// Operators and functions are those of muParser, with `pi`, `floor`, `ceil`, `round` and `cbrt` added.
class Expressions {
 public:
  Expressions();
  ~Expressions();
  Expressions(Expressions&&) noexcept;

  /// Makes `name` usable in the expressions that follow.
  void define(const std::string& name, double value);
  /// A finite number. Errors: ExpressionError.
  double evaluate(const std::string& text) const;
  /// In the order they were defined.
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unique_ptr<mu::Parser> parser_;
  std::vector<std::string> names_;
};

}  // namespace moraine
