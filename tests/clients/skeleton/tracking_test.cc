#include <gtest/gtest.h>

#include "clients/skeleton/tracking/synthetic_clip.h"
#include "clients/skeleton/tracking/tracker.h"
#include "common/base/units.h"
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

/// Observations of a tracker for a clip that is sent in a dialect.
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
  ASSERT_EQ(observations.size(), clip.size() - 60) << "two seconds at 30 Hz";
  ASSERT_TRUE(tracker.camera());
  EXPECT_LT((tracker.camera()->p_W_m - Eigen::Vector3d(2.4, 0, 1)).norm(), 0.01);
  const Observation& first = observations.front();
  EXPECT_EQ(first.arrived_ns - first.exposed_ns, 20 * kMs);
  EXPECT_NEAR(first.joints[Index(Joint::kLeftFoot)].p_W_m.y(), 0.1, 0.01);
  EXPECT_NEAR(first.joints[Index(Joint::kLeftFoot)].p_W_m.z(), kAnkleHeightM, 0.01);
  EXPECT_EQ(tracker.Messages().size(), 1u) << "the placement";
}

TEST(Tracker, PublishesNothingOfSwappedSidesAndAllWithTheRemedy) {
  for (const bool mirrored : {false, true}) {
    const DialectOptions sender{.mirrored = mirrored, .swap_sides = true};
    Tracker wrong({.stand = true});
    EXPECT_TRUE(Track(wrong, SyntheticClip(), Dialect::kFooting, sender).empty());
    EXPECT_FALSE(wrong.camera());
    EXPECT_NE(wrong.AdviceOf(1).find("--swap-sides"), std::string::npos) << wrong.AdviceOf(1);
    // Without a placement it is seen as soon as hands and knees show it.
    Tracker placed({});
    Track(placed, SyntheticClip(), Dialect::kFooting, sender);
    EXPECT_EQ(placed.counts().people.at(1).fault, Fault::kSwapped);
    Tracker right({.dialect = sender, .stand = true});
    const auto observations = Track(right, SyntheticClip(), Dialect::kFooting, sender);
    ASSERT_FALSE(observations.empty());
    EXPECT_EQ(right.AdviceOf(1), "");
    EXPECT_NEAR(right.camera()->yaw_rad, kPi, 0.01);
    EXPECT_NEAR(observations.front().joints[Index(Joint::kLeftFoot)].p_W_m.y(), 0.1, 0.01);
  }
}

TEST(Tracker, PlacesTheCameraAfterTwoSecondsAtAnyRate) {
  for (const int interval_ms : {1, 200}) {
    Tracker tracker({.stand = true});
    std::vector<Observation> out;
    for (int now_ms = 0; now_ms <= 2000; now_ms += interval_ms) {
      EXPECT_TRUE(out.empty()) << now_ms;
      if (now_ms > 0) {
        EXPECT_NE(tracker.AdviceOf(1).find("not placed yet"), std::string::npos);
      }
      for (const std::string& packet : Encode(Dialect::kFooting, {}, Standing()))
        tracker.Take(osc::AsBytes(packet), now_ms * kMs, kWallNs, out);
    }
    EXPECT_EQ(out.size(), 1u) << interval_ms;
    EXPECT_EQ(tracker.AdviceOf(1), "");
  }
}

TEST(Tracker, SaysThatTheWantedPersonIsNotAmongThoseSeen) {
  Tracker tracker({.user = 7});
  std::vector<Observation> out;
  Skeleton skeleton = Standing();
  for (int now_ms = 0; now_ms <= 3000; now_ms += 100) {
    for (const std::int32_t user : {1, 2}) {
      skeleton.user = user;
      for (const std::string& packet : Encode(Dialect::kFooting, {}, skeleton))
        tracker.Take(osc::AsBytes(packet), now_ms * kMs, kWallNs, out);
    }
  }
  EXPECT_TRUE(out.empty());
  EXPECT_NE(tracker.Advice().find("person 7 was not seen; seen: 1, 2"), std::string::npos);
  EXPECT_EQ(tracker.Messages(), std::vector<std::string>{tracker.Advice()});
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
