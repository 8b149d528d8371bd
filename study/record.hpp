// SPDX-License-Identifier: Apache-2.0
// A finished run, as a file: what makes a study resumable.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace moraine::study {

struct Record {
  std::string command;     ///< that ran it
  std::string identity;    ///< of the scene, its settings and the program
  int at_once = 1;         ///< runs at the same time
  int status = 0;          ///< of the command; 128 + signal if one ended it
  std::string message;     ///< why it failed
  nlohmann::json summary;  ///< null if it failed

  bool good() const { return status == 0; }
  /// Whether running it again would come to the same: done, refused, or invalid.
  bool final() const { return status == 0 || status == 2 || status == 3; }
};

/// Errors: IoError.
void write_record(const Record& record, const std::filesystem::path& path);
/// Nothing if there is no such file, or if it is not a record.
std::optional<Record> read_record(const std::filesystem::path& path);

}  // namespace moraine::study
