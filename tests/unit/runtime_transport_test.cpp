// SPDX-License-Identifier: Apache-2.0
// Letter boxes: what arrives, what is refused, what is reused.
#include <gtest/gtest.h>

#include <array>

#include "runtime/transport/loopback.hpp"
#include "tests/support/gossip_model.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;

/// 0 tells 1 in "tell", which 1 reads in "move" of the same round.
class Loopback : public testing::Test {
 protected:
  Loopback() : model_(3, {{"tell"}, {"move", 0}}), transport_(true) {
    model_.link(0, 1, 1);
    transport_.begin_epoch(model_);
  }
  void tell(std::int64_t round, char value) {
    const auto byte = static_cast<std::byte>(value);
    transport_.open(0, 0, round).send(1, std::span(&byte, 1));
    transport_.close(0);
  }

  GossipModel model_;
  LoopbackTransport transport_;
};

TEST_F(Loopback, DeliversTwoRoundsSideBySide) {
  tell(0, 'a');
  tell(1, 'b');
  EXPECT_EQ(transport_.open(1, 1, 0).received(0)[0], std::byte{'a'});
  transport_.close(1);
  EXPECT_EQ(transport_.open(1, 1, 1).received(0)[0], std::byte{'b'});
  transport_.close(1);
}

TEST_F(Loopback, WhatIsNotSentArrivesEmpty) {
  tell(0, 'a');
  transport_.open(0, 0, 2);
  transport_.close(0);
  EXPECT_TRUE(transport_.open(1, 1, 2).received(0).empty());
}

TEST_F(Loopback, ReusesItsBuffers) {
  tell(0, 'a');
  const std::byte* buffer = transport_.open(1, 1, 0).received(0).data();
  transport_.close(1);
  tell(2, 'c');
  EXPECT_EQ(transport_.open(1, 1, 2).received(0).data(), buffer);
}

TEST_F(Loopback, NoticesMessagesOfAnotherRound) {
  tell(0, 'a');
  EXPECT_THROW(transport_.open(1, 1, 2).received(0), std::logic_error);
  EXPECT_NO_THROW(transport_.open(1, 1, 0).received(0));
  transport_.close(1);
  EXPECT_THROW(transport_.open(1, 1, 0).received(0), std::logic_error) << "read and destroyed";
}

TEST_F(Loopback, RefusesStrangersAndSecondMessages) {
  Port& port = transport_.open(0, 0, 0);
  EXPECT_THROW(port.send(2, {}), std::logic_error);
  EXPECT_THROW(port.received(1), std::logic_error);
  port.send(1, {});
  EXPECT_THROW(port.send(1, {}), std::logic_error);
}

TEST_F(Loopback, ForgetsAtAnEpochsEnd) {
  tell(0, 'a');
  transport_.begin_epoch(model_);
  EXPECT_THROW(transport_.open(1, 1, 0).received(0), std::logic_error);
}

TEST(LoopbackOfTheRoundBefore, OpensWithNothing) {
  GossipModel model(2, {{"step", 0}});
  model.link(0, 1, 0);
  LoopbackTransport transport;
  transport.begin_epoch(model);
  EXPECT_TRUE(transport.open(1, 0, 0).received(0).empty());
  const std::array<std::byte, 3> bytes{};
  transport.open(0, 0, 0).send(1, bytes);
  transport.close(0);
  EXPECT_EQ(transport.open(1, 0, 1).received(0).size(), 3U);
}

}  // namespace
}  // namespace moraine::runtime
