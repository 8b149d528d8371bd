// SPDX-License-Identifier: Apache-2.0
#include "study/record.hpp"

#include "output/file.hpp"

namespace moraine::study {

void write_record(const Record& r, const std::filesystem::path& path) {
  const nlohmann::ordered_json json{{"command", r.command}, {"identity", r.identity}, {"at_once", r.at_once},
                                    {"status", r.status},   {"message", r.message},   {"summary", r.summary}};
  replace_file(path, json.dump(2) + "\n");
}

std::optional<Record> read_record(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const nlohmann::json json = nlohmann::json::parse(read_file(path), nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    return Record{json.at("command"), json.at("identity"), json.at("at_once"),
                  json.at("status"),  json.at("message"),  json.at("summary")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace moraine::study
