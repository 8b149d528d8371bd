// SPDX-License-Identifier: Apache-2.0
// A setting as text to paste: into a shell, into a scene.
#include <fmt/format.h>

#include <algorithm>

#include "study/subject.hpp"

namespace moraine::study {
namespace {

/// The last of each key, in the order in which the keys first came.
std::vector<Override> effective(const std::vector<Override>& overrides) {
  std::vector<Override> kept;
  for (const Override& o : overrides) {
    const auto same = [&](const Override& k) { return k.key == o.key; };
    if (const auto found = std::find_if(kept.begin(), kept.end(), same); found != kept.end()) {
      found->value = o.value;
    } else {
      kept.push_back(o);
    }
  }
  return kept;
}

/// As a word of a shell.
std::string quoted(const std::string& word) {
  constexpr std::string_view harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// A map of YAML, keys in the order in which they came.
struct Map {
  std::vector<std::pair<std::string, std::string>> values;
  std::vector<std::pair<std::string, Map>> maps;

  Map& below(const std::string& key) {
    for (auto& [name, map] : maps)
      if (name == key) return map;
    return maps.emplace_back(key, Map{}).second;
  }
  void put(const std::string& path, const std::string& value) {
    const auto dot = path.find('.');
    if (dot == std::string::npos) {
      values.emplace_back(path, value);
    } else {
      below(path.substr(0, dot)).put(path.substr(dot + 1), value);
    }
  }
  std::string flow() const {
    std::string text;
    for (const auto& [key, value] : values) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key, value);
    for (const auto& [key, map] : maps) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key, map.flow());
    return "{" + text + "}";
  }
};

}  // namespace

std::string command_line(const std::string& file, const std::vector<Override>& overrides) {
  std::string text = "moraine run " + quoted(file);
  for (const Override& o : effective(overrides)) {
    if (const auto flag = flag_of(o.key)) {
      text += fmt::format(" {} {}", *flag, quoted(o.value));
    } else {
      text += " --set " + quoted(o.key + "=" + o.value);
    }
  }
  return text;
}

std::string yaml_text(const std::vector<Override>& changes) {
  Map top;
  for (const Override& o : effective(changes)) top.put(o.key, o.value);
  std::string text;
  for (const auto& [key, value] : top.values) text += fmt::format("{}: {}\n", key, value);
  for (const auto& [key, map] : top.maps) text += fmt::format("{}: {}\n", key, map.flow());
  return text;
}

}  // namespace moraine::study
