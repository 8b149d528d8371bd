// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/expression.hpp"

#include <muParser.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace moraine {
namespace {

double floor_of(double x) { return std::floor(x); }
double ceil_of(double x) { return std::ceil(x); }
double round_of(double x) { return std::round(x); }
double cbrt_of(double x) { return std::cbrt(x); }

std::optional<double> plain_number(const std::string& text) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  return value;
}

double compute(mu::Parser& parser, const std::string& text) {
  try {
    parser.SetExpr(text);
    int results = 0;
    const double* values = parser.Eval(results);
    if (results != 1) throw ExpressionError("'" + text + "' gives several values");
    return values[0];
  } catch (const mu::ParserError& e) {
    throw ExpressionError("cannot evaluate '" + text + "' (" + e.GetMsg() + ")");
  }
}

}  // namespace

Expressions::Expressions() : parser_(std::make_unique<mu::Parser>()) {
  parser_->DefineConst("pi", std::numbers::pi);
  parser_->DefineFun("floor", floor_of);
  parser_->DefineFun("ceil", ceil_of);
  parser_->DefineFun("round", round_of);
  parser_->DefineFun("cbrt", cbrt_of);
}

Expressions::~Expressions() = default;
Expressions::Expressions(Expressions&&) noexcept = default;

void Expressions::define(const std::string& name, double value) {
  try {
    if (parser_->GetConst().count(name) > 0) throw ExpressionError("'" + name + "' has a meaning already");
    parser_->DefineConst(name, value);
  } catch (const mu::ParserError& e) {
    throw ExpressionError("'" + name + "' cannot be the name of a parameter (" + e.GetMsg() + ")");
  }
  names_.push_back(name);
}

double Expressions::evaluate(const std::string& text) const {
  const std::optional<double> plain = plain_number(text);
  const double value = plain ? *plain : compute(*parser_, text);
  if (!std::isfinite(value)) throw ExpressionError("'" + text + "' is not a finite number");
  return value;
}

}  // namespace moraine
