// SPDX-License-Identifier: Apache-2.0
#include "output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "output/label.hpp"

namespace moraine {
namespace {

using namespace std::chrono_literals;

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

std::string rate_label(double per_second) {
  if (per_second >= 1e6) return fmt::format("{:.2f} M", per_second / 1e6);
  return fmt::format("{:.3g}{}", per_second >= 1e3 ? per_second / 1e3 : per_second, per_second >= 1e3 ? " k" : "");
}

}  // namespace

std::string progress_line(const Scene& scene, const ProgressSample& sample, std::int64_t done, double elapsed) {
  const double steps_per_s = elapsed > 0 ? static_cast<double>(done) / elapsed : 0;
  const double elements = static_cast<double>(scene.elements.size());
  const double left = static_cast<double>(scene.time.steps - sample.step) / steps_per_s;
  const double share = elements > 0 ? 100 * static_cast<double>(sample.ghosts) / elements : 0;
  return fmt::format("step {}/{}  {}  {} element-steps/s  {} left  {} ghosts ({:.1f} %)  imbalance {:.2f}", sample.step,
                     scene.time.steps, time_label(scene.time, sample.step, sample.time),
                     rate_label(steps_per_s * elements * scene.time.substeps),
                     sample.step >= scene.time.steps ? "0 s" : duration_label(left), grouped(sample.ghosts), share,
                     sample.imbalance);
}

Progress::Progress(const Scene& scene, bool quiet, std::int64_t first_step)
    : scene_(scene), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), first_step_(first_step) {}

Progress::~Progress() {
  if (open_) std::fputc('\n', stderr);
}

void Progress::update(const ProgressSample& sample) {
  sample_ = sample;
  fresh_ = true;
  if (Clock::now() - shown_ >= (terminal_ ? Clock::duration(200ms) : Clock::duration(1min))) show();
}

void Progress::finish() {
  if (fresh_) show();
  if (open_) std::fputc('\n', stderr);
  open_ = false;
}

void Progress::show() {
  fresh_ = false;
  shown_ = Clock::now();
  if (quiet_) return;
  const std::string line = progress_line(scene_, sample_, sample_.step - first_step_, seconds(shown_ - begin_));
  std::fputs((terminal_ ? "\r\x1b[K" + line : line + "\n").c_str(), stderr);
  std::fflush(stderr);
  open_ = terminal_;
}

}  // namespace moraine
