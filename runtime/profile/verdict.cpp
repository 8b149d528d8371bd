// SPDX-License-Identifier: Apache-2.0
#include "runtime/profile/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace moraine::runtime {
namespace {

constexpr double least_told = 0.01;  // of the run time: less imbalance has no culprit

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::string of(const Culprit& c) {
  const std::string cost = c.times_median >= 1.5 ? fmt::format("costs {:.1f} times the median", c.times_median)
                                                 : "costs no more than others";
  if (c.traced) return fmt::format(" ({:.0f} % of it for sub-model {}, which {})", 100 * c.share, c.sub_model, cost);
  return fmt::format(" (sub-model {} {})", c.sub_model, cost);
}

}  // namespace

std::optional<Culprit> culprit_of(std::span<const double> seconds, std::span<const double> awaited) {
  if (seconds.size() < 2) return std::nullopt;
  const std::span<const double> by = awaited.empty() ? seconds : awaited;
  const auto most = std::ranges::max_element(by);
  const double sum = std::accumulate(by.begin(), by.end(), 0.0);
  if (sum <= 0) return std::nullopt;
  const auto at = static_cast<std::size_t>(most - by.begin());
  const double usual = median({seconds.begin(), seconds.end()});
  const Culprit c{static_cast<std::uint32_t>(at), *most / sum, usual > 0 ? seconds[at] / usual : 1.0, !awaited.empty()};
  const bool stands_out = c.times_median >= 2 || (c.traced && c.share >= 0.5);
  return stands_out ? std::optional(c) : std::nullopt;
}

std::optional<Advice> advice_of(const Cures& cures, const Workload& work) {
  if (!cures.best) return std::nullopt;
  const Cure& best = cures.tried[*cures.best];
  return Advice{words(best, work), best.gain, best.change == Change::finer_cut};
}

std::string sentence(const Account& all, const std::optional<Culprit>& culprit, const std::optional<Advice>& advice) {
  const auto percent = [&](double seconds) { return 100 * all.share(seconds); };
  std::string text = fmt::format("{:.1f} % of the run time was spent waiting: {:.1f} % imbalance",
                                 percent(all.waiting()), percent(all.imbalance));
  if (culprit && all.share(all.imbalance) >= least_told) text += of(*culprit);
  text += fmt::format(", {:.1f} % messages, {:.1f} % scheduling; {:.1f} % passed between epochs; ",
                      percent(all.messages), percent(all.scheduling), percent(all.between));
  if (!advice) return text + "no change that was tried in replays promises 1 % or more.";
  return text + fmt::format("the cure most likely to help is {}: {:.1f} % less time{}.", advice->words,
                            100 * advice->gain, advice->changes_results ? ", results change a little" : "");
}

}  // namespace moraine::runtime
