// SPDX-License-Identifier: Apache-2.0
#include "runtime/run_error.hpp"

#include <fmt/format.h>

namespace moraine::runtime {
namespace {

std::string what_of(const std::exception_ptr& cause) {
  try {
    std::rethrow_exception(cause);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown error";
  }
}

}  // namespace

RunError::RunError(const std::string& stage, SubModelId sub_model, const Round& round, std::exception_ptr cause)
    : std::runtime_error(fmt::format("{} of sub-model {} in {} {}: {}", stage, sub_model,
                                     round.opening() ? "the exchange before round" : "round", round.number,
                                     what_of(cause))),
      stage_(stage),
      sub_model_(sub_model),
      round_(round),
      cause_(std::move(cause)) {}

}  // namespace moraine::runtime
