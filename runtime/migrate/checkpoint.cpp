// SPDX-License-Identifier: Apache-2.0
#include "runtime/migrate/checkpoint.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "runtime/balance/initial_owners.hpp"
#include "runtime/balance/rebalance.hpp"
#include "runtime/migrate/durable_file.hpp"

namespace moraine::runtime {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int version = 1;
constexpr auto common_name = "common.bin";
constexpr auto manifest_name = "manifest.json";

std::string name_of(SubModelId id) { return fmt::format("sub_model_{:06}.bin", id); }

std::string hex(std::uint64_t x) { return fmt::format("{:016x}", x); }

std::uint64_t checksum(const Bytes& bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

json read_manifest(const fs::path& folder) {
  try {
    const Bytes text = read_file(folder / manifest_name);
    return json::parse(reinterpret_cast<const char*>(text.data()),
                       reinterpret_cast<const char*>(text.data()) + text.size());
  } catch (const std::exception& e) {
    throw CheckpointError(fmt::format("{}: no complete checkpoint: {}", folder.string(), e.what()));
  }
}

/// Which run made a checkpoint, before which round.
struct Origin {
  std::string run;
  std::int64_t round = 0;
};

/// None if there is no checkpoint, or none that can be read.
std::optional<Origin> origin_of(const fs::path& folder) {
  try {
    const json manifest = read_manifest(folder);
    return Origin{manifest.at("run").get<std::string>(), manifest.at("round").get<std::int64_t>()};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// Content of a file that the manifest lists, if it is what was written.
Bytes read_checked(const fs::path& folder, const json& manifest, const std::string& name) {
  const fs::path path = folder / name;
  const json& entry = manifest.at("files").at(name);
  Bytes bytes;
  try {
    bytes = read_file(path);
  } catch (const std::exception& e) {
    throw CheckpointError(fmt::format("{}: {}", path.string(), e.what()));
  }
  if (bytes.size() != entry.at("bytes").get<std::uint64_t>())
    throw CheckpointError(fmt::format("{}: truncated: {} bytes, expected {}", path.string(), bytes.size(),
                                      entry.at("bytes").get<std::uint64_t>()));
  if (hex(checksum(bytes)) != entry.at("xxh3").get<std::string>())
    throw CheckpointError(fmt::format("{}: damaged: checksum {}, expected {}", path.string(), hex(checksum(bytes)),
                                      entry.at("xxh3").get<std::string>()));
  return bytes;
}

void check_manifest(const fs::path& folder, const json& manifest, const Model& model, const std::string& run) {
  const auto refuse = [&](const std::string& why) {
    throw CheckpointError(fmt::format("{}: {}", (folder / manifest_name).string(), why));
  };
  if (manifest.value("version", 0) != version)
    refuse(fmt::format("version {}, this program reads {}", manifest.value("version", 0), version));
  if (manifest.value("run", "") != run)
    refuse(fmt::format("of another run ({}, expected {}): scene and settings that change results must be the same",
                       manifest.value("run", ""), run));
  if (manifest.value("sub_models", std::size_t{0}) != model.size())
    refuse(fmt::format("of {} sub-models, expected {}", manifest.value("sub_models", std::size_t{0}), model.size()));
}

/// Ranks get blocks of about as many bytes: loads follow them closely enough until the first balance.
Owners owners_by_bytes(const json& manifest, const Model& model, int ranks) {
  std::vector<double> bytes;
  for (SubModelId id = 0; id < model.size(); ++id)
    bytes.push_back(manifest.at("files").at(name_of(id)).at("bytes").get<double>());
  return initial_owners(bytes, std::vector<double>(static_cast<std::size_t>(ranks), 1.0));
}

void read_all(const fs::path& folder, const json& manifest, Model& model, Rebalance& balance, Transport& transport) {
  const Bytes common = read_checked(folder, manifest, common_name);
  std::span<const std::byte> rest(common);
  balance.load(rest);
  model.load_common(rest);
  for (SubModelId id = 0; id < model.size(); ++id) model.release(id);
  model.place({transport.rank(), owners_by_bytes(manifest, model, transport.ranks())});
  for (SubModelId id = 0; id < model.size(); ++id)
    if (model.placement().holds(id)) model.adopt(id, read_checked(folder, manifest, name_of(id)));
}

/// What is wrong on some rank is wrong on all.
void agree(Transport& transport, const std::string& problem) {
  const auto* letters = reinterpret_cast<const std::byte*>(problem.data());
  for (const Bytes& told : transport.all_gather(Bytes(letters, letters + problem.size())))
    if (!told.empty()) throw CheckpointError(std::string(reinterpret_cast<const char*>(told.data()), told.size()));
}

struct Made {
  fs::path folder;
  std::int64_t round = 0;  ///< before which
};

/// Complete checkpoints of a run, newest first.
std::vector<Made> made_by(const std::string& run, const fs::path& folder) {
  std::vector<Made> found;
  for (const fs::path& checkpoint : list_checkpoints(folder))
    if (const auto origin = origin_of(checkpoint); origin && origin->run == run)
      found.push_back({checkpoint, origin->round});
  return found;
}

/// Another complete checkpoint of the run beside a bad one, as a hint.
std::string alternative(const fs::path& bad, const std::string& run) {
  for (const fs::path& other : list_checkpoints(fs::absolute(bad).lexically_normal().parent_path(), run))
    if (other.filename() != bad.filename()) return fmt::format("; {} is there to restart from", other.string());
  return "; there is no other of this run";
}

}  // namespace

std::vector<fs::path> list_checkpoints(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().filename().string().starts_with("round_") && fs::exists(entry.path() / manifest_name))
      found.push_back(entry.path());
  std::sort(found.begin(), found.end(), std::greater<>());
  return found;
}

std::vector<fs::path> list_checkpoints(const fs::path& folder, const std::string& run) {
  std::vector<fs::path> found;
  for (const Made& c : made_by(run, folder)) found.push_back(c.folder);
  return found;
}

Checkpoints::Checkpoints(const CheckpointOptions& options, Transport& transport)
    : options_(options), transport_(transport) {}

Checkpoints::~Checkpoints() = default;

/// The name of a checkpoint of this run. One of another run that has it keeps it.
fs::path Checkpoints::place(const char* kind, std::int64_t round) const {
  const fs::path plain = options_.folder / fmt::format("{}_{:012}", kind, round);
  const auto there = origin_of(plain);
  if (!fs::exists(plain) || (there && there->run == options_.run)) return plain;
  return plain.string() + "_" + hex(XXH3_64bits(options_.run.data(), options_.run.size()));
}

fs::path Checkpoints::unfinished(std::int64_t round) const {
  return options_.folder / fmt::format("unfinished_{:012}", round);
}

void Checkpoints::settle(Model& model, const Rebalance& balance, std::int64_t next_round) {
  finish();
  if (options_.every > 0 && next_round >= last_round_ + options_.every) begin(model, balance, next_round);
}

void Checkpoints::begin(Model& model, const Rebalance& balance, std::int64_t next_round) {
  last_round_ = writing_ = next_round;
  Files files;
  for (SubModelId id = 0; id < model.size(); ++id)
    if (model.placement().holds(id)) model.sub_model(id).save(files[name_of(id)]);
  if (transport_.rank() == 0) {
    balance.save(files[common_name]);
    model.save_common(files[common_name]);
  }
  const fs::path folder = unfinished(next_round);
  fs::create_directories(folder);
  written_ = std::async(std::launch::async, [folder, files = std::move(files)] {
    std::map<std::string, Written> written;
    for (const auto& [name, bytes] : files) {
      write_durably(folder / name, bytes);
      written[name] = {bytes.size(), checksum(bytes)};
    }
    return written;
  });
}

void Checkpoints::finish() {
  if (writing_ < 0) return;
  const std::int64_t round = std::exchange(writing_, -1);
  json own = json::object();
  for (const auto& [name, written] : written_.get())
    own[name] = {{"bytes", written.bytes}, {"xxh3", hex(written.checksum)}};
  const std::string text = own.dump();
  const auto* letters = reinterpret_cast<const std::byte*>(text.data());
  const std::vector<Bytes> all = transport_.gather(0, Bytes(letters, letters + text.size()));
  if (transport_.rank() != 0) return;
  json manifest{{"version", version}, {"run", options_.run}, {"round", round}, {"ranks", transport_.ranks()}};
  for (const Bytes& part : all)
    manifest["files"].update(json::parse(reinterpret_cast<const char*>(part.data()),
                                         reinterpret_cast<const char*>(part.data()) + part.size()));
  manifest["sub_models"] = manifest["files"].size() - 1;
  const std::string page = manifest.dump(1) + "\n";
  const auto* bytes = reinterpret_cast<const std::byte*>(page.data());
  write_durably(unfinished(round) / manifest_name, Bytes(bytes, bytes + page.size()));
  rename_durably(unfinished(round), place("round", round));
  tidy(round);
}

/// The newest of this run stay. Later ones are left from before it began anew: what was written between here and there
/// is written over, so it must not go on from them.
void Checkpoints::tidy(std::int64_t round) const {
  std::size_t kept = 0;
  for (const Made& made : made_by(options_.run, options_.folder)) {
    if (made.round > round)
      rename_durably(made.folder, place("earlier", made.round));
    else if (++kept > options_.keep)
      fs::remove_all(made.folder);
  }
}

std::int64_t Checkpoints::restore(const fs::path& folder, Model& model, Rebalance& balance) {
  std::string problem;
  try {
    const json manifest = read_manifest(folder);
    check_manifest(folder, manifest, model, options_.run);
    read_all(folder, manifest, model, balance, transport_);
    last_round_ = manifest.at("round").get<std::int64_t>();
  } catch (const std::exception& e) {
    problem = e.what() + alternative(folder, options_.run);
  }
  agree(transport_, problem);
  return last_round_;
}

}  // namespace moraine::runtime
