// SPDX-License-Identifier: Apache-2.0
#include "runtime/transport/envelope.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstring>

namespace moraine::runtime {
namespace {

enum class Kind : std::uint32_t { message, failure };

/// What stands before the content. Ranks of one run are of one machine kind and one program.
struct MessageHead {
  std::uint32_t version = 2;
  Kind kind = Kind::message;
  std::uint64_t length = 0;
  std::uint64_t checksum = 0;  ///< of the content
  std::int32_t stage = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t unused = 0;
  std::int64_t round = 0;
  std::int64_t epoch = 0;
  double sent_at = 0;
};

Bytes join(const MessageHead& head, std::span<const std::byte> content) {
  Bytes out(sizeof head + content.size());
  std::memcpy(out.data(), &head, sizeof head);
  if (!content.empty()) std::memcpy(out.data() + sizeof head, content.data(), content.size());
  return out;
}

[[noreturn]] void refuse(const Parcel& parcel, const char* why) {
  throw std::runtime_error(fmt::format("a message from rank {} {}", parcel.from, why));
}

}  // namespace

Bytes pack(const Envelope& e, double sent_at, std::span<const std::byte> content) {
  MessageHead head;
  head.length = content.size();
  head.checksum = XXH3_64bits(content.data(), content.size());
  head.stage = e.stage;
  head.from = e.from;
  head.to = e.to;
  head.round = e.round;
  head.epoch = e.epoch;
  head.sent_at = sent_at;
  return join(head, content);
}

Bytes pack_failure() {
  MessageHead head;
  head.kind = Kind::failure;
  return join(head, {});
}

Opened unpack(const Parcel& parcel) {
  MessageHead head;
  if (parcel.bytes.size() < sizeof head) refuse(parcel, "is too short");
  std::memcpy(&head, parcel.bytes.data(), sizeof head);
  if (head.version != MessageHead{}.version) refuse(parcel, "is of another version of this program");
  if (head.kind == Kind::failure) throw FailedElsewhere(fmt::format("rank {} has failed", parcel.from));
  const auto content = std::span(parcel.bytes).subspan(sizeof head);
  if (content.size() != head.length || XXH3_64bits(content.data(), content.size()) != head.checksum)
    refuse(parcel, "is damaged");
  return {{head.stage, head.from, head.to, head.round, head.epoch}, head.sent_at, content};
}

}  // namespace moraine::runtime
