#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "common/base/units.h"
#include "common/camera/find.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/camera/scene.h"
#include "common/wire/wire.h"
#include "daemon/simulation/pose_service/pose_sensors.h"
#include "tests/simulation/pose_service/pose_ticks.h"

namespace footing::pose_service {
namespace {

constexpr std::uint32_t kLeft = 3, kRight = 4;
constexpr double kPeriodS = 0.01;

/// Forearm and upper arm go where the hand's axis goes that was along the arm in the T-pose.
arms::ArmModel StiffArm() {
  arms::ArmModel model;
  model.mean.setZero();
  model.scale.setOnes();
  model.weights.setZero(arms::kDirections, arms::ArmFeatures::kCount);
  model.offset.setZero();
  for (int k = 0; k < 3; ++k) {
    model.weights(k, 3 + k) = model.weights(6 + k, 3 + k) = 1;  // Second column of the turn.
    model.weights(3 + k, 6 + k) = 1;
  }
  model.covariance.setIdentity();
  model.covariance *= 0.04;
  return model;
}

/// Two Wiimotes, level and pointing forward, that turn about the axis ahead.
struct PoseArmsTest : testing::Test {
  PoseArmsTest() {
    arms.Bind(0, kLeft);
    arms.Bind(1, kRight);
  }

  /// A sample of a Wiimote: S is x left, y front, z down; ahead is its y.
  void Take(std::uint32_t device, double turn_radps) {
    stream::MotionSample sample;
    sample.device = device;
    sample.sampled_ns = now_ns;
    sample.specific_force_mps2 = {kStandardGravityMps2 * std::sin(roll_rad), 0,
                                  -kStandardGravityMps2 * std::cos(roll_rad)};
    // A part of its readings has been taken by footingd for its bias.
    sample.has_angular_velocity = true;
    sample.angular_velocity_radps = {kBiasRadps, turn_radps - held_bias_radps, 0};
    sample.gyroscope_bias_radps = {0, held_bias_radps, 0};
    arms.Take(sample, now_ns);
  }
  void Run(double seconds, double turn_radps, bool left_too = true) {
    for (double t_s = 0; t_s < seconds - 1e-9; t_s += kPeriodS) {
      now_ns += SecondsToNanoseconds(kPeriodS);
      roll_rad += turn_radps * kPeriodS;
      if (left_too) Take(kLeft, turn_radps);
      Take(kRight, turn_radps);
      arms.Report(now_ns, inputs);
    }
  }
  void TakeTPose() {
    arms.Follow(false, 0);
    Run(5, 0);
    arms.Follow(true, 1);
  }
  Eigen::Vector3d Forearm(std::size_t side) const {
    return inputs.sensors.arms[side].directions.forearm;
  }

  static constexpr double kBiasRadps = 0.02;
  double held_bias_radps = 0, roll_rad = 0;
  std::int64_t now_ns = 50'000'000'000;
  PoseArms arms{StiffArm()};
  PoseInputs inputs;
};

TEST_F(PoseArmsTest, ArmsAreToldFromTheTPoseOnAndGoWhereTheWiimotesTurn) {
  arms.Follow(false, 0);
  Run(5, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  arms.Follow(true, 1);
  Run(0.8, 1);
  ASSERT_TRUE(inputs.sensors.arms[0].valid && inputs.sensors.arms[1].valid);
  // 0.8 rad about the axis ahead: the left arm goes up, the right one down.
  EXPECT_LT((Forearm(0) - Eigen::Vector3d(0, std::cos(0.8), std::sin(0.8))).norm(), 0.02);
  EXPECT_LT((Forearm(1) - Eigen::Vector3d(0, -std::cos(0.8), -std::sin(0.8))).norm(), 0.02);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
}

TEST_F(PoseArmsTest, ABiasThatFootingdMakesOfASlowTurnIsPutBack) {
  TakeTPose();
  held_bias_radps = 0.1;
  Run(3, 0.1);
  EXPECT_LT((Forearm(0) - Eigen::Vector3d(0, std::cos(0.3), std::sin(0.3))).norm(), 0.02);
}

TEST_F(PoseArmsTest, WhatAHandDidBeforeTheTPoseIsNoPartOfIt) {
  arms.Follow(false, 0);
  roll_rad = 1.2;
  Run(4, 0);
  arms.Follow(false, 0.5);
  arms.Follow(false, 0);  // Broken off.
  roll_rad = 0;
  arms.Follow(false, 0.01);
  Run(5, 0);
  arms.Follow(true, 1);
  Run(0.1, 0);
  EXPECT_LT((Forearm(0) - Eigen::Vector3d::UnitY()).norm(), 0.01);
}

TEST_F(PoseArmsTest, AWiimoteThatIsLostTellsNothingUntilTheNextTPose) {
  TakeTPose();
  Run(0.1, 0);
  Run(0.15, 0, false);
  EXPECT_TRUE(inputs.sensors.arms[0].valid) << "a pause that it can be followed through";
  Run(0.5, 0, false);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kSilent);
  EXPECT_TRUE(inputs.sensors.arms[1].valid) << "the other one is told on";
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kNone);
  Run(1, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kAwaitsTPose);
  TakeTPose();
  Run(0.1, 0);
  EXPECT_TRUE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
}

TEST_F(PoseArmsTest, ANewTPoseMakesBothUnknownUntilItIsTaken) {
  TakeTPose();
  Run(0.1, 0);
  ASSERT_TRUE(inputs.sensors.arms[1].valid);
  arms.Follow(false, 0);
  Run(0.1, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid || inputs.sensors.arms[1].valid);
}

TEST_F(PoseArmsTest, AWiimoteWithoutMotionPlusAndOneWithoutAModelAreNamed) {
  PoseArms without_model{std::nullopt};
  without_model.Bind(0, kLeft);
  without_model.Report(now_ns, inputs);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNoModel);
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kNone) << "none is there";
  stream::MotionSample sample;
  sample.device = kLeft;
  sample.sampled_ns = now_ns;
  arms.Take(sample, now_ns);
  arms.Report(now_ns, inputs);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNoGyroscope);
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kSilent);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
}

/// Wiimotes on both segments of the left arm, that point to the hand, and whose buttons face up.
struct StrappedArmTest : testing::Test {
  static constexpr std::uint32_t kUpper = 11, kForearm = 12;

  void Take(std::uint32_t device, double up_radps) {
    stream::MotionSample sample;
    sample.device = device;
    sample.sampled_ns = now_ns;
    sample.simulated = true;
    // S is x left, y front, z down: front to the left, up by `pitch_rad`.
    sample.specific_force_mps2 = {0, kStandardGravityMps2 * std::sin(pitch_rad),
                                  -kStandardGravityMps2 * std::cos(pitch_rad)};
    // Ahead is to the right of its front: the negative x.
    sample.has_angular_velocity = true;
    sample.angular_velocity_radps = {-up_radps, 0, 0};
    arms.Take(sample, now_ns);
  }
  void Run(double seconds, double up_radps, bool forearm_too = true) {
    for (double t_s = 0; t_s < seconds - 1e-9; t_s += kPeriodS) {
      now_ns += SecondsToNanoseconds(kPeriodS);
      pitch_rad += up_radps * kPeriodS;
      Take(kUpper, up_radps);
      if (forearm_too) Take(kForearm, up_radps);
      arms.Report(now_ns, inputs);
    }
  }

  double pitch_rad = 0;
  std::int64_t now_ns = 50'000'000'000;
  PoseArms arms{std::nullopt};
  PoseInputs inputs;
};

TEST_F(StrappedArmTest, NeedsBothStrapsAndNoModel) {
  arms.Bind(0, kUpper, arms::Place::kUpperArm);
  Run(5, 0);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kOneStrap);
  arms.Bind(0, kForearm, arms::Place::kForearm);
  Run(5, 0);
  arms.Follow(true, 1);
  Run(0.7, 1);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
  ASSERT_TRUE(inputs.sensors.arms[0].valid);
  EXPECT_TRUE(inputs.simulated);
  const arms::ArmDirections& arm = inputs.sensors.arms[0].directions;
  const Eigen::Vector3d up(0, std::cos(0.7), std::sin(0.7));
  EXPECT_LT((arm.upper - up).norm(), 0.02) << arm.upper.transpose();
  EXPECT_LT((arm.forearm - up).norm(), 0.02);
  EXPECT_FALSE(inputs.sensors.arms[1].valid);
  Run(0.5, 0, false);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kSilent);
  Run(0.5, 0);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kAwaitsTPose);
}

/// A device on a belt, its front ahead, whose wearer bends ahead.
struct BeltTest : testing::Test {
  static constexpr std::uint32_t kBelt = 21;

  BeltTest() {
    segments.Bind(reconstruction::BodySite::kPelvis, kBelt);
    body.valid = true;
    body.p_WC_m.z() = 1;
    for (auto& foot : body.feet) foot.load_n = 350;
  }
  void Run(double seconds, double bend_radps) {
    for (double t_s = 0; t_s < seconds - 1e-9; t_s += kPeriodS) {
      now_ns += SecondsToNanoseconds(kPeriodS);
      bent_rad += bend_radps * kPeriodS;
      stream::MotionSample sample;
      sample.device = kBelt;
      sample.sampled_ns = now_ns;
      // S is x left, y front, z down.
      sample.specific_force_mps2 =
          -kStandardGravityMps2 * Eigen::Vector3d(0, std::sin(bent_rad), std::cos(bent_rad));
      sample.has_angular_velocity = true;
      sample.angular_velocity_radps = {bend_radps, 0, 0};
      segments.Take(sample, now_ns);
      segments.Report(now_ns, inputs);
    }
  }
  /// Down and up, with the centre of mass this high.
  void Bend(double com_height_m) {
    body.p_WC_m.z() = com_height_m;
    segments.Follow(true, 1, body);
    Run(1, 0.5);
    Run(1, -0.5);
    body.p_WC_m.z() = 1;
    segments.Follow(true, 1, body);
  }

  double bent_rad = 0;
  std::int64_t now_ns = 50'000'000'000;
  momentum::Estimate body;
  PoseSegments segments;
  PoseInputs inputs;
};

TEST_F(BeltTest, KnowsWhichWayItFacesAfterASquat) {
  segments.Follow(false, 0, body);
  Run(5, 0);
  segments.Follow(true, 1, body);
  Run(1, 0);
  EXPECT_TRUE(inputs.turn_awaits[0]);
  Bend(0.98);
  EXPECT_TRUE(inputs.turn_awaits[0]) << "a bend of somebody who stands";
  EXPECT_FALSE(inputs.sensors.turns[0].valid);
  Bend(0.8);
  EXPECT_FALSE(inputs.turn_awaits[0]);
  Run(1, 0.5);
  const arms::HandState& turn = inputs.sensors.turns[0];
  ASSERT_TRUE(turn.valid);
  EXPECT_LT((turn.turn_W.col(2) - Eigen::Vector3d(std::sin(0.5), 0, std::cos(0.5))).norm(), 0.05);
  EXPECT_GT(turn.heading_sd_rad, 0.15);
  EXPECT_LT(turn.heading_sd_rad, 0.35);
}

TEST_F(BeltTest, AMoveInAHandCountsFromTheTPoseOn) {
  constexpr auto kHand = static_cast<std::size_t>(reconstruction::BodySite::kLeftHand);
  segments.Bind(reconstruction::BodySite::kPelvis, std::nullopt);
  segments.Bind(reconstruction::BodySite::kLeftHand, kBelt);
  segments.Follow(false, 0, body);
  Run(5, 0);
  segments.Follow(true, 1, body);
  Run(1, 0.5);
  ASSERT_TRUE(inputs.sensors.turns[kHand].valid);
  EXPECT_LT(
      (inputs.sensors.turns[kHand].turn_W.col(2) - Eigen::Vector3d(std::sin(0.5), 0, std::cos(0.5)))
          .norm(),
      0.05);
}

TEST_F(BeltTest, AnotherTPoseNeedsAnotherSquat) {
  Run(5, 0);
  segments.Follow(true, 1, body);
  Bend(0.8);
  EXPECT_TRUE(inputs.sensors.turns[0].valid);
  segments.Follow(false, 0, body);
  Run(5, 0);
  segments.Follow(true, 1, body);
  Run(1, 0);
  EXPECT_FALSE(inputs.sensors.turns[0].valid);
}

constexpr std::int64_t kStartNs = 5'000'000'000;

struct PoseSensorsTest : testing::Test {
  /// Inputs of the engine after a tick.
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

/// A board that was lost keeps its role in the list beside the one that has it now.
TEST_F(PoseSensorsTest, ALostBoardDoesNotTakeTheRoleOfTheAttachedOne) {
  v1::Tick tick = StatusTick();
  AddDevice(tick, 12, v1::DEVICE_ROLE_LEFT_BOARD);
  tick.mutable_status()->mutable_devices()->rbegin()->set_state(v1::DEVICE_STATE_LOST);
  After(tick);
  EXPECT_TRUE(After(Boards({1, 2, 3, 4}, {5, 6, 7, 8})).sensors.loads.feet[0].valid);
}

TEST_F(PoseSensorsTest, ARestartedServerMayHaveAnotherRig) {
  After(StatusTick());
  v1::Tick later;
  later.set_epoch(2);
  AddDevice(later, kLeftDevice, v1::DEVICE_ROLE_LEFT_BOARD, "other");
  AddBoard(later, kLeftDevice, {1, 2, 3, 4});
  EXPECT_TRUE(After(later).sensors.loads.feet[0].valid);
  EXPECT_EQ(sensors.rig(), "other");
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

stream::HandSample Sample(const std::string& tracker, const Eigen::Vector3d& p_W_m,
                          const Eigen::Vector3d& sd_m) {
  stream::HandSample sample;
  sample.tracker = tracker;
  sample.confidence = 1;
  sample.position_m = p_W_m;
  sample.sd_m = sd_m;
  return sample;
}

const Eigen::Vector3d kHere(0.2, 0.6, 1.3);
constexpr std::int64_t kNowNs = 7'000'000'000;

TEST(TrackedHand, EachTrackerCountsAlongTheAxisThatItKnows) {
  TrackedHand hand;
  hand.Add(Sample("front", kHere, {0.1, 0.01, 0.01}), 7, kNowNs);
  hand.Add(Sample("side", kHere + Eigen::Vector3d(0.01, 0.01, 0.01), {0.01, 0.1, 0.01}), 7, kNowNs);
  const TrackedHand::Fused fused = hand.At(kNowNs);
  ASSERT_TRUE(fused.hand.valid);
  // Weights 1 : 100 along x, 100 : 1 along y, 1 : 1 along z.
  const Eigen::Vector3d off_m = fused.hand.p_W_m - kHere;
  EXPECT_NEAR(off_m.x(), 0.01 * 100 / 101, 1e-9);
  EXPECT_NEAR(off_m.y(), 0.01 / 101, 1e-9);
  EXPECT_NEAR(off_m.z(), 0.01 / 2, 1e-9);
  EXPECT_NEAR(fused.hand.sd_m.z(), 0.01 / std::sqrt(2), 1e-9);
  EXPECT_EQ(fused.trackers, (std::set<std::string>{"front", "side"}));
}

TEST(TrackedHand, ContradictionMakesItLessCertain) {
  TrackedHand hand;
  const Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  hand.Add(Sample("a", kHere, sd_m), 7, kNowNs);
  hand.Add(Sample("b", kHere + Eigen::Vector3d(0.3, 0, 0), sd_m), 7, kNowNs);
  // Each is 15 deviations from the middle: chi squared 450 of 3 degrees of freedom.
  EXPECT_NEAR(hand.At(kNowNs).hand.sd_m.x(), 0.01 / std::sqrt(2) * std::sqrt(450.0 / 3), 1e-6);
}

/// A level Move that points along W's x and swings along y from 12 s on, and the camera, which sees
/// its sphere until some time.
void Swing(double seen_until_s, double to_s, bool simulated, TrackedHand& hand) {
  constexpr double kReachM = 0.2, kRadps = 6;
  const double ahead_m = simulated ? 0 : 0.1125;
  for (double t_s = 10; t_s < to_s; t_s += 0.005) {
    const double swing = t_s < 12 ? 0 : kReachM * std::sin(kRadps * (t_s - 12));
    stream::MotionSample sample;
    sample.device = 4;
    sample.simulated = simulated;
    sample.sampled_ns = SecondsToNanoseconds(t_s);
    sample.specific_force_mps2 = {-kRadps * kRadps * swing, 0, -9.80665};
    sample.has_angular_velocity = true;
    hand.Feel(sample);
    if (t_s > seen_until_s) continue;
    stream::HandSample seen =
        Sample("camera", kHere + Eigen::Vector3d(ahead_m, swing, 0), {0.005, 0.002, 0.002});
    seen.sampled_ns = SecondsToNanoseconds(t_s);
    hand.Add(seen, t_s, SecondsToNanoseconds(t_s));
  }
}

TEST(TrackedHand, AMoveBridgesWhatTheCameraDoesNotSee) {
  TrackedHand with, without;
  with.Bind(4);
  for (TrackedHand* hand : {&with, &without}) Swing(18, 18.3, true, *hand);
  const std::int64_t seen_ns = SecondsToNanoseconds(18), now_ns = SecondsToNanoseconds(18.3);
  EXPECT_FALSE(without.At(now_ns, now_ns).hand.valid);
  const TrackedHand::Fused fused = with.At(now_ns, now_ns);
  ASSERT_TRUE(fused.hand.valid);
  EXPECT_EQ(fused.trackers, std::set<std::string>{"camera"});
  const Eigen::Vector3d truth_m = kHere + Eigen::Vector3d(0, 0.2 * std::sin(6 * 6.3), 0);
  EXPECT_LT((fused.hand.p_W_m - truth_m).norm(), 0.03);
  EXPECT_GT(fused.hand.sd_m.x(), with.At(seen_ns, seen_ns).hand.sd_m.x());
  with.Bind(5);
  EXPECT_FALSE(with.At(now_ns, now_ns).hand.valid);
}

TEST(TrackedHand, ARealMoveIsHeldBehindItsSphereAsSoonAsItsHeadingIsKnown) {
  TrackedHand real;
  real.Bind(4);
  Swing(11, 11, false, real);
  std::int64_t now_ns = SecondsToNanoseconds(11);
  EXPECT_NEAR(real.At(now_ns, now_ns).hand.p_W_m.x(), kHere.x() + 0.1125, 0.01) << "at rest";
  real = TrackedHand();
  real.Bind(4);
  Swing(18, 18, false, real);
  now_ns = SecondsToNanoseconds(18);
  EXPECT_NEAR(real.At(now_ns, now_ns).hand.p_W_m.x(), kHere.x(), 0.02);
}

TEST(TrackedHand, ATrackerThatIsSilentIsLeftOut) {
  TrackedHand hand;
  const Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  hand.Add(Sample("camera", kHere, sd_m), 7, kNowNs);
  const std::int64_t later_ns = kNowNs + SecondsToNanoseconds(0.16);
  hand.Add(Sample("kinect", kHere + Eigen::Vector3d(0.1, 0, 0), 4 * sd_m), 7.16, later_ns);
  EXPECT_NEAR(hand.At(later_ns).hand.p_W_m.x(), kHere.x() + 0.1, 1e-9);
  EXPECT_EQ(hand.At(later_ns).trackers, std::set<std::string>{"kinect"});
  EXPECT_FALSE(hand.At(later_ns + SecondsToNanoseconds(0.16)).hand.valid);
}

TEST(TrackedHand, AnotherTrackerTooManyReplacesTheOneHeardLongestAgo) {
  TrackedHand hand;
  for (int i = 0; i < 5; ++i) {
    hand.Add(Sample(std::to_string(i), kHere, Eigen::Vector3d::Constant(0.01)), 7, kNowNs + i);
  }
  EXPECT_EQ(hand.At(kNowNs + 4).trackers, (std::set<std::string>{"1", "2", "3", "4"}));
}

TEST(CountedPoint, ItsInformationIsTheTrackersTimesItsConfidence) {
  stream::HandSample sample = Sample("camera", kHere, {0.01, 0.02, 0.03});
  sample.covariance_m2.x() = 0.0001;
  sample.confidence = 0.25;
  const CountedPoint point(sample);
  EXPECT_LT((point.sd_m - Eigen::Vector3d(0.02, 0.04, 0.06)).norm(), 1e-12);
  EXPECT_NEAR(point.covariance_m2.x(), 0.0004, 1e-15);
}

TEST(CountedPoint, IsNeverBetterThanTwoMillimetresNorWorseThanAMetre) {
  stream::HandSample sample = Sample("camera", kHere, {1e-6, 0.5, 0.5});
  EXPECT_EQ(CountedPoint(sample).sd_m.x(), 0.002);
  sample.confidence = 1e-9;
  const CountedPoint point(sample);
  EXPECT_TRUE(point.sd_m.allFinite());
  EXPECT_LE(point.sd_m.maxCoeff(), 1);
}

/// Sightings of a magenta sphere at a good exposure times `exposure`, with a halo, in front of a
/// camera that stands ahead of the person and looks back.
struct Sphere {
  double nees = 0, counted_nees = 0;  // Normalised squared errors of depth.
  int saturated = 0, found = 0;

  Sphere(double distance_m, double exposure) {
    noise::Random random(31);
    Eigen::Matrix3d R_WC;
    R_WC << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    const Eigen::Vector3d camera_m(2.5, 0, 1.1);
    sphere::Finder finder(sphere::Lens(), {sphere::Target()}, sphere::Settings());
    for (int i = 0; i < 8; ++i) {
      virtual_camera::Scene scene;
      virtual_camera::Ball& ball = scene.balls.emplace_back();
      ball.p_C_m = virtual_camera::PlaceInView(scene.lens, distance_m, 0.8, random);
      ball.colour_dn *= exposure;
      ball.halo = 0.08;
      const auto image = virtual_camera::Render(scene, random);
      const auto seen =
          finder.Find({sphere::PixelFormat::kSgrbg8, image.width, image.height, image.bytes})[0];
      if (!seen) continue;
      ++found;
      saturated += seen->is_saturated ? 1 : 0;
      Add(R_WC * seen->covariance_m2 * R_WC.transpose(), camera_m + R_WC * seen->p_C_m,
          camera_m + R_WC * ball.p_C_m, camera_m, *seen);
    }
    nees /= found;
    counted_nees /= found;
  }

 private:
  void Add(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& p_W_m,
           const Eigen::Vector3d& truth_m, const Eigen::Vector3d& camera_m,
           const sphere::Estimate& seen) {
    stream::HandSample sample = Sample("camera", p_W_m, covariance.diagonal().cwiseSqrt());
    sample.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
    sample.confidence = seen.confidence;
    sample.saturated = seen.is_saturated;
    sample.tracker_pose.emplace().position_m = {camera_m.x(), 0, camera_m.z()};
    // Along the line of sight: across it no point counts as better than 2 mm.
    const Eigen::Vector3d sight = (truth_m - camera_m).normalized();
    const double error2_m2 = std::pow(sight.dot(p_W_m - truth_m), 2);
    nees += error2_m2 / sight.dot(covariance * sight);
    const CountedPoint point(sample);
    Eigen::Matrix3d counted = point.sd_m.cwiseAbs2().asDiagonal();
    counted(0, 1) = counted(1, 0) = point.covariance_m2.x();
    counted(0, 2) = counted(2, 0) = point.covariance_m2.y();
    counted(1, 2) = counted(2, 1) = point.covariance_m2.z();
    counted_nees += error2_m2 / sight.dot(counted * sight);
  }
};

TEST(CountedPoint, ASphereAtTheSensorsLimitCountsForWhatItIsWorth) {
  for (const double distance_m : {1.0, 3.0}) {
    for (const double exposure : {2.0, 4.0}) {
      const Sphere sphere(distance_m, exposure);
      ASSERT_GT(sphere.found, 6) << distance_m << " m, " << exposure;
      EXPECT_EQ(sphere.saturated, sphere.found);
      EXPECT_LE(sphere.counted_nees, sphere.nees) << "its own covariance is taken for too large";
      EXPECT_LE(sphere.counted_nees, 1.2) << distance_m << " m, " << exposure;
      EXPECT_GE(sphere.counted_nees, 0.1) << distance_m << " m, " << exposure;
    }
  }
}

}  // namespace
}  // namespace footing::pose_service
