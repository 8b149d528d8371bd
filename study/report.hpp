// SPDX-License-Identifier: Apache-2.0
// What a study found, and its forms: a table for the terminal and for documents, CSV, JSON, a plot.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/row.hpp"

namespace moraine::study {

/// Another program's figures for the same scene.
struct Peer {
  std::string name;
  double speed = 0;                                         ///< simulated seconds per second
  std::vector<std::pair<std::string_view, double>> values;  ///< of observables
  std::vector<Comparison> compared;                         ///< of the counted observables it states
  std::optional<double> error() const;
};

/// `NAME=SPEED` or `NAME=SPEED,observable=value,...`. Errors: InputError.
Peer read_peer(const std::string& text);
/// With what counts.
void compare(Peer& peer, const Yardstick& yardstick);

struct Report {
  std::string scene, file, command;
  double duration = 0;  ///< simulated [s]
  std::size_t elements = 0;
  std::string seeds_text;  ///< how seeds differ
  Seconds seconds = Seconds::wall;
  int at_once = 1, cores = 1, threads = 1;
  std::vector<Yardstick::Mark> marks;
  std::optional<double> noise;   ///< as Yardstick::noise()
  std::optional<Row> reference;  ///< none if all that counts is expected
  std::vector<Row> rows;
  std::vector<std::size_t> front;  ///< indices of rows, fastest first
  std::vector<Peer> peers;
  std::vector<double> wishes{0.01, 0.03, 0.1};
};

/// "1.2 %", "1.2 ± 0.4 %"
std::string error_text(const Error& error);
/// "about 2864 seeds of it or 70 seeds of it and of the reference would decide": of the reference too only if that are
/// fewer.
std::string seeds_text(const SeedsNeeded& needed);
/// What the reference's seeds alone amount to, as a sentence.
std::string noise_text(const std::optional<double>& noise);
std::string csv_text(const Report& report);
std::string json_text(const Report& report);
/// Markdown: what was compared, the front with its command lines, the fastest below each wish, what failed.
std::string front_text(const Report& report);
/// Error against speed, both logarithmic, as SVG.
std::string plot_text(const Report& report);

}  // namespace moraine::study
