// SPDX-License-Identifier: Apache-2.0
// Runs a program on several ranks that are threads of this process.
#pragma once

#include <exception>
#include <functional>
#include <iostream>
#include <thread>
#include <vector>

#include "physics/errors.hpp"
#include "runtime/migrate/checkpoint.hpp"
#include "runtime/run_error.hpp"
#include "runtime/transport/loopback.hpp"

namespace moraine::test {

/// Calls `program` once per rank, each on a thread of its own, and throws what the first rank threw if all ranks agreed
/// on an error. One that fails alone would leave the others waiting: it ends the test program.
inline void on_ranks(const runtime::LoopbackOptions& options, const std::function<void(runtime::Transport&)>& program) {
  const auto ranks = runtime::make_loopback(options);
  std::vector<std::exception_ptr> errors(ranks.size());
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < ranks.size(); ++rank)
    threads.emplace_back([&, rank] {
      try {
        program(*ranks[rank]);
      } catch (const runtime::RunError&) {
        errors[rank] = std::current_exception();
      } catch (const runtime::CheckpointError&) {
        errors[rank] = std::current_exception();
      } catch (const InvalidStateError&) {  // of a guard
        errors[rank] = std::current_exception();
      } catch (const std::exception& e) {
        std::cerr << "rank " << rank << " fails alone: " << e.what() << '\n';
        ranks[rank]->abort(1);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace moraine::test
