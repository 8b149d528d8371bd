// SPDX-License-Identifier: Apache-2.0
#include "output/background.hpp"

#include <utility>

#include "output/file.hpp"
#include "output/picture.hpp"
#include "output/writers.hpp"

namespace moraine {
namespace {

constexpr std::size_t kCapacity = 2;  // frames that may wait

}  // namespace

BackgroundWriter::BackgroundWriter(const Scene& scene, std::filesystem::path folder)
    : scene_(scene), folder_(std::move(folder)) {
  make_folder(folder_);
  for (const std::string& format : scene_.output.formats) {
    writers_.push_back(find_writer(format).make(scene_, folder_));
  }
  thread_ = std::thread([this] { work(); });
}

BackgroundWriter::~BackgroundWriter() { stop(false); }

void BackgroundWriter::push(Frame&& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kCapacity || failed_; });
  rethrow();
  if (!failed_) waiting_.push_back(std::move(frame));
  changed_.notify_all();
}

void BackgroundWriter::finish() {
  stop(true);
  const std::lock_guard lock(mutex_);
  rethrow();
}

void BackgroundWriter::stop(bool keep_waiting) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    if (!keep_waiting) waiting_.clear();
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWriter::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void BackgroundWriter::work() {
  try {
    write_all();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    failed_ = true;
    changed_.notify_all();
  }
}

void BackgroundWriter::write_all() {
  while (std::optional<Frame> frame = next()) write(std::move(*frame));
  close();
}

std::optional<Frame> BackgroundWriter::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !waiting_.empty() || stopping_; });
  if (waiting_.empty()) return {};
  Frame frame = std::move(waiting_.front());
  waiting_.pop_front();
  changed_.notify_all();
  return frame;
}

void BackgroundWriter::write(Frame frame) {
  for (const auto& writer : writers_) writer->write(frame);
  const std::filesystem::path first = folder_ / "first.png";
  if (scene_.output.pictures && !last_ && !goes_on(scene_, first)) {
    write_picture(scene_, frame, first, scene_.output.picture_width);
  }
  if (scene_.output.pictures) last_ = std::move(frame);
}

void BackgroundWriter::close() {
  for (const auto& writer : writers_) writer->finish();
  if (scene_.output.pictures && last_) {
    write_picture(scene_, *last_, folder_ / "last.png", scene_.output.picture_width);
  }
}

}  // namespace moraine
