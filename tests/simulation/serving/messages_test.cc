#include "daemon/simulation/serving/messages.h"

#include <gtest/gtest.h>

namespace footing::serving {
namespace {

TEST(Messages, ASkeletonIsThatOfTheCharacterInTheFrames) {
  const v1::Skeletons skeletons = MakeSkeletons("world", {});
  const v1::CharacterFrame frame = MakeFrame({}, "world", "main");
  ASSERT_EQ(skeletons.skeletons_size(), 1);
  ASSERT_EQ(frame.characters_size(), 1);
  EXPECT_EQ(skeletons.skeletons(0).character(), frame.characters(0).character());
  EXPECT_EQ(frame.characters(0).character(), MakeEvent(v1::Event::KIND_RESPONSE, 1).character());
}

TEST(Messages, ACommandForACharacterThatThereIsNotIsRefused) {
  v1::Command push;
  for (const std::uint32_t number : {0u, 1u}) {
    push.mutable_push()->set_character(number);
    EXPECT_FALSE(RefuseOtherCharacter(push).has_value()) << number;
  }
  push.mutable_push()->set_character(2);
  const auto refusal = RefuseOtherCharacter(push);
  ASSERT_TRUE(refusal.has_value());
  EXPECT_FALSE(refusal->ok());
  EXPECT_EQ(refusal->message(), "push: character 2 does not exist; this server has character 1");
  v1::Command append;
  append.mutable_append_segment()->set_length_m(2);  // Names no character.
  EXPECT_FALSE(RefuseOtherCharacter(append).has_value());
  EXPECT_FALSE(RefuseOtherCharacter({}).has_value());
}

}  // namespace
}  // namespace footing::serving
