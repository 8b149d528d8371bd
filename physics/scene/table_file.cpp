// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "physics/errors.hpp"

namespace moraine {
namespace {

using Words = std::vector<std::string_view>;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Lines of a file with their numbers, without comments and blank ones.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : name_(file.string()), in_(file) {
    if (!in_) throw InputError(name_ + ": cannot read, expected a table of elements");
  }

  bool next() {
    while (std::getline(in_, line_)) {
      ++number_;
      const std::string_view text(line_);
      const auto hash = text.find('#');
      comment_ = hash == std::string_view::npos ? std::string_view{} : trimmed(text.substr(hash + 1));
      content_ = trimmed(text.substr(0, hash));
      if (!content_.empty()) return true;
    }
    return false;
  }
  std::string_view content() const { return content_; }
  std::string_view comment() const { return comment_; }
  int number() const { return number_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, std::max(number_, 1), what));
  }

  Words split(char separator) const {
    Words words;
    for (std::string_view rest = content_;;) {
      const auto end = rest.find(separator);
      words.push_back(trimmed(rest.substr(0, end)));
      if (end == std::string_view::npos) return words;
      rest.remove_prefix(end + 1);
    }
  }
  Words words() const {
    Words words;
    for (std::string_view rest = content_; !rest.empty();) {
      const auto end = std::min(rest.find_first_of(" \t"), rest.size());
      words.push_back(rest.substr(0, end));
      rest = trimmed(rest.substr(end));
    }
    return words;
  }
  double number(std::string_view word, std::string_view what) const {
    double value = 0;
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      fail(fmt::format("{} is '{}', expected a finite number", what, word));
    }
    return value;
  }
  ElementId id(std::string_view word) const {
    ElementId value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value == UINT32_MAX) {
      fail(fmt::format("the id is '{}', expected a whole number from 0 to {}", word, UINT32_MAX - 1));
    }
    return value;
  }
  double positive(std::string_view word, std::string_view what) const {
    const double value = number(word, what);
    if (!(value > 0)) fail(fmt::format("{} is {}, expected more than 0", what, word));
    return value;
  }

 private:
  std::string name_;
  std::ifstream in_;
  std::string line_;
  std::string_view content_, comment_;
  int number_ = 0;
};

using Header = std::vector<std::string>;

constexpr std::string_view csv_columns[] = {"id", "x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz"};

void check_header(const Lines& lines, const Header& header) {
  for (const std::string& name : header) {
    if (std::find(std::begin(csv_columns), std::end(csv_columns), name) == std::end(csv_columns)) {
      lines.fail(fmt::format("unknown column '{}', expected id, x, y, z, radius, vx, vy, vz, wx, wy, wz", name));
    }
    if (std::count(header.begin(), header.end(), name) > 1) lines.fail(fmt::format("column '{}' appears twice", name));
  }
  for (const std::string_view name : {"x", "y", "z"}) {
    if (std::find(header.begin(), header.end(), name) == header.end()) {
      lines.fail(fmt::format("no column '{}', expected at least x, y, z", name));
    }
  }
}

void set_value(const Lines& lines, TableRow& row, std::string_view column, std::string_view word) {
  if (column == "id") {
    row.id = lines.id(word);
  } else if (column == "radius") {
    row.radius = lines.positive(word, column);
  } else if (column.size() == 1) {
    row.position[column[0] - 'x'] = lines.number(word, column);
  } else {
    if (!row.twist) row.twist.emplace();
    Vec3& vector = column[0] == 'v' ? row.twist->linear : row.twist->angular;
    vector[column[1] - 'x'] = lines.number(word, column);
  }
}

/// Reads a LAMMPS data file section by section.
class LammpsReader {
 public:
  explicit LammpsReader(const std::filesystem::path& file) : lines_(file) {}

  std::vector<TableRow> read() {
    while (lines_.next()) read_line();
    if (rows_.size() != promised_) {
      lines_.fail(fmt::format("the file ends after {} atoms, expected {} as its header says", rows_.size(), promised_));
    }
    return std::move(rows_);
  }

 private:
  void read_line() {
    const std::string_view text = lines_.content();
    if (std::isalpha(static_cast<unsigned char>(text.front())) != 0) {
      begin_section(text);
    } else if (section_.empty()) {
      read_header(lines_.words());
    } else if (section_ == "Atoms") {
      read_atom(lines_.words());
    } else if (section_ == "Velocities") {
      read_velocity(lines_.words());
    }
  }

  /// The first line of a data file is a title; a section starts with a letter after it.
  void begin_section(std::string_view text) {
    if (lines_.number() == 1) return;
    section_ = text;
    if (section_ == "Atoms" && !lines_.comment().empty() && lines_.comment() != "sphere") {
      lines_.fail(fmt::format("atom style '{}', expected sphere", lines_.comment()));
    }
    static constexpr std::string_view known[] = {"Atoms", "Velocities", "Masses", "Pair Coeffs", "PairIJ Coeffs"};
    if (std::find(std::begin(known), std::end(known), text) == std::end(known)) {
      lines_.fail(fmt::format("unknown section '{}', expected Atoms or Velocities", text));
    }
  }

  void read_header(const Words& words) {
    if (lines_.number() > 1 && words.size() == 2 && words[1] == "atoms") promised_ = lines_.id(words[0]);
  }

  void read_atom(const Words& words) {
    if (words.size() != 7 && words.size() != 10) {
      lines_.fail(fmt::format("{} values, expected id type diameter density x y z", words.size()));
    }
    TableRow row;
    row.line = lines_.number();
    row.id = lines_.id(words[0]);
    row.radius = lines_.positive(words[2], "the diameter") / 2;
    row.density = lines_.positive(words[3], "the density");
    for (std::size_t a = 0; a < 3; ++a) row.position[static_cast<int>(a)] = lines_.number(words[4 + a], "a coordinate");
    by_id_.emplace(*row.id, rows_.size());
    rows_.push_back(row);
  }

  void read_velocity(const Words& words) {
    if (words.size() != 7) lines_.fail(fmt::format("{} values, expected id vx vy vz wx wy wz", words.size()));
    const auto found = by_id_.find(lines_.id(words[0]));
    if (found == by_id_.end()) lines_.fail(fmt::format("velocity of atom {}, expected an atom of this file", words[0]));
    Twist twist;
    for (std::size_t a = 0; a < 3; ++a) {
      twist.linear[static_cast<int>(a)] = lines_.number(words[1 + a], "a velocity");
      twist.angular[static_cast<int>(a)] = lines_.number(words[4 + a], "an angular velocity");
    }
    rows_[found->second].twist = twist;
  }

  Lines lines_;
  std::string section_;
  std::size_t promised_ = 0;
  std::vector<TableRow> rows_;
  std::map<ElementId, std::size_t> by_id_;
};

}  // namespace

std::vector<TableRow> read_csv(const std::filesystem::path& file) {
  Lines lines(file);
  if (!lines.next()) lines.fail("the file is empty, expected a header line such as id,x,y,z,radius");
  const Words names = lines.split(',');
  const Header header(names.begin(), names.end());
  check_header(lines, header);

  std::vector<TableRow> rows;
  while (lines.next()) {
    const Words words = lines.split(',');
    if (words.size() != header.size()) {
      lines.fail(fmt::format("{} values, expected {} as in the header", words.size(), header.size()));
    }
    TableRow row;
    row.line = lines.number();
    for (std::size_t i = 0; i < words.size(); ++i) set_value(lines, row, header[i], words[i]);
    rows.push_back(row);
  }
  return rows;
}

std::vector<TableRow> read_lammps(const std::filesystem::path& file) { return LammpsReader(file).read(); }

}  // namespace moraine
