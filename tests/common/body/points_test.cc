#include "common/body/points.h"

#include <gtest/gtest.h>

#include "common/body/kinematics.h"

namespace footing::body {
namespace {

Body Person() { return MakeBody(StandardPerson(1.8), {}).value(); }

TEST(Points, TheFistLiesSixTenthsOfTheHandBeyondTheWrist) {
  const Body person = Person();
  Kinematics at(person.skeleton);
  ComputeKinematics(person.skeleton, TPose(person.skeleton, person.landmarks), at);
  for (int side = 0; side < 2; ++side) {
    const Point fist = Fist(person, side);
    const int end = FindJoint(person.skeleton, side == 0 ? "lhand_end" : "rhand_end");
    ASSERT_GE(end, 0);
    const Eigen::Vector3d wrist = at.p_WJ[static_cast<std::size_t>(fist.joint)];
    const Eigen::Vector3d tip = at.p_WJ[static_cast<std::size_t>(end)];
    const Eigen::Vector3d place = Place(fist, at.R_WJ[static_cast<std::size_t>(fist.joint)], wrist);
    EXPECT_LT((place - (wrist + 0.6 * (tip - wrist))).norm(), 1e-9);
    EXPECT_GT(side == 0 ? place.y() : -place.y(), 0.5);
  }
}

TEST(Points, OfTheFootLieBehindEachOther) {
  const Body person = Person();
  Kinematics at(person.skeleton);
  ComputeKinematics(person.skeleton, TPose(person.skeleton, person.landmarks), at);
  const auto x = [&](const Point& point) {
    return at.p_WJ[static_cast<std::size_t>(point.joint)].x();
  };
  for (int side = 0; side < 2; ++side) {
    EXPECT_GT(x(Toe(person, side)), x(Ankle(person, side)) + 0.05);
    EXPECT_GT(x(ToeEnd(person, side)), x(Toe(person, side)) + 0.02);
  }
}

TEST(Points, WithoutToesTheFootIsItsAnkle) {
  Body person = Person();
  person.landmarks.joint[static_cast<std::size_t>(Landmark::kLeftToe)] = -1;
  person.landmarks.joint[static_cast<std::size_t>(Landmark::kLeftToeEnd)] = -1;
  EXPECT_EQ(Toe(person, 0).joint, Ankle(person, 0).joint);
  EXPECT_EQ(ToeEnd(person, 0).joint, Ankle(person, 0).joint);
  EXPECT_NE(Toe(person, 1).joint, Ankle(person, 1).joint);
}

}  // namespace
}  // namespace footing::body
