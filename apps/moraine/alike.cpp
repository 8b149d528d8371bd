// SPDX-License-Identifier: Apache-2.0
#include "alike.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "identity.hpp"
#include "physics/errors.hpp"

namespace moraine::app {
namespace {

/// What decides on results, and on what ranks do together and when.
std::vector<std::string> agreed(const Scene& s) {
  const RunSettings& r = s.run;
  return {fmt::format("a scene of identity {}", identity(s)),
          fmt::format("{} steps of {} substeps", s.time.steps, s.time.substeps),
          fmt::format("scheduler {}", r.scheduler),
          fmt::format("threads {}", r.threads > 0 ? "stated" : "not stated"),
          fmt::format("balancer {} every {} steps by {} work, predicted by {}", r.balancer, r.balance_every,
                      r.balance_measured ? "measured" : "counted", r.load_prediction),
          fmt::format("owners [{}]", fmt::join(r.owners, ", ")),
          fmt::format("a checkpoint every {} steps", r.checkpoint_every),
          fmt::format("restart '{}'", r.restart),
          fmt::format("folder '{}' for results", s.output.folder),
          fmt::format("trace '{}' of steps {}:{}:{}", r.trace, r.trace_window.from, r.trace_window.to,
                      r.trace_window.every),
          fmt::format("output every {} steps{}", s.output.every, s.output.quiet ? ", quiet" : "")};
}

runtime::Bytes told(const std::vector<std::string>& all) {
  const std::string text = fmt::format("{}", fmt::join(all, "\n"));
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

std::vector<std::string> heard(const runtime::Bytes& bytes) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

}  // namespace

void check_alike(const Scene& scene, runtime::Transport& transport) {
  if (transport.ranks() == 1) return;
  const std::vector<runtime::Bytes> all = transport.all_gather(told(agreed(scene)));
  const std::vector<std::string> first = heard(all.front());
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    const std::vector<std::string> other = heard(all[rank]);
    for (std::size_t i = 0; i < std::min(first.size(), other.size()); ++i)
      if (other[i] != first[i])
        throw InputError(
            fmt::format("rank {} has {}, rank 0 {}; expected the same scene file and the same MORAINE_ "
                        "variables for all ranks (mpirun -x NAME passes one on to other machines)",
                        rank, other[i], first[i]));
  }
}

}  // namespace moraine::app
