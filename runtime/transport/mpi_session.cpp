// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/mpi_session.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "runtime/transport/mpi.hpp"

namespace moraine::runtime {
namespace {

bool launched_as_one_of_several() {
  constexpr std::array signs{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::any_of(signs.begin(), signs.end(), [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

MpiSession::MpiSession() {
  if (!launched_as_one_of_several()) return;
  int level = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  mpi_ = make_mpi(MPI_COMM_WORLD);
}

MpiSession::~MpiSession() {
  if (!mpi_) return;
  mpi_.reset();
  MPI_Finalize();
}

}  // namespace moraine::runtime
