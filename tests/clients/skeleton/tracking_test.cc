#include <gtest/gtest.h>

#include "clients/skeleton/clips/synthetic_clip.h"
#include "clients/skeleton/tracking/observation.h"
#include "clients/skeleton/tracking/placement.h"
#include "clients/skeleton/tracking/sender_clock.h"
#include "clients/skeleton/tracking/tracker.h"
#include "common/units/units.h"
#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWallNs = 1'790'000'000'000'000'000;

TEST(SenderClock, BelievesASynchronisedClock) {
  SenderClock clock(67 * kMs);
  EXPECT_EQ(clock.Age(kWallNs - 12 * kMs, true, 5 * kMs, kWallNs), 12 * kMs);
  EXPECT_EQ(clock.Age(std::nullopt, false, 6 * kMs, kWallNs), 67 * kMs);
}

TEST(SenderClock, TakesTheFastestPacketOfAnotherClockAsTypical) {
  SenderClock clock(40 * kMs);
  // Sent every 33 ms by a clock that is an hour off; packets are 0 to 20 ms late.
  const std::int64_t off_ns = 3'600'000 * kMs;
  std::int64_t age_ns = 0;
  for (int i = 0; i < 400; ++i) {
    const std::int64_t late_ns = (i % 5) * 5 * kMs;
    const std::int64_t sent_ns = 33 * kMs * i;
    age_ns = clock.Age(sent_ns + off_ns, i % 2 == 0, sent_ns + late_ns, kWallNs + sent_ns);
    if (i >= 5) {
      EXPECT_EQ(age_ns, 40 * kMs + late_ns) << i;
    }
  }
  // Its host starts again, and the clock with it.
  EXPECT_EQ(clock.Age(5 * kMs, false, 14'000 * kMs, kWallNs), 40 * kMs);
  EXPECT_EQ(clock.Age(38 * kMs, false, 14'033 * kMs, kWallNs), 40 * kMs);
}

TEST(Placement, PutsAFacingCamera) {
  // 2.5 m before the person, 1 m high, looking back along x: K's left is W's right.
  const Eigen::Isometry3d X_WK = ToPose({.p_W_m = {2.5, 0, 1}, .yaw_rad = kPi});
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LT((a - b).norm(), 1e-12) << a.transpose();
  };
  near(X_WK * Eigen::Vector3d(-0.3, 0.2, 2.5), {0, 0.3, 1.2});
  // Pitched up by 0.1 rad: what is straight ahead is higher.
  const Eigen::Isometry3d up = ToPose({.p_W_m = {0, 0, 0}, .yaw_rad = 0, .pitch_rad = 0.1});
  near(up * Eigen::Vector3d(0, 0, 1), {std::cos(0.1), 0, std::sin(0.1)});
  // Rolled so that its left side is up.
  const Eigen::Isometry3d rolled = ToPose({.p_W_m = {0, 0, 0}, .yaw_rad = 0, .roll_rad = 0.1});
  near(rolled * Eigen::Vector3d(1, 0, 0), {0, std::cos(0.1), std::sin(0.1)});
}

TEST(Placement, FindsACameraFromAPersonWhoStands) {
  const CameraPlace truth{
      .p_W_m = {2.1, 0.4, 1.3}, .yaw_rad = 2.9, .pitch_rad = -0.15, .roll_rad = 0.05};
  const Eigen::Isometry3d X_KW = ToPose(truth).inverse();
  const Eigen::Isometry3d X_WS =  // Standing() is before a level camera; feet to W's origin.
      ToPose({.p_W_m = {2.5, 0, 0.9 + kAnkleHeightM}, .yaw_rad = kPi});
  Skeleton seen = Standing();
  for (JointReading& joint : seen.joints) joint.p_K_m = X_KW * (X_WS * joint.p_K_m);
  const std::vector<Skeleton> frames(kStandingFrames, seen);
  const auto fit = FitStanding(frames, {.pitch_rad = truth.pitch_rad, .roll_rad = truth.roll_rad});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->place.yaw_rad, truth.yaw_rad, 1e-9);
  EXPECT_LT((fit->place.p_W_m - truth.p_W_m).norm(), 1e-9);
  EXPECT_LT(fit->lean_rad, 0.01);
  // With the tilt unknown, the person seems to lean by as much.
  const auto level = FitStanding(frames, {});
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->lean_rad, std::hypot(0.15, 0.05), 0.01);
}

TEST(Placement, RefusesWhatIsNoStand) {
  std::vector<Skeleton> frames(kStandingFrames, Standing());
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (JointReading& joint : frames[i].joints) joint.p_K_m.x() += 0.005 * static_cast<double>(i);
  EXPECT_NE(FitStanding(frames, {}).error().message.find("stand still"), std::string::npos);
  frames.assign(kStandingFrames, Standing());
  for (Skeleton& frame : frames) frame[Joint::kNeck].p_K_m.z() -= 0.3;
  EXPECT_NE(FitStanding(frames, {}).error().message.find("leans by"), std::string::npos);
  for (Skeleton& frame : frames) frame[Joint::kLeftFoot].confidence = 0;
  EXPECT_NE(FitStanding(frames, {}).error().message.find("step back"), std::string::npos);
}

TEST(Observation, HasACovarianceByHowTheJointWasSeen) {
  Skeleton skeleton = Standing();
  skeleton[Joint::kLeftHand].confidence = 0.5;
  skeleton[Joint::kHead].confidence = 0;
  const Observation observation = Observe(skeleton, ToPose({}));
  const double variance_m2 = 0.015 * 0.015 + 0.04 * 0.04;
  EXPECT_NEAR(observation.joints[Index(Joint::kRightHand)].covariance_W_m2(0, 0), variance_m2,
              1e-12);
  EXPECT_NEAR(observation.joints[Index(Joint::kLeftHand)].covariance_W_m2(2, 2), 9 * variance_m2,
              1e-12);
  EXPECT_TRUE(observation.joints[Index(Joint::kLeftHand)].inferred);
  EXPECT_FALSE(observation.joints[Index(Joint::kHead)].present);
}

TEST(Observation, BecomesAFrameOfAllJoints) {
  Observation observation = Observe(Standing(), ToPose({.p_W_m = {2.5, 0, 1}}));
  observation.exposed_ns = 5 * kMs;
  const stream::HandFrame frame = ToHandFrame(observation, 25 * kMs);
  EXPECT_EQ(frame.age_ns, 20 * kMs);
  ASSERT_EQ(frame.points.size(), kJoints);
  ASSERT_TRUE(frame.tracker_pose) << "a later placement can be applied";
  EXPECT_EQ(frame.tracker_pose->position_m, Eigen::Vector3d(2.5, 0, 1));
  const stream::TrackedPoint& hand = frame.points[Index(Joint::kLeftHand)];
  EXPECT_EQ(hand.role, stream::DeviceRole::kLeftHand);
  EXPECT_EQ(hand.joint, stream::BodyJoint::kUnspecified);
  EXPECT_LT((hand.position_m - Eigen::Vector3d(0.25, 0.25, 1.05)).norm(), 1e-9);
  EXPECT_NEAR(hand.sd_m.x(), std::hypot(0.015, 0.04), 1e-9);
  const stream::TrackedPoint& knee = frame.points[Index(Joint::kRightKnee)];
  EXPECT_EQ(knee.role, stream::DeviceRole::kUnspecified);
  EXPECT_EQ(knee.joint, stream::BodyJoint::kRightKnee);
  EXPECT_EQ(knee.position_m, observation.joints[Index(Joint::kRightKnee)].p_W_m);
}

TEST(Observation, CountsWithItsOwnCovarianceOnceDividedByTheConfidence) {
  Skeleton skeleton = Standing();
  skeleton[Joint::kLeftHand].confidence = 0.5;
  const Observation observation = Observe(skeleton, ToPose({}));
  const stream::TrackedPoint hand = ToHandFrame(observation, 0).points[Index(Joint::kLeftHand)];
  EXPECT_EQ(hand.confidence, 0.5);
  EXPECT_NEAR(hand.sd_m.x() * hand.sd_m.x() / hand.confidence,
              observation.joints[Index(Joint::kLeftHand)].covariance_W_m2(0, 0), 1e-12);
}

TEST(Observation, SaysWhatIsAbsentInferredAndTooFarOff) {
  Observation observation = Observe(Standing(), ToPose({.p_W_m = {2.5, 0, 1}}));
  observation.joints[Index(Joint::kLeftHand)].present = false;
  observation.joints[Index(Joint::kRightHand)].p_W_m.x() = 11;
  observation.joints[Index(Joint::kNeck)].inferred = true;
  Eigen::Matrix3d& covariance = observation.joints[Index(Joint::kTorso)].covariance_W_m2;
  covariance << 4e-4, 1e-4, 2e-4, 1e-4, 5e-4, 3e-4, 2e-4, 3e-4, 9e-4;
  const stream::HandFrame frame = ToHandFrame(observation, 25 * kMs);
  EXPECT_EQ(frame.points[Index(Joint::kLeftHand)].confidence, 0);
  EXPECT_EQ(frame.points[Index(Joint::kRightHand)].confidence, 0);
  EXPECT_TRUE(frame.points[Index(Joint::kNeck)].occluded);
  EXPECT_FALSE(frame.points[Index(Joint::kTorso)].occluded);
  EXPECT_EQ(frame.points[Index(Joint::kTorso)].covariance_m2, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
}

/// What a tracker makes of a clip that is sent in a dialect.
std::vector<Observation> Track(Tracker& tracker, const std::vector<ClipFrame>& clip,
                               Dialect dialect, const DialectOptions& options = {}) {
  std::vector<Observation> observations;
  for (const ClipFrame& frame : clip) {
    Skeleton sent = frame.skeleton;
    const std::int64_t now_ns = kMs + frame.time_ns;
    sent.sent_ns = kWallNs + now_ns - 20 * kMs;
    for (const std::string& packet : Encode(dialect, options, sent))
      tracker.Take(osc::AsBytes(packet), now_ns, kWallNs + now_ns, observations);
  }
  return observations;
}

TEST(Tracker, PublishesThePersonInWFromTheStandOn) {
  Tracker tracker({.stand = true});
  const auto clip = SyntheticClip();
  const auto observations = Track(tracker, clip, Dialect::kFooting);
  ASSERT_EQ(observations.size(), clip.size() - kStandingFrames + 1);
  ASSERT_TRUE(tracker.camera());
  EXPECT_LT((tracker.camera()->p_W_m - Eigen::Vector3d(2.4, 0, 1)).norm(), 0.01);
  const Observation& first = observations.front();
  EXPECT_EQ(first.arrived_ns - first.exposed_ns, 20 * kMs);
  EXPECT_NEAR(first.joints[Index(Joint::kLeftFoot)].p_W_m.y(), 0.1, 0.01);
  EXPECT_NEAR(first.joints[Index(Joint::kLeftFoot)].p_W_m.z(), kAnkleHeightM, 0.01);
  EXPECT_EQ(tracker.Messages().size(), 1u) << "the placement";
}

TEST(Tracker, SaysWhenAWrongScaleComesAndPublishesNothing) {
  Tracker tracker({});
  // A sender in metres to a receiver that takes the dialect's millimetres, and the reverse.
  const auto metres = Track(tracker, SyntheticClip(), Dialect::kZillode, {.units = Units::kMetres});
  EXPECT_LT(metres.size(), 20u) << "only before a median";
  const auto messages = tracker.Messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("person 1: the bones"), std::string::npos);
  EXPECT_EQ(tracker.counts().people.at(1).fault, Fault::kScale);
  Tracker other({.dialect = {.units = Units::kMetres}});
  Track(other, SyntheticClip(), Dialect::kZillode);
  EXPECT_EQ(other.counts().people.at(1).fault, Fault::kMillimetres);
}

TEST(Tracker, KeepsToOnePersonUntilThatOneIsGone) {
  Tracker tracker({});
  std::vector<Observation> out;
  Skeleton skeleton = Standing();
  const auto send = [&](std::int32_t user, std::int64_t now_ms) {
    skeleton.user = user;
    out.clear();
    for (const std::string& packet : Encode(Dialect::kFooting, {}, skeleton))
      tracker.Take(osc::AsBytes(packet), now_ms * kMs, kWallNs, out);
    return out.size();
  };
  EXPECT_EQ(send(4, 0), 1u);
  EXPECT_EQ(send(2, 10), 0u);
  EXPECT_EQ(send(4, 500), 1u);
  EXPECT_EQ(send(2, 1400), 0u);
  EXPECT_EQ(send(2, 1501), 1u);
  EXPECT_EQ(send(4, 1510), 0u);
}

TEST(Tracker, CountsPacketsThatItCannotReadAndSaysSoOnce) {
  Tracker tracker({});
  std::vector<Observation> out;
  for (int i = 0; i < 10; ++i) tracker.Take(osc::AsBytes("rubbish!"), i, i, out);
  EXPECT_EQ(tracker.counts().rejected_packets, 10u);
  EXPECT_EQ(tracker.Messages().size(), 1u);
}

TEST(Tracker, TakesRealClips) {
  const auto clips = RealClips();
  if (clips.empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  for (const auto& clip : clips) {
    Tracker tracker({});
    const auto observations = Track(tracker, clip, Dialect::kKinectSdk2);
    EXPECT_EQ(observations.size(), clip.size());
    std::size_t hands = 0;
    for (const Observation& one : observations) {
      for (const stream::TrackedPoint& point : ToHandFrame(one, one.arrived_ns).points)
        if (point.role != stream::DeviceRole::kUnspecified && point.confidence > 0) ++hands;
    }
    EXPECT_GT(hands, clip.size()) << "more than one of two, the worst clip's third inferred";
  }
}

}  // namespace
}  // namespace footing::skeleton
