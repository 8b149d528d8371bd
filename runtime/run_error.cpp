// SPDX-License-Identifier: Apache-2.0
#include "runtime/run_error.hpp"

#include <fmt/format.h>

namespace moraine::runtime {

std::string what_of(const std::exception_ptr& cause) {
  try {
    std::rethrow_exception(cause);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown error";
  }
}

RunError::RunError(Failure failure, std::exception_ptr cause)
    : std::runtime_error(fmt::format("rank {}, {} of sub-model {} in {} {}: {}", failure.rank, failure.stage,
                                     failure.sub_model, failure.round.opening() ? "the exchange before round" : "round",
                                     failure.round.number, failure.text)),
      failure_(std::move(failure)),
      cause_(std::move(cause)) {}

}  // namespace moraine::runtime
