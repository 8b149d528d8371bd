// SPDX-License-Identifier: Apache-2.0
// Ranks as processes, by MPI.
#pragma once

#include <mpi.h>

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Works on a duplicate of `communicator`, so that a host program's own messages are never touched. MPI must have been
/// started with MPI_THREAD_SERIALIZED at least, and be ended after the transport. Collective.
/// Errors: std::runtime_error if the thread level is lower, naming both.
std::unique_ptr<Transport> make_mpi(MPI_Comm communicator);

}  // namespace moraine::runtime
