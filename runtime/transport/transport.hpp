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
  /// Called by all ranks, while none sends or receives: `to` has one entry per rank, and so has what comes back. An
  /// entry may be empty.
  virtual std::vector<Bytes> exchange(std::vector<Bytes> to) = 0;
  /// Ends the processes of all ranks, this one too, with this exit status.
  [[noreturn]] virtual void abort(int status) = 0;
  /// Ranks on this machine that share cores with this one, itself included.
  virtual int ranks_on_these_cores() = 0;
};

/// The one rank of a run without others.
Transport& alone();

/// What every rank gives, by rank, on every rank. Called by all.
std::vector<Bytes> all_gather(Transport& transport, const Bytes& own);
/// The same, on rank `root` alone; nothing elsewhere.
std::vector<Bytes> gather(Transport& transport, int root, Bytes own);

}  // namespace moraine::runtime
