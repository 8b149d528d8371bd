// SPDX-License-Identifier: Apache-2.0
// Where the time of workers went. The same for runs with a trace and without.
#pragma once

#include <span>
#include <vector>

#include "runtime/trace/load.hpp"
#include "runtime/trace/phases.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// What a rank did in a run, or in the epochs of it that were traced.
struct RankLoad {
  LoadRecord load;  ///< while tasks ran
  PhaseSeconds phases{};

  double phase(Phase p) const { return phases[static_cast<std::size_t>(p)]; }
  double elapsed() const;  ///< seconds, of all phases
};

/// Seconds of one worker, summed over workers. A rank's workers all wait while it is at anything but tasks.
struct Account {
  double busy = 0;        ///< in tasks
  double imbalance = 0;   ///< waiting for tasks to end: of this rank, of others, and for the last rank of an epoch
  double messages = 0;    ///< waiting for messages on their way, and for ranks to agree on the end of an epoch
  double scheduling = 0;  ///< a task was ready: the scheduler held it, or handing it out and waking up took so long
  double between = 0;     ///< between epochs: neighbours, balancing, checkpoints, plans, output

  double waiting() const { return imbalance + messages + scheduling; }
  double total() const { return busy + waiting() + between; }
  double share(double seconds) const { return total() > 0 ? seconds / total() : 0.0; }
  Account& operator+=(const Account& other);
};

/// Of each rank.
std::vector<Account> accounts_of(std::span<const RankLoad> ranks);
Account sum(std::span<const Account> accounts);

/// Of each rank of a trace.
std::vector<RankLoad> loads_of(const Trace& trace);
/// Of each rank, on rank 0; nothing elsewhere. Collective.
std::vector<RankLoad> gather_loads(const RankLoad& own, Transport& transport);

}  // namespace moraine::runtime
