#include "daemon/simulation/pose_service/pose_sensors.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/base/units.h"
#include "tests/simulation/pose_service/pose_ticks.h"

namespace footing::pose_service {
namespace {

constexpr std::int64_t kStartNs = 5'000'000'000;

struct PoseSensorsTest : testing::Test {
  /// What the engine is told after a tick.
  const PoseInputs& After(const v1::Tick& tick, double at_s = 0) {
    sensors.OnTick(tick, kStartNs + SecondsToNanoseconds(at_s));
    inputs.Refresh();
    return inputs.Front();
  }
  static v1::Tick Boards(const std::array<double, 4>& left_n,
                         const std::array<double, 4>& right_n) {
    v1::Tick tick;
    AddBoard(tick, kLeftDevice, left_n);
    AddBoard(tick, kRightDevice, right_n);
    return tick;
  }

  exchange::Latest<PoseInputs> inputs;
  PoseSensors sensors{"", inputs};
};

TEST_F(PoseSensorsTest, EachBoardIsTheFootOfItsRole) {
  After(StatusTick());
  EXPECT_EQ(sensors.rig(), "one");
  const PoseInputs& told = After(Boards({1, 2, 3, 4}, {5, 6, 7, 8}));
  EXPECT_TRUE(told.sensors.loads.feet[0].valid);
  EXPECT_TRUE(told.sensors.loads.feet[1].valid);
  EXPECT_EQ(told.sensors.loads.feet[0].cells[1].load_n, 2);
  EXPECT_EQ(told.sensors.loads.feet[1].cells[3].load_n, 8);
}

TEST_F(PoseSensorsTest, BoardsThatNobodyLaidOutLieOneFootEachWithTheirButtonsOutwards) {
  After(StatusTick());
  const PoseInputs& told = After(Boards({100, 0, 0, 0}, {100, 0, 0, 0}));
  // Plates 316 mm wide, 2 cm apart; sensors 433 x 238 mm apart. The left board's front looks right:
  // its left sensors are ahead, its front ones inside.
  const Eigen::Vector3d left = momentum::PressureOf(told.sensors.loads.feet[0], 1).p_WP_m;
  EXPECT_NEAR(left.x(), 0.433 / 2, 1e-9);
  EXPECT_NEAR(left.y(), 0.168 - 0.238 / 2, 1e-9);
  // The right board's front looks left: its left sensors are behind.
  const Eigen::Vector3d right = momentum::PressureOf(told.sensors.loads.feet[1], 1).p_WP_m;
  EXPECT_NEAR(right.x(), -0.433 / 2, 1e-9);
  EXPECT_NEAR(right.y(), -0.168 + 0.238 / 2, 1e-9);
}

TEST_F(PoseSensorsTest, TheLayoutOfTheRigPlacesTheCells) {
  v1::Tick tick = StatusTick();
  for (const char* rig : {"other", "one"}) {
    v1::RigSetup& setup = *tick.mutable_setup()->add_rigs();
    setup.set_rig(rig);
    setup.mutable_layout()->set_preset("custom");
    setup.mutable_layout()->mutable_left()->set_x_m(1);
    setup.mutable_layout()->mutable_left()->set_y_m(rig == std::string("one") ? 2 : 50);
    setup.mutable_layout()->mutable_right()->set_y_m(-2);
  }
  After(tick);
  const PoseInputs& told = After(Boards({0, 100, 0, 0}, {1, 1, 1, 1}));
  // Yaw 0: front is ahead, right is to the right (-y).
  const Eigen::Vector3d left = momentum::PressureOf(told.sensors.loads.feet[0], 1).p_WP_m;
  EXPECT_NEAR(left.x(), 1 + 0.238 / 2, 1e-9);
  EXPECT_NEAR(left.y(), 2 - 0.433 / 2, 1e-9);
}

TEST_F(PoseSensorsTest, TwoBoardsInTheLayoutOfOneAreNotFollowed) {
  v1::Tick tick = StatusTick();
  v1::RigSetup& setup = *tick.mutable_setup()->add_rigs();
  setup.set_rig("one");
  setup.mutable_layout()->set_preset("single");
  After(tick);
  EXPECT_NE(sensors.board_problem().find("single is for one board"), std::string::npos);
  EXPECT_FALSE(After(Boards({1, 2, 3, 4}, {5, 6, 7, 8})).sensors.loads.feet[0].valid);
  setup.mutable_layout()->set_preset("one_foot_each");
  After(tick);
  EXPECT_EQ(sensors.board_problem(), "");
  EXPECT_TRUE(After(Boards({1, 2, 3, 4}, {5, 6, 7, 8})).sensors.loads.feet[0].valid);
  // The other one is switched off.
  setup.mutable_layout()->set_preset("single");
  for (v1::DeviceStatus& device : *tick.mutable_status()->mutable_devices()) {
    if (device.device() == kRightDevice) device.set_state(v1::DEVICE_STATE_LOST);
  }
  After(tick);
  EXPECT_EQ(sensors.board_problem(), "");
}

/// A rig's set-up with boards where nobody laid them out, whose sensors are this far apart.
v1::Tick GeometryTick(double distance_x_m, double distance_y_m) {
  v1::Tick tick;
  v1::RigSetup& setup = *tick.mutable_setup()->add_rigs();
  setup.set_rig("one");
  for (v1::BoardGeometry* geometry : {setup.mutable_layout()->mutable_left_geometry(),
                                      setup.mutable_layout()->mutable_right_geometry()}) {
    geometry->set_plate_x_m(0.511);
    geometry->set_plate_y_m(0.316);
    geometry->set_sensor_distance_x_m(distance_x_m);
    geometry->set_sensor_distance_y_m(distance_y_m);
  }
  return tick;
}

TEST_F(PoseSensorsTest, ThePublishedGeometryPlacesTheCells) {
  After(GeometryTick(0.866, 0.476));
  After(StatusTick());  // Which rig is followed shows after its set-up.
  const PoseInputs& told = After(Boards({100, 0, 0, 0}, {100, 0, 0, 0}));
  const Eigen::Vector3d left = momentum::PressureOf(told.sensors.loads.feet[0], 1).p_WP_m;
  EXPECT_NEAR(left.x(), 0.866 / 2, 1e-9);
  EXPECT_NEAR(left.y(), 0.168 - 0.476 / 2, 1e-9);
  const Eigen::Vector3d right = momentum::PressureOf(told.sensors.loads.feet[1], 1).p_WP_m;
  EXPECT_NEAR(right.x(), -0.866 / 2, 1e-9);
}

TEST_F(PoseSensorsTest, AGeometryThatIsNotOneIsRejected) {
  After(StatusTick());
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -0.433, 9.0, kNan, std::numeric_limits<double>::infinity()}) {
    After(GeometryTick(bad, 0.238));
    const PoseInputs& told = After(Boards({100, 0, 0, 0}, {100, 0, 0, 0}));
    const Eigen::Vector3d left = momentum::PressureOf(told.sensors.loads.feet[0], 1).p_WP_m;
    EXPECT_NEAR(left.x(), 0.433 / 2, 1e-9) << bad;
    EXPECT_NEAR(left.y(), 0.168 - 0.238 / 2, 1e-9) << bad;
  }
}

TEST_F(PoseSensorsTest, ABoardThatFallsSilentIsUnknownAndNotEmpty) {
  After(StatusTick());
  After(Boards({100, 100, 100, 100}, {100, 100, 100, 100}), 0);
  v1::Tick right_only;
  AddBoard(right_only, kRightDevice, {100, 100, 100, 100});
  EXPECT_TRUE(After(right_only, 0.19).sensors.loads.feet[0].valid);
  const PoseInputs& late = After(right_only, 0.21);
  EXPECT_FALSE(late.sensors.loads.feet[0].valid);
  EXPECT_EQ(late.sensors.loads.feet[0].cells[0].load_n, 100) << "never made up to be zero";
  EXPECT_TRUE(late.sensors.loads.feet[1].valid);
  EXPECT_TRUE(After(Boards({1, 1, 1, 1}, {1, 1, 1, 1}), 0.3).sensors.loads.feet[0].valid);
}

TEST_F(PoseSensorsTest, OfSeveralSamplesInATickTheNewestIsTold) {
  After(StatusTick());
  v1::Tick tick = Boards({1, 1, 1, 1}, {2, 2, 2, 2});
  AddBoard(tick, kLeftDevice, {9, 1, 1, 1});
  EXPECT_EQ(After(tick).sensors.loads.feet[0].cells[0].load_n, 9);
}

TEST_F(PoseSensorsTest, NumbersThatAreNoneCountAsNoSample) {
  After(StatusTick());
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  v1::Tick tick = Boards({1, kNan, 1, 1}, {1, 1, 1, 1});
  AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, kNan, 0, 1);
  const PoseInputs& told = After(tick);
  EXPECT_FALSE(told.sensors.loads.feet[0].valid);
  EXPECT_TRUE(told.sensors.loads.feet[1].valid);
  EXPECT_FALSE(told.sensors.hands[0].valid);
  EXPECT_TRUE(momentum::IsFinite(told.sensors.loads));
}

TEST_F(PoseSensorsTest, AHandIsKnownForAsLongAsItIsSeen) {
  After(StatusTick());
  v1::Tick tick;
  AddHand(tick, v1::DEVICE_ROLE_RIGHT_HAND, 0.1, -0.8, 1.4);
  const PoseInputs& seen = After(tick, 0);
  EXPECT_FALSE(seen.sensors.hands[0].valid);
  ASSERT_TRUE(seen.sensors.hands[1].valid);
  EXPECT_EQ(seen.sensors.hands[1].p_W_m, Eigen::Vector3d(0.1, -0.8, 1.4));
  EXPECT_FALSE(After({}, 0.16).sensors.hands[1].valid);
  tick.mutable_hands()->mutable_samples(0)->set_confidence(0);
  EXPECT_FALSE(After(tick, 0.2).sensors.hands[1].valid) << "the tracker does not believe it itself";
}

TEST_F(PoseSensorsTest, AHandThatATrackerTellsLateIsCarriedOnToNow) {
  After(StatusTick());
  constexpr double kLateS = 0.07, kSpeedMps = 1.5;
  const PoseInputs* told = nullptr;
  for (double t_s = 0; t_s < 0.6; t_s += 1.0 / 30) {
    v1::Tick tick;
    tick.set_host_ns(SecondsToNanoseconds(900 + t_s));  // Another host's clock.
    AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, kSpeedMps * (t_s - kLateS), 0.8, 1.4);
    tick.mutable_hands()->mutable_samples(0)->set_sampled_ns(
        SecondsToNanoseconds(900 + t_s - kLateS));
    tick.mutable_hands()->mutable_samples(0)->set_tracker("kinect");
    told = &After(tick, t_s);
    EXPECT_LT(told->sensors.hands[0].p_W_m.x(), kSpeedMps * t_s + 0.03) << t_s;
  }
  // The last tick was at 0.567 s or 0.6 s; untreated it would be 10 cm behind.
  EXPECT_NEAR(told->sensors.hands[0].p_W_m.x(), kSpeedMps * (0.6 - 1.0 / 60), 0.05);
  EXPECT_GT(told->sensors.hands[0].sd_m.x(), 0.01) << "a guess is less sure than what was seen";
  EXPECT_EQ(sensors.tracker(), "kinect");
}

TEST_F(PoseSensorsTest, AJointIsGivenWithItsCovarianceUntilItIsAbsentOrSilent) {
  After(StatusTick());
  v1::Tick tick;
  v1::HandSample& knee = AddJoint(tick, v1::BODY_JOINT_LEFT_KNEE, 0.1, 0.2, 0.5);
  knee.mutable_sd_m()->set_x(0.05);
  knee.mutable_covariance_m2()->set_x(0.0003);
  AddJoint(tick, v1::BODY_JOINT_HEAD, 0, 0, 1.6);
  const reconstruction::JointInputs seen = After(tick, 0).sensors.joints;
  const std::size_t kKnee = v1::BODY_JOINT_LEFT_KNEE - 1, kHead = v1::BODY_JOINT_HEAD - 1;
  ASSERT_TRUE(seen[kKnee].valid);
  EXPECT_EQ(seen[kKnee].p_W_m, Eigen::Vector3d(0.1, 0.2, 0.5));
  EXPECT_EQ(seen[kKnee].sd_m, Eigen::Vector3d(0.05, 0.01, 0.01));
  EXPECT_EQ(seen[kKnee].covariance_m2, Eigen::Vector3d(0.0003, 0, 0));
  EXPECT_TRUE(seen[kHead].valid);
  EXPECT_FALSE(seen[v1::BODY_JOINT_NECK - 1].valid);
  v1::Tick lost;
  AddJoint(lost, v1::BODY_JOINT_LEFT_KNEE, 0, 0, 0, 0);
  const reconstruction::JointInputs after = After(lost, 0.05).sensors.joints;
  EXPECT_FALSE(after[kKnee].valid) << "absent, not at the origin";
  EXPECT_TRUE(after[kHead].valid);
  EXPECT_FALSE(After({}, 0.16).sensors.joints[kHead].valid) << "silent";
}

TEST_F(PoseSensorsTest, HandsBelongToTheSkeletonOfTheirTracker) {
  After(StatusTick());
  v1::Tick tick;
  AddJoint(tick, v1::BODY_JOINT_HEAD, 0, 0, 1.6);
  AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, 0, 0.8, 1.4);
  tick.mutable_hands()->mutable_samples(1)->set_tracker("camera");
  EXPECT_FALSE(After(tick).sensors.hands[0].of_skeleton);
  tick.mutable_hands()->mutable_samples(1)->set_tracker("kinect");
  EXPECT_TRUE(After(tick, 0.2).sensors.hands[0].of_skeleton) << "the camera fell silent";
  EXPECT_FALSE(After(tick, 0.2).sensors.hands[1].of_skeleton) << "not seen";
}

TEST_F(PoseSensorsTest, ASkeletonBesideACameraDoesNotTakeItsHandsOver) {
  After(StatusTick());
  const auto Seen = [](bool camera) {
    v1::Tick tick;
    AddJoint(tick, v1::BODY_JOINT_HEAD, 0, 0, 1.6);
    if (camera) AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, 0, 0.8, 1.4);
    if (camera) tick.mutable_hands()->mutable_samples()->rbegin()->set_tracker("camera");
    AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, 0.06, 0.8, 1.4);
    v1::HandSample& skeleton = *tick.mutable_hands()->mutable_samples()->rbegin();
    skeleton.set_tracker("kinect");
    for (auto set : {&v1::Vector3::set_x, &v1::Vector3::set_y, &v1::Vector3::set_z}) {
      (skeleton.mutable_sd_m()->*set)(0.043);
    }
    return tick;
  };
  for (double t_s = 0; t_s < 0.5; t_s += 0.05) {
    const reconstruction::HandInput hand = After(Seen(true), t_s).sensors.hands[0];
    // By their information, 1 / 0.01^2 to 1 / 0.043^2, and of two standing points' tracks.
    EXPECT_LT(hand.p_W_m.x(), 0.005) << t_s;
    EXPECT_LE(hand.sd_m.x(), 0.012) << t_s;
    EXPECT_FALSE(hand.of_skeleton) << "its offset is not the camera's";
  }
  EXPECT_EQ(sensors.tracker(), "camera, kinect");
  const reconstruction::HandInput alone = After(Seen(false), 0.7).sensors.hands[0];
  EXPECT_NEAR(alone.p_W_m.x(), 0.06, 0.005) << "no trace of the camera is left in its track";
  EXPECT_TRUE(alone.of_skeleton);
  EXPECT_EQ(sensors.tracker(), "kinect");
}

TEST_F(PoseSensorsTest, OfTwoSkeletonsOneIsFollowedUntilItIsSilent) {
  After(StatusTick());
  const auto Seen = [](const char* tracker, double z_m, double confidence = 1) {
    v1::Tick tick;
    AddJoint(tick, v1::BODY_JOINT_HEAD, 0, 0, z_m, confidence).set_tracker(tracker);
    return tick;
  };
  const std::size_t kHead = v1::BODY_JOINT_HEAD - 1;
  After(Seen("kinect", 1.6), 0);
  EXPECT_NEAR(After(Seen("webcam", 1.9), 0.01).sensors.joints[kHead].p_W_m.z(), 1.6, 1e-9);
  EXPECT_FALSE(After(Seen("kinect", 0, 0), 0.1).sensors.joints[kHead].valid);
  EXPECT_FALSE(After(Seen("webcam", 1.9), 0.2).sensors.joints[kHead].valid)
      << "the other one is there and does not see it";
  EXPECT_EQ(After(Seen("webcam", 1.9), 0.3).sensors.joints[kHead].p_W_m.z(), 1.9);
}

TEST_F(PoseSensorsTest, ATrackerInItsOwnFrameSaysNothingOfPlacesInTheWorld) {
  After(StatusTick());
  v1::Tick tick;
  AddHand(tick, v1::DEVICE_ROLE_LEFT_HAND, 0, 0.8, 1.4);
  tick.mutable_hands()->mutable_samples(0)->mutable_tracker_pose()->set_qw(1);
  EXPECT_FALSE(After(tick).sensors.hands[0].valid) << "not calibrated";
  tick.mutable_hands()->mutable_samples(0)->mutable_tracker_pose()->set_z_m(1.1);
  EXPECT_TRUE(After(tick).sensors.hands[0].valid);
}

TEST_F(PoseSensorsTest, JointsOfOthersAndWithoutSenseAreNotGiven) {
  After(StatusTick());
  v1::Tick tick;
  AddJoint(tick, v1::BODY_JOINT_HEAD, 0, 0, 1.6).set_rig("two");
  AddJoint(tick, v1::BODY_JOINT_NECK, std::numeric_limits<double>::quiet_NaN(), 0, 1.4);
  AddJoint(tick, static_cast<v1::BodyJoint>(99), 0, 0, 1);
  for (const auto& joint : After(tick).sensors.joints) EXPECT_FALSE(joint.valid);
}

TEST_F(PoseSensorsTest, AWiimoteInAHandOfTheRigIsBoundByItsRole) {
  v1::Tick status = StatusTick();
  AddDevice(status, 21, v1::DEVICE_ROLE_LEFT_HAND);
  status.mutable_status()->mutable_devices(2)->set_kind(v1::DEVICE_KIND_WIIMOTE);
  After(status);
  const PoseInputs& told = After({});
  EXPECT_EQ(told.hand_trouble[0], HandTrouble::kNoModel);
  EXPECT_EQ(told.hand_trouble[1], HandTrouble::kNone);
}

TEST_F(PoseSensorsTest, AStrappedWiimoteIsBoundByItsRole) {
  v1::Tick status = StatusTick();
  AddDevice(status, 21, v1::DEVICE_ROLE_RIGHT_FOREARM);
  status.mutable_status()->mutable_devices(2)->set_kind(v1::DEVICE_KIND_WIIMOTE);
  After(status);
  EXPECT_EQ(After({}).hand_trouble[1], HandTrouble::kOneStrap);
  EXPECT_EQ(After({}).hand_trouble[0], HandTrouble::kNone);
}

TEST_F(PoseSensorsTest, SamplesOfThePastAndOfOtherRigsAreNotTold) {
  v1::Tick status = StatusTick();
  AddDevice(status, 11, v1::DEVICE_ROLE_LEFT_BOARD, "two");
  After(status);
  v1::Tick old = Boards({1, 1, 1, 1}, {1, 1, 1, 1});
  old.set_refilled(true);
  EXPECT_FALSE(After(old).sensors.loads.feet[0].valid);
  v1::Tick other;
  AddBoard(other, 11, {50, 50, 50, 50});
  EXPECT_FALSE(After(other).sensors.loads.feet[0].valid);
}

TEST_F(PoseSensorsTest, WhatAStandInSaysIsStampedSimulated) {
  After(StatusTick());
  v1::Tick tick = Boards({1, 1, 1, 1}, {1, 1, 1, 1});
  EXPECT_FALSE(After(tick).simulated);
  tick.mutable_boards()->mutable_samples(1)->set_simulated(true);
  EXPECT_TRUE(After(tick).simulated);
}

TEST_F(PoseSensorsTest, AnInsoleIsTheFootThatItSitsOnForAsLongAsItTells) {
  v1::Tick tick;
  AddInsole(tick, v1::CONTACT_BODY_RIGHT_FOOT, 90);
  const PoseInputs& told = After(tick, 0);
  EXPECT_EQ(sensors.rig(), "one") << "nobody has a board, so the first insole's rig is followed";
  EXPECT_FALSE(told.insoles[0].valid);
  ASSERT_TRUE(told.insoles[1].valid);
  ASSERT_EQ(told.insoles[1].count, 4u);
  EXPECT_EQ(told.insoles[1].p_S_m[2], Eigen::Vector2d(0.22, -0.03));
  EXPECT_EQ(reconstruction::TotalLoadN(told.insoles[1]), 360);
  EXPECT_TRUE(told.simulated);
  EXPECT_FALSE(told.sensors.loads.feet[1].valid) << "no board";
  EXPECT_TRUE(After({}, 0.19).insoles[1].valid);
  EXPECT_FALSE(After({}, 0.21).insoles[1].valid);
  EXPECT_FALSE(inputs.Front().simulated);
}

TEST_F(PoseSensorsTest, InsolesOfOthersAndWithoutSenseAreNotTold) {
  After(StatusTick());
  v1::Tick other;
  AddInsole(other, v1::CONTACT_BODY_LEFT_FOOT, 90, "two");
  EXPECT_FALSE(After(other).insoles[0].valid);
  v1::Tick broken;
  AddInsole(broken, v1::CONTACT_BODY_LEFT_FOOT, std::numeric_limits<double>::quiet_NaN());
  AddInsole(broken, v1::CONTACT_BODY_UNSPECIFIED, 90);
  broken.mutable_contacts()->add_samples()->set_rig("one");
  const PoseInputs& told = After(broken);
  EXPECT_FALSE(told.insoles[0].valid);
  EXPECT_FALSE(told.insoles[1].valid);
  v1::Tick many;
  AddInsole(many, v1::CONTACT_BODY_LEFT_FOOT, 1);
  for (int i = 0; i < 13; ++i) many.mutable_contacts()->mutable_samples(0)->add_cells();
  EXPECT_FALSE(After(many).insoles[0].valid);
}

TEST_F(PoseSensorsTest, EveryCalibrationHasItsOwnNumber) {
  sensors.Calibrate();
  sensors.Calibrate();
  sensors.TakeSubject(4);
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_EQ(inputs.Front().calibrate_number, 2u);
  EXPECT_EQ(inputs.Front().subject_number, 4u);
}

}  // namespace
}  // namespace footing::pose_service
