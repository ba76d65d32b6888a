#include <gtest/gtest.h>

#include "tests/simulation/pose_service/pose_run_line.h"

namespace footing::pose_service {
namespace {

TEST(PoseRun, InsolesAreFollowedWhileTheyTellAndBoardsKnowThePersonWhenTheyStop) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) {
    line.Wear(i);
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
  }
  const auto message = ToCharacterFrame(line.frame, {}, {}, "boards", "one");
  EXPECT_EQ(message.characters(0).body().contact_source(), "insoles");
  EXPECT_TRUE(message.characters(0).body().feet_told(1));
  EXPECT_TRUE(line.frame.t_pose.complete);
  EXPECT_TRUE(line.frame.valid);
  EXPECT_NEAR(line.frame.t_pose.mass_kg, 70, 0.5);
  line.told.insoles = {};
  line.Step(400);
  EXPECT_EQ(line.frame.input.source, PoseSource::kBoards);
  EXPECT_TRUE(line.frame.t_pose.complete) << "the T-pose was taken on both";
}

TEST(PoseRun, InsolesThatComeLaterAwaitATPoseOfTheirOwn) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) line.Step(i);
  ASSERT_TRUE(line.frame.t_pose.complete && line.frame.valid);
  for (std::size_t i = 400; i < 430; ++i) {
    line.Wear(i);
    line.Step(i);
    ASSERT_TRUE(line.frame.t_pose.complete && line.frame.valid) << "nothing is lost";
    EXPECT_EQ(line.frame.input.source, PoseSource::kBoards);
    EXPECT_TRUE(line.frame.input.insoles_await);
  }
  for (std::size_t i = 0; i < 400; ++i) {  // The T-pose again.
    line.Wear(i);
    line.Step(i);
  }
  EXPECT_EQ(line.frame.input.source, PoseSource::kInsoles);
  EXPECT_TRUE(line.frame.t_pose.complete);
  EXPECT_FALSE(line.frame.input.insoles_await);
}

TEST(PoseRun, InsolesThatFallSilentLeaveAPoseThatIsLessSureByTheSecond) {
  Line line;
  const auto walk_off = [&line](std::size_t i) {
    line.Wear(i);
    line.told.sensors = line.measured[i];
    for (auto& foot : line.told.sensors.loads.feet) foot.valid = false;  // No boards are there.
    line.inputs.Write(line.told);
    line.Quiet();
  };
  for (std::size_t i = 0; i < 450; ++i) walk_off(i);
  ASSERT_TRUE(line.frame.t_pose.complete && line.frame.valid);
  const auto ankle = static_cast<std::size_t>(line.person.landmarks[body::Landmark::kLeftAnkle]);
  const double sure_m = line.frame.links.sd_m[ankle];
  EXPECT_LT(sure_m, 0.1);
  for (int second = 0; second < 2; ++second) {
    for (int i = 0; i < 60; ++i) {
      line.Quiet();
      ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
    }
    // The made person's poses, of which the basis knows, are all near each other.
    EXPECT_GT(line.frame.links.sd_m[ankle], 1.2 * sure_m) << second;
  }
  EXPECT_EQ(line.frame.input.source, PoseSource::kInsoles) << "nothing else tells anything";
  EXPECT_FALSE(line.frame.input.feet_measured[0]);
  EXPECT_FALSE(line.frame.valid);
  EXPECT_GT(line.frame.momentum.feet[0].variance_m2.x(), 0.25);
}

}  // namespace
}  // namespace footing::pose_service
