#include "common/net/message_parser.h"

#include <gtest/gtest.h>

#include <string>

namespace footing::transport {
namespace {

std::string TickOf(int samples) {
  v1::Envelope message;
  message.mutable_tick()->set_sequence(7);
  for (int i = 0; i < samples; ++i) message.mutable_tick()->mutable_motion()->add_samples();
  return message.SerializeAsString();
}

std::string GapFrom(std::uint64_t sequence) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(sequence);
  return message.SerializeAsString();
}

TEST(MessageParser, AMessageHasNothingOfTheOneBefore) {
  for (const bool discarded : {false, true}) {
    MessageParser parser;
    const v1::Envelope* message = parser.Parse(TickOf(3));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 3);
    if (discarded) parser.Discard();
    message = parser.Parse(TickOf(2));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 2);
    if (discarded) parser.Discard();
    message = parser.Parse(GapFrom(5));
    ASSERT_NE(message, nullptr);
    EXPECT_FALSE(message->has_tick());
    EXPECT_EQ(message->gap().from_sequence(), 5u);
    if (discarded) parser.Discard();
    message = parser.Parse("");
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->body_case(), v1::Envelope::BODY_NOT_SET);
  }
}

TEST(MessageParser, GoesOnBehindBytesThatAreNoMessage) {
  MessageParser parser;
  EXPECT_EQ(parser.Parse(TickOf(3).substr(0, 6)), nullptr);
  const v1::Envelope* const message = parser.Parse(GapFrom(5));
  ASSERT_NE(message, nullptr);
  EXPECT_FALSE(message->has_tick());
  EXPECT_EQ(message->gap().from_sequence(), 5u);
}

TEST(MessageParser, TakesMessagesLongerThanItsBlock) {
  MessageParser parser;
  for (int round = 0; round < 3; ++round) {
    const v1::Envelope* const message = parser.Parse(TickOf(5000));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 5000);
    if (round == 1) parser.Discard();
  }
}

}  // namespace
}  // namespace footing::transport
