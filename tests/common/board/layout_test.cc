#include "common/board/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/board/geometry.h"

namespace footing::board {
namespace {

using testing::HasSubstr;

constexpr double kHalfTurn = 3.14159265358979;

stream::BoardLayout SideBySide() {
  stream::BoardLayout layout;
  layout.preset = "side_by_side";
  layout.gap_mm = 30;
  layout.left.y_m = (0.511 + 0.030) / 2;
  layout.right.y_m = -layout.left.y_m;
  return layout;
}

TEST(BoardLayout, ThePresetsAreSound) {
  EXPECT_EQ(Problem(SideBySide()), "");
  stream::BoardLayout one_foot_each;
  one_foot_each.preset = "one_foot_each";
  one_foot_each.left = {0, 0.316 / 2, -kHalfTurn / 2};
  one_foot_each.right = {0, -0.316 / 2, kHalfTurn / 2};
  EXPECT_EQ(Problem(one_foot_each), "");
  stream::BoardLayout single;
  single.preset = "single";
  EXPECT_EQ(Problem(single), "");
}

TEST(BoardLayout, OneFootEachHasItsCentres168MillimetresFromTheMiddle) {
  const auto layout = LayoutNamed("one_foot_each", 20);
  EXPECT_NEAR(layout->left.y_m, (0.316 + 0.02) / 2, 1e-12);
  EXPECT_NEAR(layout->right.y_m, -0.168, 1e-12);
  EXPECT_FALSE(LayoutNamed("in_a_row", 20));
  EXPECT_EQ(Problem(*layout), "");
}

TEST(BoardLayout, PowerButtonsPointOutwardsWithOneFootEach) {
  // The button is on the plate's rear edge.
  const stream::BoardLayout layout = DefaultLayout();
  EXPECT_NEAR(InWorld(layout.left, 0, -0.158).y(), 0.168 + 0.158, 1e-12);
  EXPECT_NEAR(InWorld(layout.right, 0, -0.158).y(), -0.168 - 0.158, 1e-12);
  EXPECT_NEAR(InWorld(layout.left, 0, -0.158).x(), 0, 1e-12);
}

TEST(BoardLayout, SideBySideHasTheFrontEdgeForward) {
  const auto layout = LayoutNamed("side_by_side", 20);
  EXPECT_NEAR(InWorld(layout->left, 0, 0.1).x(), 0.1, 1e-12);
  EXPECT_NEAR(InWorld(layout->left, 0.1, 0).y(), 0.2655 - 0.1, 1e-12);
}

TEST(BoardLayout, WithoutAPresetTheBoardsLieByDefaultWithThePublishedGeometry) {
  stream::BoardLayout published;
  published.rig = "one";
  published.left_geometry = stream::BoardGeometry{0.511, 0.316, 0.8, 0.4};
  const stream::BoardLayout layout = LayoutOr(published);
  EXPECT_EQ(layout.preset, "one_foot_each");
  EXPECT_EQ(layout.rig, "one");
  EXPECT_NEAR(layout.left.y_m, 0.168, 1e-12);
  EXPECT_EQ(layout.left_geometry, published.left_geometry);
  published.preset = "custom";
  published.left.x_m = 1;
  EXPECT_EQ(LayoutOr(published).left.x_m, 1);
}

TEST(BoardLayout, TheGapIsBetweenTheFacingEdges) {
  // Turned by a quarter, a board is 316 mm wide and no longer 511 mm: 97.5 mm more on its side.
  auto layout = SideBySide();
  layout.left.yaw_rad = kHalfTurn / 2;
  EXPECT_NEAR(GapM(layout.left, layout.right), 0.030 + (0.511 - 0.316) / 2, 1e-9);
  EXPECT_THAT(Problem(layout), HasSubstr("the poses leave 12"));
  layout.gap_mm = 128;
  layout.preset = "custom";
  EXPECT_EQ(Problem(layout), "");
  // One before the other: the edges across face each other.
  EXPECT_NEAR(GapM({0, 0, 0}, {0.5, 0, 0}), 0.5 - 0.316, 1e-9);
}

TEST(BoardLayout, WhatCannotBeIsNamed) {
  auto swapped = SideBySide();
  std::swap(swapped.left, swapped.right);
  EXPECT_THAT(Problem(swapped), HasSubstr("exchange"));
  auto overlapping = SideBySide();
  overlapping.left.y_m -= 0.1;
  EXPECT_THAT(Problem(overlapping), HasSubstr("overlap by 70 mm"));
  auto unknown = SideBySide();
  unknown.preset = "round";
  EXPECT_THAT(Problem(unknown), HasSubstr("there are one_foot_each"));
  for (const double bad : {std::nan(""), HUGE_VAL, 50.0}) {
    auto far = SideBySide();
    far.right.x_m = bad;
    EXPECT_THAT(Problem(far), HasSubstr("within 5 m"));
    auto gap = SideBySide();
    gap.gap_mm = -bad;
    EXPECT_THAT(Problem(gap), HasSubstr("gap_mm must be"));
  }
}

}  // namespace
}  // namespace footing::board
