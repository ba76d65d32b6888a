#include "clients/stream/boards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "clients/stream/feeds.h"
#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/body/points.h"
#include "common/base/units.h"
#include "tests/clients/stream/boards_fixture.h"
#include "tests/clients/stream/made_stage.h"

namespace footing::stream_client {
namespace {

using testing::HasSubstr;

TEST_F(BoardsTest, TwoBoardsAndTheTruePoseAreThereAndHandsWhenAskedFor) {
  auto plan = PlanBoards(options_, {});
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->devices.size(), 2u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kLeftBoard);
  EXPECT_EQ(plan->devices[1].role(), stream::DeviceRole::kRightBoard);
  ASSERT_EQ(plan->feeds.size(), 1u);
  EXPECT_TRUE(plan->feeds[0].reference);
  EXPECT_EQ(plan->duration_s, 0);  // A script again and again.
  options_.hands = "move";
  EXPECT_EQ(PlanBoards(options_, {})->feeds.size(), 2u);
  options_.hands = "wiimote";
  EXPECT_EQ(PlanBoards(options_, {})->devices.size(), 4u);
  options_.hands = "straps";
  const auto strapped = PlanBoards(options_, {});
  ASSERT_EQ(strapped->devices.size(), 6u);
  EXPECT_EQ(strapped->devices[2].role(), stream::DeviceRole::kLeftUpperArm);
  EXPECT_EQ(strapped->devices[5].role(), stream::DeviceRole::kRightForearm);
}

TEST_F(BoardsTest, WhatIsNotThereIsAUsageErrorThatListsWhatIs) {
  options_.hands = "leap";
  EXPECT_THAT(PlanBoards(options_, {}).error().message,
              HasSubstr("none, move, wiimote, straps, kinect, camera"));
  options_.hands = "move";
  options_.lost_hand = "middle";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("left or right"));
  options_.hands = "none";
  options_.lost_hand = "left";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("nothing to lose"));
  options_.lost_hand = "";
  options_.stage.motion = "dance";
  const auto unknown = PlanBoards(options_, {});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message, HasSubstr("demo quiet"));
  options_.stage.motion = "/nonexistent/walk.bvh";
  EXPECT_THAT(PlanBoards(options_, {}).error().message, HasSubstr("/nonexistent/walk.bvh"));
}

TEST_F(BoardsTest, TheBoardsTotalAndCopAreThoseOfTheMotion) {
  const auto stage = MadeStage(options_.stage);
  const auto& scene = stage->scene;
  for (double t_s = 0.05; t_s < stage->duration_s(); t_s += 0.0917) {
    double total_n = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (std::size_t f = 0; f < 2; ++f) {
      const auto load = virtual_sensors::LoadBoard(stage->boards[f], stage->FootAt(f, t_s));
      const auto places = virtual_sensors::SensorPlaces(stage->boards[f]);
      for (std::size_t k = 0; k < 4; ++k) {
        total_n += load.corners_n[k];
        moment += load.corners_n[k] * places[k];
      }
    }
    const auto at = stage->At(t_s);
    const auto between = [&](const auto& columns) {
      return ((1 - at.share) * columns.col(at.frame) + at.share * columns.col(at.frame + 1)).eval();
    };
    EXPECT_NEAR(total_n, between(scene.reaction.force_n).z(), 1e-6) << t_s;
    EXPECT_LT((moment / total_n - between(scene.reaction.cop_m)).norm(), 0.002) << t_s;
  }
  EXPECT_EQ(stage->outside_share, 0);
}

TEST_F(BoardsTest, AScriptGoesOnAndARecordingStaysAtItsEnd) {
  Stage stage = *MadeStage(options_.stage);
  const double end_s = stage.duration_s();
  EXPECT_EQ(stage.At(end_s + 0.305).frame, stage.At(0.305).frame);
  stage.repeats = false;
  EXPECT_EQ(stage.At(end_s + 0.3).frame, stage.scene.motion.frames() - 2);
  EXPECT_EQ(stage.At(end_s + 0.3).share, 1);
  EXPECT_EQ(stage.At(-1).frame, 0);
}

TEST_F(BoardsTest, AScriptThatDoesNotEndInTheTPoseIsPerformedOnce) {
  EXPECT_TRUE(MadeStage(options_.stage)->repeats);
  std::ofstream(path_) << R"({"keys": [{"seconds": 1}, {"seconds": 1, "crouch_m": 0.2}]})";
  EXPECT_FALSE(MadeStage(options_.stage)->repeats);
}

TEST_F(BoardsTest, BoardsLaidUnderWideFeetLieFurtherApart) {
  std::ofstream(path_) << R"({"keys": [{"seconds": 0.5}, {"seconds": 0.8, "weight": -1},
      {"seconds": 0.6, "left_out_m": 0.22}, {"seconds": 0.8, "weight": 1},
      {"seconds": 0.6, "right_out_m": 0.22}, {"seconds": 0.8, "weight": 0}, {"seconds": 9}]})";
  const auto as_always = MadeStage(options_.stage);
  options_.stage.place_boards = true;
  const auto placed = MadeStage(options_.stage);
  EXPECT_DOUBLE_EQ(as_always->gap_m, 0.02);
  EXPECT_GT(as_always->outside_share, 0.5);
  EXPECT_GT(placed->gap_m, 0.05);
  EXPECT_LT(placed->outside_share, 0.3);
  EXPECT_DOUBLE_EQ(placed->boards[0].middle_m.y(), 0.5 * (0.316 + placed->gap_m));
}

TEST_F(BoardsTest, TheReferenceIsTheWholePoseAndFitsIntoAMessage) {
  const auto stage = MadeStage(options_.stage);
  const stream::ReferenceFrame frame = PoseFeed(stage).reference(3.02);
  const auto& skeleton = stage->scene.body.skeleton;
  ASSERT_EQ(static_cast<int>(frame.parents.size()), skeleton.size());
  EXPECT_LE(frame.parents.size(), 64u);
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, stage->scene.motion.q.col(302), at);
  for (std::size_t i = 0; i < frame.parents.size(); ++i) {
    EXPECT_EQ(frame.parents[i], skeleton.joint(static_cast<int>(i)).parent);
    EXPECT_LT((frame.positions_m[i] - at.p_WJ[i]).norm(), 1e-6);
  }
  EXPECT_LT((frame.com_m - body::CentreOfMass(stage->scene.body, at)).norm(), 1e-6);
}

TEST(ShownJoints, OfALargeSkeletonAreThoseOnTheWayToALandmark) {
  body::Body body = *body::MakeBody(body::StandardPerson(1.75), {});
  EXPECT_EQ(static_cast<int>(ShownJoints(body).size()), body.skeleton.size());
  std::vector<body::Joint> joints = body.skeleton.joints;
  for (int i = 0; i < 60; ++i) {
    joints.push_back({});
    joints.back().name = "finger";
    joints.back().parent = body.landmarks[body::Landmark::kLeftWrist];
  }
  body.skeleton = body::MakeSkeleton(std::move(joints));
  const auto shown = ShownJoints(body);
  EXPECT_LE(shown.size(), 64u);
  for (const int landmark : body.landmarks.joint) {
    if (landmark >= 0) {
      EXPECT_THAT(shown, testing::Contains(landmark));
    }
  }
}

TEST_F(BoardsTest, AWiimoteInTheFistFeelsGravityAndTurnsWithTheArm) {
  const auto stage = MadeStage(options_.stage);
  constexpr int kDevices = 8;
  double felt_mps2 = 0;
  for (int device = 0; device < kDevices; ++device) {
    const int side = device % 2;
    SimulatedDevice::WiimoteMotion motion = InFist(stage, side, static_cast<std::uint64_t>(device));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), turned = Eigen::Vector3d::Zero();
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();
    for (int i = 0; i < 270; ++i) {
      const auto felt = motion(0.01 * i);
      if (i < 100) force += 0.01 * felt.specific_force_S_mps2;
      if (i < 100) bias += 0.01 * felt.angular_velocity_S_radps;
      if (i >= 100) turned += 0.01 * (felt.angular_velocity_S_radps - bias);
    }
    felt_mps2 += force.norm() / kDevices;
    // T-pose, buttons up: z of a Wiimote is down; it lies up to 3 x 0.17 rad off.
    EXPECT_LT(force.z(), -kStandardGravityMps2 * std::cos(0.51)) << device;
    // The arm comes down by 80 degrees about the axis ahead, which is the Wiimote's y.
    EXPECT_GT((side == 0 ? -1 : 1) * turned.y(), 80 * kPi / 180 * std::cos(0.51)) << device;
    EXPECT_NEAR(turned.norm(), 80 * kPi / 180, 0.1) << device;
  }
  // 1 % of gain and 0.1 m/s2 of bias: 0.14 for a device, 0.05 for the mean of eight.
  EXPECT_NEAR(felt_mps2, kStandardGravityMps2, 0.15);
}

TEST_F(BoardsTest, ACopyOfAWiimotesMotionBeginsAnew) {
  const SimulatedDevice::WiimoteMotion motion = InFist(MadeStage(options_.stage), 0, 5);
  SimulatedDevice::WiimoteMotion one = motion, other = motion;
  for (int i = 0; i < 5; ++i) one(0.01 * i);
  EXPECT_NE(one(0.05).specific_force_S_mps2, other(0.05).specific_force_S_mps2);
  SimulatedDevice::WiimoteMotion first = motion, again = motion;
  EXPECT_EQ(first(0.1).specific_force_S_mps2, again(0.1).specific_force_S_mps2);
}

}  // namespace
}  // namespace footing::stream_client
