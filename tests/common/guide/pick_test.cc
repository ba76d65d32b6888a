#include "common/guide/device_steps.h"

#include <gtest/gtest.h>

namespace footing::guide {
namespace {

BoardLoad Board(std::uint32_t device, double force_n) {
  Load load;
  load.samples = 60;
  load.mean_n = force_n;
  return {device, load};
}

DeviceMotion Hand(std::uint32_t device, double shake_mps2) {
  Motion motion;
  motion.samples = 100;
  motion.shake_mps2 = shake_mps2;
  return {device, motion};
}

TEST(Pick, TakesTheBoardThatIsStoodOn) {
  const Pick pick = WhichBoard({Board(3, 4), Board(7, 640)});
  EXPECT_EQ(pick.kind, Pick::Kind::kOne);
  EXPECT_EQ(pick.device, 7u);
}

TEST(Pick, AsksAgainWhenBothBoardsCarryLoad) {
  const Pick pick = WhichBoard({Board(3, 310), Board(7, 330)});
  EXPECT_EQ(pick.kind, Pick::Kind::kAmbiguous);
  EXPECT_NE(pick.note.find("stand on one alone"), std::string::npos);
}

TEST(Pick, TakesNoBoardForABagPutDown) {
  EXPECT_EQ(WhichBoard({Board(3, 40), Board(7, 2)}).kind, Pick::Kind::kNone);
  EXPECT_EQ(WhichBoard({}).kind, Pick::Kind::kNone);
}

TEST(Pick, TakesTheOneThatIsShaken) {
  const Pick pick = WhichShaken({Hand(1, 12), Hand(2, 0.3)});
  EXPECT_EQ(pick.kind, Pick::Kind::kOne);
  EXPECT_EQ(pick.device, 1u);
  EXPECT_NEAR(pick.lead, 12 / 0.3, 1e-9);
}

TEST(Pick, NeverGuessesBetweenTwoThatMove) {
  EXPECT_EQ(WhichShaken({Hand(1, 12), Hand(2, 9)}).kind, Pick::Kind::kAmbiguous);
  // 2.5 times is the least lead.
  EXPECT_EQ(WhichShaken({Hand(1, 12), Hand(2, 12 / 2.4)}).kind, Pick::Kind::kAmbiguous);
  EXPECT_EQ(WhichShaken({Hand(1, 12), Hand(2, 12 / 2.6)}).kind, Pick::Kind::kOne);
}

TEST(Pick, TakesNothingWhileAllHangStill) {
  EXPECT_EQ(WhichShaken({Hand(1, 0.4), Hand(2, 0.2)}).kind, Pick::Kind::kNone);
}

TEST(Pick, LeavesOutDevicesThatSendNothing) {
  EXPECT_EQ(WhichShaken({{1, Motion{}}}).kind, Pick::Kind::kNone);
  EXPECT_EQ(WhichBoard({{1, Load{}}}).kind, Pick::Kind::kNone);
}

}  // namespace
}  // namespace footing::guide
