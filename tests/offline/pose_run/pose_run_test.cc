#include <algorithm>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/pose/arm_model.h"
#include "tests/offline/pose_run/standing.h"

namespace footing::pose_run {
namespace {

/// Frames of somebody in a T-pose on both feet, at 100 Hz; the first ones stand still.
struct ActivityStage {
  PoseRun run;
  Frame still;

  ActivityStage() {
    const body::Skeleton skeleton = body::StandardPerson(1.75);
    run.body = body::MakeBody(skeleton, {}).value();
    run.rate_hz = 100;
    still.q = body::TPose(skeleton, run.body.landmarks);
    still.com_m = {0, 0, 1};
    still.feet[0].load_n = still.feet[1].load_n = 370;
    Add(still, 50);
  }
  void Add(const Frame& frame, int times) {
    for (int i = 0; i < times; ++i) {
      run.frames.push_back(frame);
      run.frames.back().inputs.loads.time_s =
          static_cast<double>(run.frames.size() - 1) / run.rate_hz;
    }
  }
  int Joint(body::Landmark landmark) const { return run.body.landmarks[landmark]; }
  void Turn(Frame& frame, int joint, body::Axis axis, double angle_rad) const {
    body::SetJointRotation(run.body.skeleton.joint(joint), body::AxisRotation(axis, angle_rad),
                           frame.q);
  }
  std::string LastName() const {
    const Activities told = RuledActivities(run);
    return told.names[static_cast<std::size_t>(told.of_frame.back())];
  }
};

TEST(RuledActivities, BeginStill) {
  const ActivityStage stage;
  const Activities told = RuledActivities(stage.run);
  ASSERT_EQ(told.of_frame.size(), stage.run.frames.size());
  EXPECT_EQ(stage.LastName(), "still");
}

TEST(RuledActivities, GoByTheFeetFirst) {
  for (const bool both : {false, true}) {
    ActivityStage stage;
    Frame up = stage.still;
    up.com_m.z() = 0.5;  // Whatever else it does.
    up.feet[0].load_n = 15;
    if (both) up.feet[1].load_n = -3;
    stage.Add(up, 20);
    EXPECT_EQ(stage.LastName(), both ? "airborne" : "one_foot");
  }
}

TEST(RuledActivities, TellABendFromASquat) {
  for (const double deg : {30.0, 40.0}) {
    ActivityStage stage;
    Frame low = stage.still;
    low.com_m.z() = 0.8;
    stage.Turn(low, 0, body::Axis::kY, DegreesToRadians(deg));
    stage.Add(low, 20);
    EXPECT_EQ(stage.LastName(), deg > 35 ? "bent" : "crouched");
  }
  ActivityStage stage;
  Frame slack = stage.still;
  slack.com_m.z() = 0.91;
  stage.Add(slack, 20);
  EXPECT_EQ(stage.LastName(), "still");
}

TEST(RuledActivities, SeeArmsAndBodiesMove) {
  // Arms of some 55 cm: 0.02 rad a frame are 1.1 m/s.
  ActivityStage arms;
  for (int i = 0; i < 30; ++i) {
    Frame frame = arms.still;
    arms.Turn(frame, arms.Joint(body::Landmark::kLeftShoulder), body::Axis::kX, 0.02 * i);
    arms.Add(frame, 1);
  }
  arms.run.frames.resize(70);
  EXPECT_EQ(arms.LastName(), "arms");

  // A body that glides takes its arms with it.
  for (const double mps : {0.05, 0.3, 1.0}) {
    ActivityStage glide;
    for (int i = 0; i < 30; ++i) {
      Frame frame = glide.still;
      frame.q(0) += mps * i / 100;
      frame.com_m.x() += mps * i / 100;
      glide.Add(frame, 1);
    }
    EXPECT_EQ(glide.LastName(), mps > 0.1 ? "moving" : "still");
  }
}

TEST(LabelledActivities, AreOfTheMotionsOwnClock) {
  ActivityStage stage;
  stage.run.clock_offset_s = -0.2;  // The clip begins in frame 20.
  const auto spans = ParseActivities("begin_s,end_s,activity\n0,0.1,squat\n0.2,0.25,bend\n", "a");
  ASSERT_TRUE(spans.ok());
  const Activities told = LabelledActivities(stage.run, *spans);
  EXPECT_EQ(told.names, (std::vector<std::string>{"squat", "bend"}));
  EXPECT_EQ(told.of_frame[19], -1);
  EXPECT_EQ(told.of_frame[21], 0);
  EXPECT_EQ(told.of_frame[29], 0);
  EXPECT_EQ(told.of_frame[35], -1);
  EXPECT_EQ(told.of_frame[42], 1);
  EXPECT_EQ(told.of_frame[46], -1);
}

TEST(ParseActivities, SaysTheLineThatIsWrong) {
  const std::string head = "begin_s,end_s,activity\n";
  const struct {
    std::string text, said;
  } cases[] = {{"", "begin_s,end_s,activity"},
               {"0,1,squat\n", "line 1"},
               {head, "no activity"},
               {head + "0,1\n", "line 2: expected three fields"},
               {head + "0,1,a\n2,one,b\n", "line 3"},
               {head + "2,1,a\n", "earlier"},
               {head + "0,1,\n", "name"},
               {head + "0,nan,a\n", "line 2"},
               {head + "0,2,a\n1,3,b\n", "line 3: its times overlap"}};
  for (const auto& one : cases) {
    const auto spans = ParseActivities(one.text, "labels.csv");
    ASSERT_FALSE(spans.ok()) << one.text;
    EXPECT_EQ(spans.error().kind, ErrorKind::kInvalidData);
    EXPECT_NE(spans.error().message.find(one.said), std::string::npos) << spans.error().message;
    EXPECT_NE(spans.error().message.find("labels.csv"), std::string::npos);
  }
}

using body::Landmark;

/// Frames of somebody on both feet; the first one is in the T-pose.
struct CrouchStage {
  PoseRun run;

  CrouchStage() {
    const body::Skeleton skeleton = body::StandardPerson(1.75);
    run.body = body::MakeBody(skeleton, {}).value();
    Add();
  }
  Frame& Add() {
    Frame frame;
    frame.q = body::TPose(run.body.skeleton, run.body.landmarks);
    frame.feet[0].load_n = frame.feet[1].load_n = 370;
    run.frames.push_back(frame);
    return run.frames.back();
  }
  void Turn(Frame& frame, Landmark landmark, double deg) const {
    const body::Joint& joint = run.body.skeleton.joint(run.body.landmarks[landmark]);
    body::SetJointRotation(joint, body::AxisRotation(body::Axis::kY, DegreesToRadians(deg)),
                           frame.q);
  }
  void Squat(Frame& frame, double knee_deg) const {
    for (const Landmark hip : {Landmark::kLeftHip, Landmark::kRightHip}) Turn(frame, hip, -80);
    for (const Landmark knee : {Landmark::kLeftKnee, Landmark::kRightKnee})
      Turn(frame, knee, knee_deg);
  }
};

TEST(DeepestCrouch, BendsEveryKneeAndHip) {
  CrouchStage stage;
  stage.Squat(stage.Add(), 50);
  stage.Squat(stage.Add(), 70);
  stage.Squat(stage.Add(), 60);
  const Crouch crouch = DeepestCrouch(stage.run, 0);
  EXPECT_EQ(crouch.frame, 2u);
  EXPECT_NEAR(RadiansToDegrees(crouch.bend_rad), 70, 5);  // Less by how far apart the legs are.
  EXPECT_GT(crouch.bend_rad, kCrouchRad);
}

TEST(DeepestCrouch, IsNeitherABowNorARaisedKneeNorAJump) {
  CrouchStage stage;
  Frame& bow = stage.Add();
  bow.com_m.z() = 0.1;
  for (const Landmark hip : {Landmark::kLeftHip, Landmark::kRightHip}) stage.Turn(bow, hip, -90);
  Frame& knee = stage.Add();
  stage.Turn(knee, Landmark::kLeftHip, -90);
  stage.Turn(knee, Landmark::kLeftKnee, 90);
  Frame& jump = stage.Add();
  stage.Squat(jump, 90);
  jump.feet[0].load_n = jump.feet[1].load_n = 0;
  EXPECT_LT(DeepestCrouch(stage.run, 0).bend_rad, kCrouchRad / 2);
}

TEST(DeepestCrouch, IsLookedForFromTheGivenFrameOn) {
  CrouchStage stage;
  stage.Squat(stage.Add(), 90);
  stage.Squat(stage.Add(), 60);
  EXPECT_EQ(DeepestCrouch(stage.run, 2).frame, 2u);
}

PoseRun RunOf(const Settings& settings) {
  return RunPose(Standing(4), settings, "standing").value();
}

TEST(PoseRun, TheCellsCarryTheBody) {
  Settings settings;
  settings.mass_kg = 80;
  const PoseRun run = RunOf(settings);
  ASSERT_GT(run.frames.size(), 600u);
  for (const Frame& frame : {run.frames[100], run.frames.back()}) {
    const auto pressure = momentum::PressureOf(frame.inputs.loads, 10);
    EXPECT_NEAR(pressure.total_n, 80 * 9.80665, 1);
    EXPECT_NEAR((pressure.p_WP_m - frame.com_m).head<2>().norm(), 0, 0.005);
    EXPECT_NEAR(frame.feet[0].load_n + frame.feet[1].load_n, pressure.total_n, 1);
  }
}

TEST(PoseRun, TheHandsAreWhereTheFistsAreButForTheirNoise) {
  Settings settings;
  settings.hand_noise_m = 0.02;
  const PoseRun run = RunOf(settings);
  body::Kinematics at(run.body.skeleton);
  double sum = 0;
  for (const Frame& frame : run.frames) {
    body::ComputeKinematics(run.body.skeleton, frame.q, at);
    const body::Point fist = body::Fist(run.body, 1);
    const auto joint = static_cast<std::size_t>(fist.joint);
    ASSERT_TRUE(frame.inputs.hands[1].valid);
    sum += (frame.inputs.hands[1].p_W_m - body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]))
               .squaredNorm();
  }
  // Three axes of 2 cm each.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(run.frames.size()) / 3), 0.02, 0.002);
  settings.hands = false;
  EXPECT_FALSE(RunOf(settings).frames[0].inputs.hands[0].valid);
}

TEST(PoseRun, AKinectsHandsAreCarriedOnToNow) {
  Settings settings;
  settings.hand_device = HandDevice::kKinect;
  const PoseRun run = RunOf(settings);
  EXPECT_FALSE(run.frames[3].inputs.hands[0].valid);  // 67 ms are 4 frames.
  ASSERT_TRUE(run.frames[4].inputs.hands[0].valid);
  double changes = 0, apart = 0, away = 0, count = 0;
  body::Kinematics at(run.body.skeleton);
  const body::Point fist = body::Fist(run.body, 0);
  const auto joint = static_cast<std::size_t>(fist.joint);
  for (std::size_t i = 10; i < run.frames.size(); ++i) {
    const auto& hands = run.frames[i].inputs.hands;
    changes += hands[0].p_W_m != run.frames[i - 1].inputs.hands[0].p_W_m ? 1 : 0;
    // The offset is common to both, the noise is not.
    const Eigen::Vector3d middle = 0.5 * (hands[0].p_W_m + hands[1].p_W_m);
    apart += (hands[0].p_W_m - middle).squaredNorm();
    body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
    away += (hands[0].p_W_m - body::Place(fist, at.R_WJ[joint], at.p_WJ[joint])).squaredNorm();
    ++count;
  }
  EXPECT_GT(changes / count, 0.99);  // Between the 30 exposures a second, too.
  // Late by 67 ms, so less sure than the 4.3 cm along an axis of an exposure.
  const double sd_m = run.frames.back().inputs.hands[0].sd_m.x();
  EXPECT_GT(sd_m, 0.0427);
  EXPECT_LT(sd_m, 0.15);
  EXPECT_LT(std::sqrt(away / count / 3), sd_m);
  EXPECT_GT(apart / count, 0.3);
}

TEST(PoseRun, AWiimoteTellsReadingsAndNoPlaces) {
  Settings settings;
  settings.hand_device = HandDevice::kWiimote;
  PoseRun run = RunOf(settings);
  EXPECT_NEAR(run.reading_s, 1.0 / 60, 1e-9);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const Frame& frame = run.frames[i];
    ASSERT_FALSE(frame.inputs.hands[0].valid);
    ASSERT_EQ(frame.readings[0][0].size(), 1u);
    force += frame.readings[0][0][0].specific_force_S_mps2 / static_cast<double>(run.frames.size());
  }
  EXPECT_NEAR(force.norm(), 9.8, 0.5);  // Gravity, with a gain and a bias.

  arms::ArmModel model;
  model.mean.setZero();
  model.scale.setZero();
  model.weights.setZero(arms::kDirections, arms::ArmFeatures::kCount);
  model.offset << 0, 1, 0, 0, 0, 1, 0, 1, 0;
  model.covariance.setIdentity();
  EstimateArms(arms::ArmTracker(model), run);
  EXPECT_FALSE(run.frames[300].inputs.arms[0].valid);
  EXPECT_TRUE(run.frames[340].inputs.arms[0].valid);
  EXPECT_LT((run.frames[340].inputs.arms[1].directions.upper + Eigen::Vector3d::UnitY()).norm(),
            1e-9);
}

/// The furthest that an upper arm's or forearm's direction is off.
double WorstOfStraps(bool perfect) {
  Settings settings;
  settings.hand_device = HandDevice::kStraps;
  settings.perfect_devices = perfect;
  PoseRun run = RunOf(settings);
  EXPECT_TRUE(run.frames[0].readings[0][0].empty()) << "no fist";
  EstimateArms(arms::ArmTracker(std::nullopt), run);
  body::Kinematics at(run.body.skeleton);
  double worst = 0;
  for (std::size_t i = 345; i < run.frames.size(); ++i) {
    body::ComputeKinematics(run.body.skeleton, run.frames[i].q, at);
    for (const int side : {0, 1}) {
      const arms::ArmEstimate& arm = run.frames[i].inputs.arms[static_cast<std::size_t>(side)];
      EXPECT_TRUE(arm.valid) << i;
      const arms::ArmDirections truth = arms::ArmGeometry(run.body, side).Directions(at);
      worst = std::max({worst, (arm.directions.upper - truth.upper).norm(),
                        (arm.directions.forearm - truth.forearm).norm()});
    }
  }
  return worst;
}

TEST(PoseRun, StrapsShowBothArmsWithoutAModel) {
  const double perfect = WorstOfStraps(true), real = WorstOfStraps(false);
  EXPECT_LT(perfect, 0.06);
  EXPECT_LT(real, 0.3);
  EXPECT_GT(real, perfect) << "noise, bias and mounting show";
}

TEST(PoseRun, ErrorsOfTheLayoutMoveWhereTheCellsAreToldToBe) {
  Settings settings;
  const PoseRun right = RunOf(settings);
  settings.gap_error_m = 0.04;
  settings.mass_error = 0.02;
  const PoseRun wrong = RunOf(settings);
  const auto cell = [](const PoseRun& r, std::size_t foot, std::size_t frame) {
    return r.frames[frame].inputs.loads.feet[foot].cells[0];
  };
  EXPECT_NEAR(cell(wrong, 0, 0).p_WS_m.y() - cell(right, 0, 0).p_WS_m.y(), 0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 1, 0).p_WS_m.y() - cell(right, 1, 0).p_WS_m.y(), -0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 0).load_n / cell(right, 0, 0).load_n, 1.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 400).load_n / cell(right, 0, 400).load_n, 1, 1e-9);
}

TEST(PoseRun, NamesTheClipThatHasNoPerson) {
  motion::Motion motion = Standing(1);
  motion.skeleton.joints[0].name = "thing";
  for (body::Joint& joint : motion.skeleton.joints) joint.name = "x" + joint.name;
  const auto made = RunPose(motion, {}, "chair.bvh");
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().message.find("chair.bvh"), std::string::npos);
}

}  // namespace
}  // namespace footing::pose_run
