// SPDX-License-Identifier: Apache-2.0
// A task failed.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

/// Says where, and keeps what the task threw: std::rethrow_exception(error.cause()).
class RunError : public std::runtime_error {
 public:
  RunError(const std::string& stage, SubModelId sub_model, const Round& round, std::exception_ptr cause);

  const std::string& stage() const { return stage_; }
  SubModelId sub_model() const { return sub_model_; }
  const Round& round() const { return round_; }
  std::exception_ptr cause() const { return cause_; }

 private:
  std::string stage_;
  SubModelId sub_model_;
  Round round_;
  std::exception_ptr cause_;
};

}  // namespace moraine::runtime
