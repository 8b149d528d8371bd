// SPDX-License-Identifier: Apache-2.0
// The contract of a transport: how ranks reach each other.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace moraine::runtime {

using Bytes = std::vector<std::byte>;

struct Parcel {
  int from = 0;  ///< rank
  Bytes bytes;
};

/// Parcels between two ranks arrive whole and in order; those of different ranks in any order.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual int rank() const = 0;
  virtual int ranks() const = 0;
  /// Does not wait for the receiver. From any thread.
  virtual void send(int to, Bytes bytes) = 0;
  /// A parcel that has arrived, if there is one. From any thread.
  virtual std::optional<Parcel> receive() = 0;

  // The next four are called by all ranks, in the same order, while none sends or receives.

  /// What every rank gives, by rank, on every rank. Cost: a number of messages per rank that grows as the logarithm of
  /// the ranks while all that is given is short.
  virtual std::vector<Bytes> all_gather(const Bytes& own) = 0;
  /// The same, on rank `root` alone; nothing elsewhere.
  virtual std::vector<Bytes> gather(int root, const Bytes& own) = 0;
  /// `to` has one entry per rank, and so has what comes back. An entry may be empty. Cost: the lengths as in
  /// all_gather(), and one message for every entry that is not empty.
  virtual std::vector<Bytes> exchange(std::vector<Bytes> to) = 0;
  /// Drops all parcels that were sent and not received: after a failure nobody wants them, and a long one keeps its
  /// sender until it is received.
  virtual void drop_parcels() = 0;

  /// Ends the processes of all ranks, this one too, with this exit status.
  [[noreturn]] virtual void abort(int status) = 0;
  /// Ranks on this machine that share cores with this one, itself included.
  virtual int ranks_on_these_cores() = 0;
};

/// The one rank of a run without others.
Transport& alone();

}  // namespace moraine::runtime
