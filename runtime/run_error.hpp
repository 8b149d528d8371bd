// SPDX-License-Identifier: Apache-2.0
// A task failed.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "runtime/sub_model.hpp"

namespace moraine::runtime {

/// Where and why. Plain words, so that it can be told to other ranks.
struct Failure {
  int rank = 0;
  std::string stage;
  SubModelId sub_model = 0;
  Round round;
  std::string text;
  int status = 0;  ///< exit status that goes with it
};

/// On the rank where it happened cause() is what the task threw; elsewhere it is empty.
class RunError : public std::runtime_error {
 public:
  explicit RunError(Failure failure, std::exception_ptr cause = nullptr);

  const Failure& failure() const { return failure_; }
  std::exception_ptr cause() const { return cause_; }

 private:
  Failure failure_;
  std::exception_ptr cause_;
};

/// what() of an exception.
std::string what_of(const std::exception_ptr& cause);

}  // namespace moraine::runtime
