#include "common/guide/recent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/board/layout.h"

namespace footing::guide {
namespace {

Load Standing(double force_n, double cop_x_m, double cop_y_m) {
  Load load;
  load.samples = 60;
  load.mean_n = force_n;
  load.cop_valid = force_n > 49;
  load.cop_x_m = cop_x_m;
  load.cop_y_m = cop_y_m;
  return load;
}

/// In the plate frame of a board of this yaw: a point given by its distance forward and to the left
/// of the plate's middle. The inverse of board::InWorld, written out by hand for each quarter turn.
Load At(double force_n, double yaw_rad, double forward_m, double left_m) {
  if (yaw_rad == 0) return Standing(force_n, -left_m, forward_m);
  if (yaw_rad < 0) return Standing(force_n, -forward_m, -left_m);  // Front to the right.
  if (yaw_rad < 2) return Standing(force_n, forward_m, left_m);    // Front to the left.
  return Standing(force_n, left_m, -forward_m);                    // Front to the rear.
}

/// Somebody does as asked on two boards that lie at these yaws in truth.
LayoutObserved PersonOnBoards(double left_yaw_rad, double right_yaw_rad, double lean_m = 0.05) {
  LayoutObserved observed;
  observed.left_alone = Stance{At(700, left_yaw_rad, 0, 0), Standing(2, 0, 0)};
  observed.right_alone = Stance{Standing(3, 0, 0), At(700, right_yaw_rad, 0, 0)};
  observed.upright = {At(350, left_yaw_rad, 0.01, 0), At(350, right_yaw_rad, 0.01, 0)};
  observed.forward = {At(350, left_yaw_rad, 0.01 + lean_m, 0.002),
                      At(350, right_yaw_rad, 0.01 + lean_m, -0.004)};
  return observed;
}

const stream::BoardLayout kOneFootEach = *board::LayoutNamed("one_foot_each", 20);
constexpr double kOut = kPi / 2;

TEST(Layout, PassesWhenTheBoardsLieAsTheyShould) {
  const LayoutVerdict verdict = CheckLayout(kOneFootEach, PersonOnBoards(-kOut, kOut));
  EXPECT_TRUE(verdict.passed()) << verdict.note;
  EXPECT_NEAR(verdict.residual_mm, 4, 1e-6);
  EXPECT_NEAR(verdict.rest_n, 3, 1e-9);
  EXPECT_TRUE(CheckLayout(*board::LayoutNamed("side_by_side", 20), PersonOnBoards(0, 0)).passed());
}

TEST(Layout, TellsATurnedBoardAndWhichOne) {
  EXPECT_EQ(CheckLayout(kOneFootEach, PersonOnBoards(kOut, kOut)).fault, LayoutFault::kLeftTurned);
  EXPECT_EQ(CheckLayout(kOneFootEach, PersonOnBoards(-kOut, -kOut)).fault,
            LayoutFault::kRightTurned);
  EXPECT_EQ(CheckLayout(kOneFootEach, PersonOnBoards(kOut, -kOut)).fault, LayoutFault::kBothTurned);
  EXPECT_NE(CheckLayout(kOneFootEach, PersonOnBoards(kOut, kOut)).note.find("half a turn"),
            std::string::npos);
}

TEST(Layout, TellsAQuarterTurn) {
  const LayoutVerdict verdict = CheckLayout(kOneFootEach, PersonOnBoards(0, kOut));
  EXPECT_EQ(verdict.fault, LayoutFault::kLeftTurned);
  EXPECT_NE(verdict.note.find("quarter"), std::string::npos) << verdict.note;
}

TEST(Layout, TellsSwappedBoards) {
  LayoutObserved observed = PersonOnBoards(-kOut, kOut);
  std::swap(observed.left_alone->left, observed.left_alone->right);
  std::swap(observed.right_alone->left, observed.right_alone->right);
  EXPECT_EQ(CheckLayout(kOneFootEach, observed).fault, LayoutFault::kSwapped);
}

TEST(Layout, TakesNoLeanForNoVerdict) {
  EXPECT_EQ(CheckLayout(kOneFootEach, PersonOnBoards(-kOut, kOut, 0.005)).fault,
            LayoutFault::kNoContact);
}

TEST(Layout, TellsABoardThatFeelsNobody) {
  LayoutObserved observed = PersonOnBoards(-kOut, kOut);
  observed.right_alone->right = Standing(10, 0, 0);
  observed.right_alone->left = Standing(5, 0, 0);
  EXPECT_EQ(CheckLayout(kOneFootEach, observed).fault, LayoutFault::kNoContact);
  observed = PersonOnBoards(-kOut, kOut);
  observed.forward.right = Standing(20, 0, 0);
  EXPECT_EQ(CheckLayout(kOneFootEach, observed).fault, LayoutFault::kNoContact);
}

TEST(Layout, ChecksASingleBoardByTheLeanAlone) {
  LayoutObserved observed;
  observed.upright.left = At(700, 0, 0, 0);
  observed.forward.left = At(700, 0, 0.06, 0.001);
  const auto single = *board::LayoutNamed("single", 0);
  const LayoutVerdict right_way = CheckLayout(single, observed);
  EXPECT_TRUE(right_way.passed()) << right_way.note;
  EXPECT_TRUE(right_way.degraded);
  observed.forward.left = At(700, 0, -0.06, 0);
  EXPECT_EQ(CheckLayout(single, observed).fault, LayoutFault::kLeftTurned);
}

TEST(Layout, EveryPresetHasAPicture) {
  for (const char* preset : {"one_foot_each", "side_by_side", "single"}) {
    EXPECT_NE(LayoutPicture(preset).find("screen"), std::string::npos) << preset;
  }
  EXPECT_EQ(LayoutPicture("heap"), "");
}

}  // namespace
}  // namespace footing::guide
