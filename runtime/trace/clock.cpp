// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/clock.hpp"

#include <limits>
#include <thread>

#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

constexpr int attempts = 16;
constexpr double quick = 50e-6;   ///< seconds there and back: good enough
constexpr double patience = 0.1;  ///< seconds for it, on a machine that is busy with other things

/// A question for the time, or the end of questions: how far the clock of rank 0 is ahead.
struct Word {
  bool last = false;
  double seconds = 0;
};

void say(Transport& transport, int to, Word word) {
  Bytes bytes;
  write_records(bytes, std::vector{word});
  transport.send(to, std::move(bytes));
}

Word hear(Transport& transport) {
  while (true) {
    if (const std::optional<Parcel> parcel = transport.receive()) {
      std::span<const std::byte> in(parcel->bytes);
      return read_records<Word>(in).at(0);
    }
    std::this_thread::yield();
  }
}

}  // namespace

RunClock::RunClock(Transport& transport) {
  if (transport.rank() == 0)
    ask_all(transport);
  else
    answer(transport);
  transport.all_gather({});  // none goes on before all know
}

void RunClock::ask_all(Transport& transport) const {
  for (int rank = 1; rank < transport.ranks(); ++rank) say(transport, rank, {true, offset_of(transport, rank)});
}

/// How far this clock is ahead of that of `rank`.
double RunClock::offset_of(Transport& transport, int rank) const {
  double fastest = std::numeric_limits<double>::infinity(), offset = 0;
  const double give_up = now() + patience;
  for (int i = 0; i < attempts || (fastest > quick && now() < give_up); ++i) {
    const double sent = now();
    say(transport, rank, {});
    const double there = hear(transport).seconds, back = now();
    if (back - sent >= fastest) continue;
    fastest = back - sent;
    offset = (sent + back) / 2 - there;
  }
  return offset;
}

void RunClock::answer(Transport& transport) {
  for (Word word = hear(transport); true; word = hear(transport)) {
    if (word.last) return shift(word.seconds);
    say(transport, 0, {false, now()});
  }
}

void RunClock::shift(double seconds) {
  origin_ -= std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace moraine::runtime
