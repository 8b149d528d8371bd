// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/trace_file.hpp"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <tuple>

#include "runtime/trace/settings_text.hpp"

namespace moraine::runtime {

enum class TraceWriter::Kind : std::uint32_t { settings, lists, end };

namespace {

constexpr char magic[8] = {'M', 'O', 'R', 'T', 'R', 'A', 'C', 'E'};
constexpr std::uint32_t version = 2;

struct FileHead {
  char word[8];
  std::uint32_t version;
  std::uint32_t unused;
};

struct BlockHead {
  std::uint32_t kind;
  std::uint32_t unused;
  std::uint64_t length;
  std::uint64_t checksum;  ///< XXH3-64 of the content
};

/// Calls f for every list, always in the same order.
template <class Lists, class Function>
void each_list(Lists& lists, const Function& f) {
  f(lists.tasks);
  f(lists.phases);
  f(lists.epochs);
  f(lists.owners);
  f(lists.costs);
  f(lists.messages);
  f(lists.balance);
  f(lists.moves);
}

struct ListHead {
  std::uint64_t records;
  std::uint64_t record_size;
};

/// Equal bytes of all records side by side compress far better than record after record.
template <class Record>
void put_columns(std::vector<std::byte>& out, const std::vector<Record>& records) {
  static_assert(std::is_trivially_copyable_v<Record>);
  const ListHead head{records.size(), sizeof(Record)};
  const auto words = std::as_bytes(std::span(&head, 1));
  out.insert(out.end(), words.begin(), words.end());
  const std::size_t at = out.size(), n = records.size();
  out.resize(at + n * sizeof(Record));
  const auto* bytes = reinterpret_cast<const std::byte*>(records.data());
  for (std::size_t column = 0; column < sizeof(Record); ++column)
    for (std::size_t i = 0; i < n; ++i) out[at + column * n + i] = bytes[i * sizeof(Record) + column];
}

template <class Record>
void take_columns(std::span<const std::byte>& in, std::vector<Record>& records) {
  ListHead head{};
  if (in.size() < sizeof head) throw TraceError("a list of the trace is cut short");
  std::memcpy(&head, in.data(), sizeof head);
  in = in.subspan(sizeof head);
  if (head.record_size != sizeof(Record) || head.records > in.size() / sizeof(Record))
    throw TraceError("a list of the trace has records of another size than expected");
  const std::size_t n = head.records, before = records.size();
  records.resize(before + n);
  auto* bytes = reinterpret_cast<std::byte*>(records.data() + before);
  for (std::size_t column = 0; column < sizeof(Record); ++column)
    for (std::size_t i = 0; i < n; ++i) bytes[i * sizeof(Record) + column] = in[column * n + i];
  in = in.subspan(n * sizeof(Record));
}

}  // namespace

std::vector<std::byte> pack(const TraceLists& lists) {
  std::vector<std::byte> plain;
  each_list(lists, [&](const auto& list) { put_columns(plain, list); });
  std::vector<std::byte> packed(ZSTD_compressBound(plain.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 1);
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  packed.resize(size);
  return packed;
}

void unpack(std::span<const std::byte> packed, TraceLists& lists) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    throw TraceError("a block of the trace is not compressed as expected");
  std::vector<std::byte> plain(size);
  const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size());
  if (ZSTD_isError(got)) throw TraceError(fmt::format("a block of the trace is damaged: {}", ZSTD_getErrorName(got)));
  std::span<const std::byte> in(plain);
  each_list(lists, [&](auto& list) { take_columns(in, list); });
}

TraceWriter::TraceWriter(const std::filesystem::path& file, const TraceSettings& settings)
    : path_(file), file_(file, std::ios::binary | std::ios::trunc) {
  FileHead head{{}, version, 0};
  std::copy(std::begin(magic), std::end(magic), head.word);
  file_.write(reinterpret_cast<const char*>(&head), sizeof head);
  const std::string text = settings_text(settings);
  write(Kind::settings, std::as_bytes(std::span(text)));
}

void TraceWriter::append(std::span<const std::byte> packed) { write(Kind::lists, packed); }

void TraceWriter::finish() { write(Kind::end, {}); }

void TraceWriter::write(Kind kind, std::span<const std::byte> content) {
  const BlockHead head{static_cast<std::uint32_t>(kind), 0, content.size(),
                       XXH3_64bits(content.data(), content.size())};
  file_.write(reinterpret_cast<const char*>(&head), sizeof head);
  file_.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
  file_.flush();
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot write the trace", path_.string()));
}

/// Blocks of a file, as far as they are whole.
class TraceReader {
 public:
  explicit TraceReader(const std::filesystem::path& file) : path_(file), file_(file, std::ios::binary) {
    if (!file_) refuse("cannot be read");
    left_ = std::filesystem::file_size(file);
    FileHead head{};
    if (!take(&head, sizeof head) || !std::equal(std::begin(magic), std::end(magic), head.word))
      refuse("is not a trace, expected a file that 'moraine run --trace' wrote");
    if (head.version != version)
      refuse(fmt::format("is a trace of version {}, expected version {}", head.version, version));
  }

  Trace read() {
    Trace trace;
    trace.complete = false;
    bool known = false;
    for (BlockHead head{}; take(&head, sizeof head) && head.length <= left_;) {
      content_.resize(head.length);
      take(content_.data(), content_.size());
      if (XXH3_64bits(content_.data(), content_.size()) != head.checksum) refuse("is damaged: a checksum is wrong");
      known = known || head.kind == static_cast<std::uint32_t>(TraceWriter::Kind::settings);
      add(static_cast<TraceWriter::Kind>(head.kind), trace);
    }
    if (!known) refuse("is damaged: it ends before its settings");
    sort(trace.lists);
    return trace;
  }

 private:
  void add(TraceWriter::Kind kind, Trace& trace) {
    trace.complete = kind == TraceWriter::Kind::end;
    if (trace.complete) return;
    if (kind == TraceWriter::Kind::settings)
      trace.settings = read_settings({reinterpret_cast<const char*>(content_.data()), content_.size()});
    else if (kind == TraceWriter::Kind::lists)
      unpack(content_, trace.lists);
    else
      refuse("is damaged: it holds a block of an unknown kind");
  }

  bool take(void* to, std::size_t size) {
    if (size > left_) return false;
    file_.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
    left_ -= size;
    return static_cast<bool>(file_);
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw TraceError(fmt::format("{}: {}", path_.string(), why));
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::uintmax_t left_ = 0;
  std::vector<std::byte> content_;
};

Trace read_trace_file(const std::filesystem::path& file) { return TraceReader(file).read(); }

void sort(TraceLists& lists) {
  const auto by = [](auto& list, const auto& key) {
    std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  };
  by(lists.tasks, [](const TaskRecord& t) { return std::tuple(t.rank, t.worker, t.start); });
  by(lists.phases, [](const PhaseRecord& p) { return std::tuple(p.rank, p.start); });
  by(lists.epochs, [](const EpochRecord& e) { return e.epoch; });
  by(lists.owners, [](const OwnerRecord& o) { return std::tuple(o.epoch, o.sub_model); });
  by(lists.costs, [](const CostRecord& c) { return std::tuple(c.epoch, c.sub_model, c.stage); });
  by(lists.messages, [](const MessageRecord& m) { return std::tuple(m.epoch, m.from, m.sent_in, m.to); });
  by(lists.balance, [](const BalanceRoundRecord& b) { return b.epoch; });
  by(lists.moves, [](const MoveRecord& m) { return std::tuple(m.epoch, m.sub_model); });
}

}  // namespace moraine::runtime
