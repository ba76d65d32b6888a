#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "clients/skeleton/tracking/decoder.h"
#include "common/base/osc.h"

namespace footing::skeleton {
namespace {

std::vector<Decoded> Decode(Decoder& decoder, const std::vector<std::string>& messages) {
  const std::string bundle = osc::WriteBundle({}, messages);
  osc::Packet packet;
  EXPECT_TRUE(osc::Read(osc::AsBytes(bundle), packet));
  std::vector<Decoded> complete;
  decoder.Take(packet, 100, complete);
  return complete;
}

std::string LeftHand() {
  const std::vector<osc::Argument> joint{"l_hand", -0.5f, 0.25f, 2.0f, 0.75f};
  return osc::WriteMessage("/footing/joint", joint);
}

TEST(FootingDialect, TheSequenceMayHave32Bits) {
  // Processing, Max and python-osc write integers of 32 bits.
  Decoder decoder({});
  const std::vector<osc::Argument> head{std::int32_t{7}, std::int32_t{3}};
  const auto complete = Decode(decoder, {osc::WriteMessage("/footing/skeleton", head), LeftHand()});
  ASSERT_EQ(complete.size(), 1u);
  EXPECT_EQ(complete[0].skeleton.sequence, 7);
  EXPECT_EQ(complete[0].skeleton.user, 3);
  EXPECT_EQ(decoder.counts().unknown, 0u);
}

TEST(FootingDialect, OtherTypesAreAnsweredWithTheRightOnes) {
  Decoder decoder({});
  const std::vector<osc::Argument> head{7.0f, std::int32_t{3}};
  Decode(decoder, {osc::WriteMessage("/footing/skeleton", head), LeftHand()});
  EXPECT_EQ(decoder.counts().unknown, 1u);
  EXPECT_THAT(decoder.TakeProblems(),
              testing::ElementsAre(testing::HasSubstr("/footing/skeleton ,hi or ,ii")));
}

}  // namespace
}  // namespace footing::skeleton
