// SPDX-License-Identifier: Apache-2.0
// Writes frames on a thread of its own, so that the steps go on meanwhile.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "output/writer.hpp"

namespace moraine {

/// Every format of scene.output, and, with scene.output.pictures, first.png and last.png.
class BackgroundWriter {
 public:
  /// Makes the folder. The scene must outlive the writer. Errors: InputError for an unknown format, IoError.
  BackgroundWriter(const Scene& scene, std::filesystem::path folder);
  /// Drops what is still waiting; errors stay unreported. Call finish() to keep it.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Hands over a frame; waits only while two are waiting already. Errors: what went wrong since, once.
  void push(Frame&& frame);
  /// Waits until all is written and closes the files. Further calls do nothing. Errors: what went wrong, once.
  void finish();

 private:
  void work();
  void write_all();
  std::optional<Frame> next();
  void write(Frame frame);
  void close();
  void stop(bool keep_waiting);
  void rethrow();

  const Scene& scene_;
  std::filesystem::path folder_;
  std::vector<std::unique_ptr<Writer>> writers_;
  std::optional<Frame> last_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<Frame> waiting_;
  bool stopping_ = false;
  bool failed_ = false;
  std::exception_ptr error_;

  std::thread thread_;
};

}  // namespace moraine
