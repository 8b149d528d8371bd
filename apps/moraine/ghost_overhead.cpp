// SPDX-License-Identifier: Apache-2.0
#include "ghost_overhead.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace moraine::app {
namespace {

std::optional<std::size_t> place_of(std::string_view name, const runtime::TraceSettings& settings) {
  const auto found = std::ranges::find(settings.counters, name);
  if (found == settings.counters.end()) return std::nullopt;
  return static_cast<std::size_t>(found - settings.counters.begin());
}

}  // namespace

std::vector<double> GhostOverhead::halo() const {
  if (of.size() != 1) return of;
  return {elements > 1 ? std::min(0.5, 1 / std::cbrt(elements)) : 0.0};
}

GhostOverhead ghost_overhead(const runtime::TraceSettings& settings, std::span<const Counters> counters,
                             std::span<const double> seconds) {
  GhostOverhead out;
  const auto elements = place_of("elements", settings), ghosts = place_of("ghosts", settings);
  double busy = 0;
  for (std::size_t s = 0; s < counters.size(); ++s) {
    const double own = elements ? counters[s][*elements] : 0.0, foreign = ghosts ? counters[s][*ghosts] : 0.0;
    out.elements += own;
    out.ghosts += foreign;
    out.of.push_back(own + foreign > 0 ? foreign / (own + foreign) : 0.0);
    busy += seconds[s];
    out.share += seconds[s] * out.of.back();
  }
  out.share = busy > 0 ? out.share / busy : 0.0;
  return out;
}

}  // namespace moraine::app
