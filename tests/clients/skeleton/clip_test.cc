#include <gtest/gtest.h>

#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

std::string Line(int time, const std::string& x = "0.5", const std::string& state = "2") {
  std::string line = std::to_string(time) + ",";
  for (int i = 0; i < 25; ++i) line += x + "," + std::to_string(i) + ",2," + state + ",";
  return line + "\n";
}

TEST(KinectClip, ReadsFramesAndStates) {
  const auto clip = ReadKinectClip(Line(1000) + "\n" + Line(334'333, "0.25", "1"), "f");
  ASSERT_TRUE(clip);
  ASSERT_EQ(clip->size(), 2u);
  EXPECT_EQ((*clip)[1].time_ns, 33'333'300);
  EXPECT_EQ((*clip)[0].skeleton.present(), kJoints);
  // Kinect's order: HandLeft is 7, AnkleRight 18, SpineShoulder 20.
  EXPECT_EQ((*clip)[0].skeleton[Joint::kLeftHand].p_K_m, Eigen::Vector3d(0.5, 7, 2));
  EXPECT_EQ((*clip)[0].skeleton[Joint::kRightFoot].p_K_m.y(), 18);
  EXPECT_EQ((*clip)[0].skeleton[Joint::kNeck].p_K_m.y(), 20);
  EXPECT_EQ((*clip)[1].skeleton[Joint::kHead].confidence, 0.5);
}

TEST(KinectClip, NamesWhatIsWrong) {
  EXPECT_EQ(ReadKinectClip("", "f").error().message, "f: has no frames");
  EXPECT_EQ(ReadKinectClip("1,2,3\n", "f").error().message, "f, line 1: has fewer than 101 cells");
  EXPECT_EQ(ReadKinectClip(Line(1) + Line(0), "f").error().message,
            "f, line 2: the time goes back");
  EXPECT_EQ(ReadKinectClip(Line(1, "x"), "f").error().message, "f, line 1: cell 2 is not a number");
  EXPECT_EQ(ReadKinectClip(Line(1, "1", "3"), "f").error().message,
            "f, line 1: cell 5 is not a state 0, 1 or 2");
}

TEST(KinectClip, ReadsRealRecordings) {
  const auto clips = RealClips();
  if (clips.empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  ASSERT_EQ(clips.size(), 4u);
  for (const auto& clip : clips) {
    EXPECT_GT(clip.size(), 150u);
    const double rate_hz =
        1e9 * static_cast<double>(clip.size() - 1) / static_cast<double>(clip.back().time_ns);
    EXPECT_NEAR(rate_hz, 30, 2);
  }
}

}  // namespace
}  // namespace footing::skeleton
