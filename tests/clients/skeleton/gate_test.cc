#include <gtest/gtest.h>

#include <random>

#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/person_gate.h"
#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

constexpr std::int64_t kFrameNs = 33'333'333;

/// A standing person with noise, for `frames`; `change` spoils each frame.
template <typename Change>
Gated Play(PersonGate& gate, int frames, const Change& change) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  Gated gated;
  for (int i = 0; i < frames; ++i) {
    Skeleton skeleton = Standing();
    for (JointReading& joint : skeleton.joints)
      for (double& x : joint.p_K_m) x += noise(random);
    change(skeleton);
    gated = gate.Advance(skeleton, i * kFrameNs);
  }
  return gated;
}

void Nothing(Skeleton&) {}

TEST(PersonGate, TakesAStandingPerson) {
  PersonGate gate;
  const Gated gated = Play(gate, 200, Nothing);
  EXPECT_EQ(gated.fault, Fault::kNone);
  EXPECT_EQ(gated.skeleton.present(), kJoints);
}

TEST(PersonGate, ReportsAWrongScaleInWords) {
  const auto scaled = [](double factor) {
    PersonGate gate;
    return Play(gate, 40, [factor](Skeleton& skeleton) {
      for (JointReading& joint : skeleton.joints) joint.p_K_m *= factor;
    });
  };
  EXPECT_EQ(scaled(1000).fault, Fault::kMillimetres);
  EXPECT_EQ(scaled(100).fault, Fault::kCentimetres);
  EXPECT_EQ(scaled(10).fault, Fault::kScale);
  EXPECT_EQ(scaled(1000).skeleton.present(), 0u);
  EXPECT_NE(Advice(Fault::kMillimetres).find("--units mm"), std::string::npos);
  // Normalised coordinates of OSCeleton taken for metres.
  PersonGate gate;
  const Gated gated = Play(gate, 40, [](Skeleton& skeleton) {
    for (JointReading& joint : skeleton.joints)
      joint.p_K_m = FromCamera(Dialect::kSensebloom, {}, joint.p_K_m);
  });
  EXPECT_EQ(gated.fault, Fault::kNormalised);
}

TEST(PersonGate, ReportsSwappedSidesAndAPersonUpsideDown) {
  PersonGate names, picture, right;
  const auto swap = [](Skeleton& skeleton) { skeleton = SwappedSides(skeleton); };
  EXPECT_EQ(Play(names, 60, swap).fault, Fault::kSwapped);
  // The picture is mirrored and the names are not.
  const auto mirror = [](Skeleton& skeleton) { skeleton = SwappedSides(MirrorImage(skeleton)); };
  EXPECT_EQ(Play(picture, 60, mirror).fault, Fault::kSwapped);
  // The remedy that the advice names helps, while a mirror image of both leaves the fault.
  EXPECT_NE(Advice(Fault::kSwapped).find("--swap-sides"), std::string::npos);
  EXPECT_EQ(Play(right, 60,
                 [](Skeleton& skeleton) {
                   skeleton = WithSides({.swap_sides = true}, SwappedSides(skeleton));
                 })
                .fault,
            Fault::kNone);
  PersonGate still;
  EXPECT_EQ(Play(still, 60,
                 [](Skeleton& skeleton) {
                   skeleton = WithSides({.mirrored = true}, SwappedSides(skeleton));
                 })
                .fault,
            Fault::kSwapped);
  PersonGate head_down;
  EXPECT_EQ(Play(head_down, 60,
                 [](Skeleton& skeleton) {
                   for (JointReading& joint : skeleton.joints) joint.p_K_m.y() *= -1;
                 })
                .fault,
            Fault::kUpsideDown);
}

TEST(PersonGate, ReportsABackThatACameraTakesForAFront) {
  PersonGate gate;
  const Gated gated = Play(gate, 60, [](Skeleton& skeleton) {
    for (JointReading& joint : skeleton.joints) {
      joint.p_K_m.x() *= -1;  // Half a turn about the person's middle.
      joint.p_K_m.z() = 5 - joint.p_K_m.z();
    }
    skeleton = SwappedSides(skeleton);
  });
  EXPECT_EQ(gated.fault, Fault::kTurned);
}

TEST(PersonGate, ReportsAPersonOfHalfSize) {
  const auto scaled = [](double factor) {
    PersonGate gate;
    return Play(gate, 40, [factor](Skeleton& skeleton) {
      for (JointReading& joint : skeleton.joints) joint.p_K_m *= factor;
    });
  };
  EXPECT_EQ(scaled(0.5).fault, Fault::kShort);
  EXPECT_NE(Advice(Fault::kShort).find("--factor"), std::string::npos);
  EXPECT_EQ(scaled(0.65).fault, Fault::kNone) << "a child";
}

TEST(PersonGate, RecoversWhenTheFaultIsOver) {
  PersonGate gate;
  Play(gate, 60, [](Skeleton& skeleton) {
    for (JointReading& joint : skeleton.joints) joint.p_K_m.y() *= -1;
  });
  EXPECT_EQ(Play(gate, 200, Nothing).fault, Fault::kNone);
}

TEST(PersonGate, DropsAJointWhoseBoneCannotBe) {
  PersonGate gate;
  Play(gate, 100, Nothing);
  Skeleton wrong = Standing();
  wrong[Joint::kLeftHand].p_K_m.y() += 0.15;  // Slow enough, but the forearm is 40 % off.
  wrong[Joint::kLeftHand].p_K_m.z() -= 0.1;
  const Gated gated = gate.Advance(wrong, 100 * kFrameNs);
  EXPECT_EQ(gated.verdicts[Index(Joint::kLeftHand)], Verdict::kBone);
  EXPECT_EQ(gated.skeleton.present(), kJoints - 1);
}

TEST(PersonGate, DropsAJumpButBelievesWhatStays) {
  PersonGate gate;
  Play(gate, 100, Nothing);
  Skeleton moved = Standing();
  for (JointReading& joint : moved.joints) joint.p_K_m.x() += 0.8;  // 24 m/s.
  int dropped = 0;
  for (int i = 100; i < 110; ++i) {
    const Gated gated = gate.Advance(moved, i * kFrameNs);
    if (gated.skeleton.present() > 0) break;
    EXPECT_EQ(gated.verdicts[0], Verdict::kSpeed);
    ++dropped;
  }
  // 0.06 m + 6 m/s reach 0.8 m after 124 ms, which is the fourth frame.
  EXPECT_EQ(dropped, 3);
}

TEST(PersonGate, LeavesUntrackedJointsOutAndCountsInferredOnes) {
  PersonGate gate;
  Skeleton skeleton = Standing();
  skeleton[Joint::kHead].confidence = 0.1;
  skeleton[Joint::kNeck].confidence = 0.5;
  const Gated gated = gate.Advance(skeleton, 0);
  EXPECT_EQ(gated.verdicts[Index(Joint::kHead)], Verdict::kAbsent);
  EXPECT_EQ(gated.skeleton.present(), kJoints - 1);
  EXPECT_EQ(gated.inferred, 1u);
}

TEST(PersonGate, TakesRealPeopleAndFindsTheirMirrorImages) {
  const auto clips = RealClips();
  if (clips.empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  for (const auto& clip : clips) {
    PersonGate gate, mirror;
    std::size_t faults = 0, taken = 0, known = 0;
    bool mirrored = false;
    for (const ClipFrame& frame : clip) {
      const Gated gated = gate.Advance(frame.skeleton, frame.time_ns);
      faults += gated.fault != Fault::kNone ? 1 : 0;
      taken += gated.skeleton.present();
      for (const JointReading& joint : frame.skeleton.joints)
        known += joint.confidence > 0.2 ? 1 : 0;
      Skeleton swapped = frame.skeleton;
      for (std::size_t i = 0; i < kJoints; ++i)
        swapped.joints[i] = frame.skeleton[Mirrored(static_cast<Joint>(i))];
      mirrored = mirrored || mirror.Advance(swapped, frame.time_ns).fault == Fault::kSwapped;
    }
    EXPECT_EQ(faults, 0u);
    EXPECT_TRUE(mirrored);
    EXPECT_GT(static_cast<double>(taken) / static_cast<double>(known), 0.85);
  }
}

}  // namespace
}  // namespace footing::skeleton
