// SPDX-License-Identifier: Apache-2.0
// What is written on every message, and how messages and news of failure are packed for other ranks.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/run_error.hpp"
#include "runtime/sub_model.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// A receiver checks it.
struct Envelope {
  int stage = Stage::none;
  SubModelId from = 0;
  SubModelId to = 0;
  std::int64_t round = -1;  ///< in its epoch
  std::int64_t epoch = -1;  ///< counted over the run
  bool operator==(const Envelope&) const = default;
};

/// Another rank has failed; who and why, the ranks settle when all have stopped.
class FailedElsewhere : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `sent_at`: when it leaves, on the run's clock.
Bytes pack(const Envelope& envelope, double sent_at, std::span<const std::byte> content);
Bytes pack_failure();

struct Opened {
  Envelope envelope;
  double sent_at = 0;
  std::span<const std::byte> content;  ///< inside the parcel
};

/// Errors: std::runtime_error if the parcel is of another version or damaged (its checksum, XXH3-64, says so), naming
/// the rank it came from; FailedElsewhere.
Opened unpack(const Parcel& parcel);

}  // namespace moraine::runtime
