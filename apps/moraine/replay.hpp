// SPDX-License-Identifier: Apache-2.0
// moraine replay: what a traced run would be like on other machines.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace moraine::app {

/// Lists are tried in all combinations. Empty ones, and numbers below zero: as traced.
struct ReplayChoices {
  std::filesystem::path trace;
  std::vector<int> ranks, threads;
  std::vector<std::string> schedulers, balancers;
  int balance_every = -1;  ///< steps
  int cores = -1;          ///< as traced
  double latency = -1, bandwidth = 1e10, speed = 1;
  std::size_t copies = 1;
  int epochs = -1;
  bool json = false;

  void add_to(CLI::App& command);
};

int replay(const ReplayChoices& choices);

}  // namespace moraine::app
