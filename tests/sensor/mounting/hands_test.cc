#include "daemon/sensor/mounting/hands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace footing::hands {
namespace {

using stream::ContactFrame;
using stream::DeviceRole;
using stream::HandFrame;
using stream::ReferenceFrame;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

HandFrame TwoFists() {
  HandFrame frame;
  frame.tracker = "eye";
  frame.age_ns = 20'000'000;
  frame.points = {{DeviceRole::kLeftHand, {0.1, 0.7, 1.4}, {0.01, 0.01, 0.02}, 0.9},
                  {DeviceRole::kRightHand, {0.1, -0.7, 1.4}, {0.01, 0.01, 0.02}, 1}};
  return frame;
}

ReferenceFrame ThreeJoints() {
  ReferenceFrame frame;
  frame.parents = {-1, 0, 1};
  frame.positions_m = {{0, 0, 1}, {0, 0, 1.2}, {0, 0, 1.5}};
  frame.com_m = {0, 0, 1.1};
  return frame;
}

TEST(Hands, AFrameAtEveryLimitIsTaken) {
  HandFrame frame = TwoFists();
  EXPECT_EQ(Problem(frame), "");
  frame.age_ns = stream::kOldestPointNs;
  frame.points[0].position_m = {0, 0, stream::kFarthestPointM};
  frame.points[0].sd_m = {1, 1, 1};
  frame.points[1].confidence = 0;
  for (int joint = 1; joint <= static_cast<int>(stream::kBodyJoints); ++joint) {
    stream::TrackedPoint& point = frame.points.emplace_back(frame.points[0]);
    point.role = DeviceRole::kUnspecified;
    point.joint = static_cast<stream::BodyJoint>(joint);
  }
  EXPECT_EQ(Problem(frame), "");
}

TEST(Hands, AJointHasItsNameInPlaceOfARole) {
  HandFrame frame = TwoFists();
  frame.points[1].role = DeviceRole::kUnspecified;
  frame.points[1].joint = stream::BodyJoint::kRightFoot;
  ASSERT_EQ(Problem(frame), "");
  const auto samples = ToSamples(frame, 1, "main");
  EXPECT_EQ(samples[0].joint, stream::BodyJoint::kUnspecified);
  EXPECT_EQ(samples[1].joint, stream::BodyJoint::kRightFoot);
  EXPECT_EQ(samples[1].role, DeviceRole::kUnspecified);
}

TEST(Hands, EachBadValueIsRefusedAndNamed) {
  const std::pair<const char*, std::function<void(HandFrame&)>> kBad[] = {
      {"position", [](HandFrame& f) { f.points[1].position_m.x() = kNan; }},
      {"position", [](HandFrame& f) { f.points[1].position_m.y() = kInfinity; }},
      {"position",
       [](HandFrame& f) {
         f.points[1].position_m = {8, 8, 0};
       }},
      {"standard deviation", [](HandFrame& f) { f.points[1].sd_m.x() = 0; }},
      {"standard deviation", [](HandFrame& f) { f.points[1].sd_m.y() = -0.01; }},
      {"standard deviation", [](HandFrame& f) { f.points[1].sd_m.z() = 1.01; }},
      {"standard deviation", [](HandFrame& f) { f.points[1].sd_m.z() = kNan; }},
      {"confidence", [](HandFrame& f) { f.points[1].confidence = 1.1; }},
      {"confidence", [](HandFrame& f) { f.points[1].confidence = -0.1; }},
      {"confidence", [](HandFrame& f) { f.points[1].confidence = kNan; }},
      {"covariances", [](HandFrame& f) { f.points[1].covariance_m2.x() = 1.01e-4; }},
      {"covariances", [](HandFrame& f) { f.points[1].covariance_m2.z() = kNan; }},
      // Each pair could be, all three together cannot.
      {"covariances",
       [](HandFrame& f) {
         f.points[1].covariance_m2 = {-0.9e-4, 1.8e-4, 1.8e-4};
       }},
      {"role", [](HandFrame& f) { f.points[1].role = DeviceRole::kUnspecified; }},
      {"the role head", [](HandFrame& f) { f.points[1].role = DeviceRole::kHead; }},
      {"the role left_board", [](HandFrame& f) { f.points[1].role = DeviceRole::kLeftBoard; }},
      {"a role and a joint",
       [](HandFrame& f) { f.points[1].joint = stream::BodyJoint::kLeftKnee; }},
      {"age_ns", [](HandFrame& f) { f.age_ns = -1; }},
      {"age_ns", [](HandFrame& f) { f.age_ns = stream::kOldestPointNs + 1; }},
      {"0 points", [](HandFrame& f) { f.points.clear(); }},
      {"17 points", [](HandFrame& f) { f.points.resize(17, f.points[0]); }},
      {"tracker that is not within",
       [](HandFrame& f) {
         f.tracker_pose = stream::TrackerPose{{0, kNan, 0}};
       }},
      {"tracker_pose that does not turn",
       [](HandFrame& f) {
         f.tracker_pose = stream::TrackerPose{{0, 0, 0}, {0.9, 0, 0, 0}};
       }},
      {"points 1 and 2 are of the same hand",
       [](HandFrame& f) { f.points[1].role = f.points[0].role; }},
      {"name", [](HandFrame& f) { f.tracker = "a\nb"; }},
      {"name", [](HandFrame& f) { f.rig = std::string(65, 'r'); }},
  };
  for (const auto& [word, spoil] : kBad) {
    HandFrame frame = TwoFists();
    spoil(frame);
    EXPECT_THAT(Problem(frame), HasSubstr(word));
  }
}

TEST(Hands, SamplesAreDatedBackAndGoToTheDefaultRigWithoutOne) {
  HandFrame frame = TwoFists();
  frame.simulated = true;
  frame.tracker_pose = stream::TrackerPose{{2, 0, 1}, {0, 1, 0, 0}};
  auto samples = ToSamples(frame, 1'000'000'000, "main");
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[1].role, DeviceRole::kRightHand);
  EXPECT_EQ(samples[1].rig, "main");
  EXPECT_EQ(samples[1].tracker, "eye");
  EXPECT_EQ(samples[1].received_ns, 1'000'000'000);
  EXPECT_EQ(samples[1].sampled_ns, 980'000'000);
  EXPECT_EQ(samples[1].position_m, frame.points[1].position_m);
  EXPECT_EQ(samples[1].sd_m, frame.points[1].sd_m);
  EXPECT_EQ(samples[0].confidence, 0.9);
  EXPECT_TRUE(samples[0].simulated);
  EXPECT_EQ(samples[0].tracker_pose->position_m, Eigen::Vector3d(2, 0, 1));
  frame.rig = "second";
  EXPECT_EQ(ToSamples(frame, 0, "main")[0].rig, "second");
}

TEST(Hands, CovarianceAndWhatWasWrongWithTheSightGoWithThePoint) {
  HandFrame frame = TwoFists();
  frame.points[0].covariance_m2 = {0.5e-4, -1.5e-4, 0};
  frame.points[0].saturated = frame.points[0].occluded = true;
  ASSERT_EQ(Problem(frame), "");
  const auto samples = ToSamples(frame, 0, "main");
  EXPECT_EQ(samples[0].covariance_m2, frame.points[0].covariance_m2);
  EXPECT_TRUE(samples[0].saturated && samples[0].occluded);
  EXPECT_FALSE(samples[1].saturated || samples[1].occluded);
}

TEST(Hands, APointThatWasNotSeenNeedsNoDeviations) {
  HandFrame frame = TwoFists();
  frame.points[1].sd_m.setZero();
  EXPECT_NE(Problem(frame), "");
  frame.points[1].confidence = 0;
  EXPECT_EQ(Problem(frame), "");
  EXPECT_EQ(ToSamples(frame, 0, "main")[1].confidence, 0);
}

TEST(Reference, EachBadValueIsRefusedAndNamed) {
  EXPECT_EQ(Problem(ThreeJoints()), "");
  const std::pair<const char*, std::function<void(ReferenceFrame&)>> kBad[] = {
      {"parent 2", [](ReferenceFrame& f) { f.parents[2] = 2; }},
      {"parent -2", [](ReferenceFrame& f) { f.parents[0] = -2; }},
      {"joint 1", [](ReferenceFrame& f) { f.positions_m[1].z() = kNan; }},
      {"joint 1", [](ReferenceFrame& f) { f.positions_m[1].z() = 10.1; }},
      {"centre of mass", [](ReferenceFrame& f) { f.com_m.x() = kInfinity; }},
      {"2 positions", [](ReferenceFrame& f) { f.positions_m.pop_back(); }},
      {"0 parents", [](ReferenceFrame& f) { f = {}; }},
      {"65 parents",
       [](ReferenceFrame& f) {
         f.parents.assign(65, -1);
         f.positions_m.assign(65, {0, 0, 0});
       }},
      {"age_ns", [](ReferenceFrame& f) { f.age_ns = -5; }},
      {"name", [](ReferenceFrame& f) { f.rig = "\x7f"; }},
  };
  for (const auto& [word, spoil] : kBad) {
    ReferenceFrame frame = ThreeJoints();
    spoil(frame);
    EXPECT_THAT(Problem(frame), HasSubstr(word));
  }
}

TEST(Reference, APoseIsDatedBack) {
  ReferenceFrame frame = ThreeJoints();
  frame.age_ns = 5;
  const stream::ReferencePose pose = ToPose(frame, 100, "main");
  EXPECT_EQ(pose.sampled_ns, 95);
  EXPECT_EQ(pose.rig, "main");
  EXPECT_EQ(pose.parents, frame.parents);
  EXPECT_EQ(pose.positions_m, frame.positions_m);
  EXPECT_EQ(pose.com_m, frame.com_m);
}

TEST(Refusals, AreSaidAtOnceThenOncePerTenSecondsWithTheirNumber) {
  Refusals refusals;
  const auto add = [&](double at_s) {
    return refusals.Add(static_cast<std::int64_t>(at_s * 1e9), "a hand frame", "why");
  };
  EXPECT_THAT(add(100).value_or(""), HasSubstr("a hand frame is refused: why"));
  EXPECT_FALSE(add(100));
  EXPECT_FALSE(add(109.9));
  EXPECT_THAT(add(110).value_or(""), HasSubstr("3 refused"));
  EXPECT_EQ(refusals.total(), 4u);
}

TEST(Refusals, EachKindIsSaidByItselfAndNoneIsForgotten) {
  Refusals refusals;
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  EXPECT_TRUE(refusals.Add(kSecondNs, "a hand frame", "one"));
  EXPECT_TRUE(refusals.Add(kSecondNs, "a contact frame", "two")) << "another sender's";
  EXPECT_FALSE(refusals.Add(2 * kSecondNs, "a hand frame", "three"));
  EXPECT_TRUE(refusals.Due(10 * kSecondNs).empty()) << "not yet";
  EXPECT_THAT(refusals.Due(11 * kSecondNs),
              testing::ElementsAre("device socket: a hand frame is refused: three (1 refused since "
                                   "the last such line)"));
  EXPECT_TRUE(refusals.Due(30 * kSecondNs).empty()) << "nothing since";
}

TEST(Hands, AnInsoleThatMakesNoSenseIsRefusedWithTheReason) {
  ContactFrame good;
  good.source = "left";
  good.body = stream::ContactBody::kLeftFoot;
  good.cells = {{{0, 0.03, 0}, 100}, {{0.25, -0.03, 0}, -0.4}};
  EXPECT_EQ(Problem(good), "");
  const std::pair<const char*, std::function<void(ContactFrame&)>> kBad[] = {
      {"foot", [](ContactFrame& f) { f.body = stream::ContactBody::kUnspecified; }},
      {"0 cells", [](ContactFrame& f) { f.cells.clear(); }},
      {"17 cells", [](ContactFrame& f) { f.cells.resize(17, f.cells[0]); }},
      {"cell 2 has a position", [](ContactFrame& f) { f.cells[1].position_m.z() = kNan; }},
      {"cell 1 has a position", [](ContactFrame& f) { f.cells[0].position_m.x() = 1.1; }},
      {"cell 2 has a load", [](ContactFrame& f) { f.cells[1].load_n = kInfinity; }},
      {"cell 1 has a load", [](ContactFrame& f) { f.cells[0].load_n = kNan; }},
      {"cell 1 has a load", [](ContactFrame& f) { f.cells[0].load_n = -10'001; }},
      {"age_ns", [](ContactFrame& f) { f.age_ns = stream::kOldestPointNs + 1; }},
      {"name", [](ContactFrame& f) { f.source = "a\nb"; }},
      {"name", [](ContactFrame& f) { f.rig = std::string(65, 'r'); }},
  };
  for (const auto& [word, spoil] : kBad) {
    ContactFrame frame = good;
    spoil(frame);
    EXPECT_THAT(Problem(frame), testing::HasSubstr(word));
  }
}

TEST(ExposureClock, TheSendersTimeIsTakenUnlessItIsOfAnotherClock) {
  ExposureClock clock;
  EXPECT_EQ(clock.Take({5'000'000'000, 4'990'000'000, 3'000'000}).sampled_ns, 4'987'000'000);
  EXPECT_EQ(clock.Take({5'100'000'000, 99, 3'000'000}).sampled_ns, 5'097'000'000);
  EXPECT_EQ(clock.Take({5'200'000'000, 5'300'000'000, 3'000'000}).sampled_ns, 5'197'000'000);
}

TEST(ExposureClock, EarlierFramesOfOneReadStayLaterThanWhatIsPublished) {
  ExposureClock clock;
  for (int i = 1; i <= 5; ++i) clock.Take({i * 10'000'000ll, 0, 0});
  clock.Publish();
  std::int64_t first_ns = clock.Take({60'000'000, 0, 0}).sampled_ns;
  std::int64_t last_ns = first_ns;
  for (int i = 0; i < 50; ++i) {
    const auto exposure = clock.Take({60'000'000, 0, 0});
    first_ns -= exposure.others_earlier_ns;
    EXPECT_GT(exposure.sampled_ns, last_ns - exposure.others_earlier_ns);
    last_ns = exposure.sampled_ns;
  }
  EXPECT_GT(first_ns, 50'000'000);
  clock.Publish();
  const auto next = clock.Take({60'000'000, 0, 0});
  EXPECT_EQ(next.others_earlier_ns, 0) << "what is published no longer changes";
  EXPECT_GT(next.sampled_ns, last_ns);
}

}  // namespace
}  // namespace footing::hands
