// SPDX-License-Identifier: Apache-2.0
// Letter boxes: what arrives, what is refused, what is reused.
#include <gtest/gtest.h>

#include <array>

#include "runtime/transport/mail.hpp"
#include "tests/support/gossip_model.hpp"

namespace moraine::runtime {
namespace {

using test::GossipModel;

/// 0 tells 1 in "tell", which 1 reads in "move" of the same round.
class LetterBox : public testing::Test {
 protected:
  LetterBox() : model_(3, {{"tell"}, {"move", 0}}), mail_(alone(), true) {
    model_.link(0, 1, 1);
    mail_.begin_epoch(model_, {0, 9});
  }
  void tell(std::int64_t round, char value) {
    const auto byte = static_cast<std::byte>(value);
    mail_.open(0, 0, round).send(1, std::span(&byte, 1));
    mail_.close(0);
  }

  GossipModel model_;
  Mail mail_;
};

TEST_F(LetterBox, DeliversTwoRoundsSideBySide) {
  tell(0, 'a');
  tell(1, 'b');
  EXPECT_EQ(mail_.open(1, 1, 0).received(0)[0], std::byte{'a'});
  mail_.close(1);
  EXPECT_EQ(mail_.open(1, 1, 1).received(0)[0], std::byte{'b'});
  mail_.close(1);
}

TEST_F(LetterBox, WhatIsNotSentArrivesEmpty) {
  tell(0, 'a');
  mail_.open(0, 0, 2);
  mail_.close(0);
  EXPECT_TRUE(mail_.open(1, 1, 2).received(0).empty());
}

TEST_F(LetterBox, ReusesItsBuffers) {
  tell(0, 'a');
  const std::byte* buffer = mail_.open(1, 1, 0).received(0).data();
  mail_.close(1);
  tell(2, 'c');
  EXPECT_EQ(mail_.open(1, 1, 2).received(0).data(), buffer);
}

TEST_F(LetterBox, NoticesMessagesOfAnotherRound) {
  tell(0, 'a');
  EXPECT_THROW(mail_.open(1, 1, 2).received(0), std::logic_error);
  EXPECT_NO_THROW(mail_.open(1, 1, 0).received(0));
  mail_.close(1);
  EXPECT_THROW(mail_.open(1, 1, 0).received(0), std::logic_error) << "read and destroyed";
}

TEST_F(LetterBox, RefusesStrangersAndSecondMessages) {
  Port& port = mail_.open(0, 0, 0);
  EXPECT_THROW(port.send(2, {}), std::logic_error);
  EXPECT_THROW(port.received(1), std::logic_error);
  port.send(1, {});
  EXPECT_THROW(port.send(1, {}), std::logic_error);
}

TEST_F(LetterBox, ForgetsAtAnEpochsEnd) {
  tell(0, 'a');
  mail_.begin_epoch(model_, {0, 9});
  EXPECT_THROW(mail_.open(1, 1, 0).received(0), std::logic_error);
}

TEST(LetterBoxOfTheRoundBefore, OpensWithNothing) {
  GossipModel model(2, {{"step", 0}});
  model.link(0, 1, 0);
  Mail mail;
  mail.begin_epoch(model, {0, 9});
  EXPECT_TRUE(mail.open(1, 0, 0).received(0).empty());
  const std::array<std::byte, 3> bytes{};
  mail.open(0, 0, 0).send(1, bytes);
  mail.close(0);
  EXPECT_EQ(mail.open(1, 0, 1).received(0).size(), 3U);
}

}  // namespace
}  // namespace moraine::runtime
