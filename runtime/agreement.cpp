// SPDX-License-Identifier: Apache-2.0
#include "runtime/agreement.hpp"

#include <tuple>

#include "runtime/records.hpp"

namespace moraine::runtime {
namespace {

struct Plain {
  std::int32_t rank, status;
  std::uint64_t sub_model;
  std::int64_t number, in_epoch;
};

std::vector<char> letters(const std::string& s) { return {s.begin(), s.end()}; }

std::string word(std::span<const std::byte>& in) {
  const auto chars = read_records<char>(in);
  return {chars.begin(), chars.end()};
}

Bytes written(const Failure& f) {
  Bytes out;
  write_records(out, std::vector{Plain{f.rank, f.status, f.sub_model, f.round.number, f.round.in_epoch}});
  write_records(out, letters(f.stage));
  write_records(out, letters(f.text));
  return out;
}

Failure read(std::span<const std::byte> in) {
  const Plain p = read_records<Plain>(in).at(0);
  Failure f{p.rank, {}, static_cast<SubModelId>(p.sub_model), {p.number, p.in_epoch}, {}, p.status};
  f.stage = word(in);
  f.text = word(in);
  return f;
}

bool earlier(const Failure& a, const Failure& b) {
  return std::tie(a.round.in_epoch, a.sub_model, a.rank) < std::tie(b.round.in_epoch, b.sub_model, b.rank);
}

}  // namespace

std::optional<RunError> first_failure(Transport& transport, const std::optional<RunError>& own) {
  if (transport.ranks() == 1) return own;
  std::optional<Failure> first;
  for (const Bytes& told : transport.all_gather(own ? written(own->failure()) : Bytes{})) {
    if (told.empty()) continue;
    Failure failure = read(told);
    if (!first || earlier(failure, *first)) first = std::move(failure);
  }
  if (!first) return std::nullopt;
  const bool mine = own && first->rank == transport.rank();
  return RunError(*first, mine ? own->cause() : nullptr);
}

}  // namespace moraine::runtime
