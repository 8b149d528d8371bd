// SPDX-License-Identifier: Apache-2.0
// Messages between sub-models of one process.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "runtime/transport/transport.hpp"

namespace moraine::runtime {

/// Two buffers per (stage, from, to), used by turns. Buffers are kept: once they have grown, nothing is allocated.
/// With `poison` a message is destroyed when its receiver closes, so that reading it late is noticed.
class LoopbackTransport final : public Transport {
 public:
  explicit LoopbackTransport(bool poison = false);
  ~LoopbackTransport() override;

  void begin_epoch(Model& model) override;
  Port& open(SubModelId sub_model, int stage, std::int64_t round) override;
  void close(SubModelId sub_model) override;

 private:
  class Box;
  struct alignas(64) Slot {
    MessageHeader header;
    bool sent = false;
    std::vector<std::byte> bytes;
  };
  /// One message of the plan, with both of its slots.
  using Link = std::array<Slot, 2>;

  std::size_t node(SubModelId sub_model, int stage) const;
  void lay_out(Model& model);

  bool poison_;
  std::size_t stages_ = 0;
  std::vector<int> receives_;              ///< per stage
  std::vector<Link> links_;                ///< in the order of plan_messages()
  std::vector<std::size_t> first_out_;     ///< per node, into links_ and to_
  std::vector<SubModelId> to_;             ///< per link
  std::vector<std::size_t> first_in_;      ///< per node, into in_ and from_
  std::vector<std::size_t> in_;            ///< links by receiving node, ascending by sender
  std::vector<SubModelId> from_;           ///< per entry of in_
  std::vector<std::unique_ptr<Box>> box_;  ///< per sub-model
};

}  // namespace moraine::runtime
