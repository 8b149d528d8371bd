// SPDX-License-Identifier: Apache-2.0
// This process as one of those that mpirun started, for programs that do not use MPI themselves.
#pragma once

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Starts MPI if the process was launched as one of several (by mpirun, srun or another that follows PMI), and ends it.
/// Else the process is alone and MPI is not touched.
class MpiSession {
 public:
  /// Errors: as make_mpi().
  MpiSession();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  Transport& transport() { return mpi_ ? *mpi_ : alone(); }

 private:
  std::unique_ptr<Transport> mpi_;
};

}  // namespace moraine::runtime
