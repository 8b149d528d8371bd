// SPDX-License-Identifier: Apache-2.0
// Saving a run so that it can go on later, on other ranks, as if it had never stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <stdexcept>
#include <string>

#include "runtime/sub_model.hpp"
#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

class Rebalance;

struct CheckpointOptions {
  std::filesystem::path folder;  ///< of all checkpoints; seen by all ranks
  std::int64_t every = 0;        ///< rounds from one checkpoint to the next, at least; 0: none
  std::string run;               ///< what is computed: a checkpoint of something else is refused
  std::size_t keep = 2;          ///< older ones of this run are removed
};

/// Why a checkpoint cannot be used, and which one could be used instead.
class CheckpointError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A checkpoint is a folder: one file per sub-model, one for what all share, and a manifest with the checksum (XXH3-64)
/// of each. It is written under another name in the background and gets its name when everything is on disk, so it is
/// complete or absent. Those of other runs in the same folder stay. Later ones of this run, which it is about to make
/// anew, are renamed to earlier_*. Collective unless said otherwise.
class Checkpoints {
 public:
  Checkpoints(const CheckpointOptions& options, Transport& transport);
  ~Checkpoints();

  /// Between the settling of neighbours and the first round: completes the last checkpoint, begins another if it is
  /// due. Only copying the state to memory holds up the run. Errors: std::system_error if files cannot be written.
  void settle(Model& model, const Rebalance& balance, std::int64_t next_round);
  /// Completes the last checkpoint.
  void finish();
  /// Returns the first round to run. Errors: CheckpointError, the same on every rank.
  std::int64_t restore(const std::filesystem::path& folder, Model& model, Rebalance& balance);

 private:
  struct Written {
    std::uint64_t bytes = 0;
    std::uint64_t checksum = 0;
  };
  /// What one rank writes: name and content.
  using Files = std::map<std::string, Bytes>;

  void begin(Model& model, const Rebalance& balance, std::int64_t next_round);
  std::filesystem::path place(const char* kind, std::int64_t round) const;
  void tidy(std::int64_t round) const;
  std::filesystem::path unfinished(std::int64_t round) const;

  CheckpointOptions options_;
  Transport& transport_;
  std::int64_t last_round_ = 0;  ///< of the last checkpoint, or of the start
  std::int64_t writing_ = -1;    ///< round of the one being written
  std::future<std::map<std::string, Written>> written_;
};

/// Complete checkpoints in `folder`, newest first. Not collective.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);
/// Those of one run (CheckpointOptions::run) only.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder, const std::string& run);

}  // namespace moraine::runtime
