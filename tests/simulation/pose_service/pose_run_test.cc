#include "daemon/simulation/pose_service/pose_run.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/simulation/pose_service/pose_run_line.h"

namespace footing::pose_service {
namespace {

TEST(PoseRun, TakesTheTPoseAndThenPublishesTheWholeBody) {
  Line line;
  for (std::size_t i = 0; i < 120; ++i) line.Step(i);
  EXPECT_FALSE(line.frame.t_pose.complete);
  EXPECT_NEAR(line.frame.t_pose.progress, 2.0 / 5, 0.05);
  for (std::size_t i = 120; i < line.measured.size(); ++i) {
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
  }
  EXPECT_TRUE(line.frame.t_pose.complete);
  EXPECT_TRUE(line.frame.valid);
  EXPECT_NEAR(line.frame.t_pose.mass_kg, 70, 0.5);
  EXPECT_EQ(line.frame.links.count, line.person.skeleton.joints.size());
  EXPECT_DOUBLE_EQ(line.frame.time_s,
                   static_cast<double>(line.measured.size()) / made::kMadeRateHz);
}

TEST(PoseRun, ASilentStreamMakesBoardsAndHandsUnknown) {
  Line line;
  for (std::size_t i = 0; i < 10; ++i) line.Step(i);
  EXPECT_TRUE(line.frame.input.feet_measured[0]);
  for (int i = 0; i < 30; ++i) line.Quiet();  // Half a second.
  EXPECT_FALSE(line.frame.input.feet_measured[0]);
  EXPECT_FALSE(line.frame.input.hands_valid[1]);
  line.Step(10);
  EXPECT_TRUE(line.frame.input.feet_measured[0]);
}

TEST(PoseRun, BoardsLostAndBackLeaveAFinitePose) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) line.Step(i);
  ASSERT_TRUE(line.frame.t_pose.complete);
  for (int i = 0; i < 180; ++i) {
    line.Quiet();
    ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
  }
  for (std::size_t i = 0; i < 200; ++i) {
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
  }
  EXPECT_TRUE(line.frame.t_pose.complete) << "the same person is still there";
  EXPECT_TRUE(line.frame.input.feet_measured[0]);
}

TEST(PoseRun, HangingArmsAreNotTakenForATPose) {
  Line line;
  const auto step = [&line](std::size_t i, double lowered_m, double closer) {
    line.told.sensors = line.measured[i];
    for (auto& hand : line.told.sensors.hands) {
      ASSERT_TRUE(hand.valid);
      hand.p_W_m.z() -= lowered_m;
      hand.p_W_m.head<2>() *= closer;
    }
    line.inputs.Write(line.told);
    line.Quiet();
  };
  for (std::size_t i = 0; i < 340; ++i) step(i, 0.6, 0.3);  // More than the five seconds.
  EXPECT_FALSE(line.frame.t_pose.complete);
  EXPECT_EQ(line.frame.t_pose.progress, 0);
  EXPECT_EQ(line.frame.input.hands_off_t_pose, (std::array{true, true}));
  EXPECT_TRUE(line.frame.input.feet_measured[0]);
  EXPECT_NEAR(line.frame.input.load_n[0] + line.frame.input.load_n[1], 70 * 9.80665, 30);
  for (std::size_t i = 0; i < 100; ++i) step(i, 0, 0.3);  // Forward: the height alone is right.
  EXPECT_EQ(line.frame.input.hands_off_t_pose, (std::array{true, true}));
  EXPECT_EQ(line.frame.t_pose.progress, 0);
  for (std::size_t i = 0; i < 310; ++i) step(i, 0, 1);
  EXPECT_EQ(line.frame.input.hands_off_t_pose, (std::array{false, false}));
  EXPECT_TRUE(line.frame.t_pose.complete);
}

TEST(PoseRun, HandsThatAreNotTrackedDoNotDelayTheTPose) {
  Line line;
  for (std::size_t i = 0; i < 310; ++i) {
    line.told.sensors = line.measured[i];
    for (auto& hand : line.told.sensors.hands) hand = {};
    line.inputs.Write(line.told);
    line.Quiet();
  }
  EXPECT_TRUE(line.frame.t_pose.complete);
}

TEST(PoseRun, ACalibrationThatIsAskedForForgetsTheTPose) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) line.Step(i);
  ASSERT_TRUE(line.frame.t_pose.complete);
  ++line.told.calibrate_number;
  line.Step(0);
  EXPECT_FALSE(line.frame.t_pose.complete);
  for (std::size_t i = 0; i < 350; ++i) line.Step(i);
  EXPECT_TRUE(line.frame.t_pose.complete);
}

TEST(PoseRun, TheNextSubjectHasNoStaleTPoseAndTheLastOneComesBackToBeFreed) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) line.Step(i);
  ASSERT_TRUE(line.frame.t_pose.complete);
  ASSERT_TRUE(line.subjects.next.Push(line.Subject(2)));
  line.Step(0);
  EXPECT_EQ(line.frame.subject_number, 1u) << "not before the inputs name it";
  line.told.subject_number = 2;
  line.Step(1);
  EXPECT_EQ(line.frame.subject_number, 2u);
  EXPECT_FALSE(line.frame.t_pose.complete);
  EXPECT_LT(line.frame.t_pose.progress, 0.01);
  std::unique_ptr<SubjectRun> done;
  ASSERT_TRUE(line.subjects.done.Pop(done));
  EXPECT_EQ(done->number, 1u);
}

TEST(PoseRun, AnotherModeKeepsTheTPose) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) line.Step(i);
  ASSERT_TRUE(line.frame.t_pose.complete);
  const double mass_kg = line.frame.t_pose.mass_kg;
  for (const auto mode : {made::Mode::kPaper, made::Mode::kBest}) {
    auto next = line.InMode(line.told.subject_number + 1, mode);
    next->same_person = true;
    ASSERT_TRUE(line.subjects.next.Push(std::move(next)));
    ++line.told.subject_number;
    line.Step(400);
    EXPECT_EQ(line.frame.subject_number, line.told.subject_number);
    EXPECT_TRUE(line.frame.t_pose.complete);
    EXPECT_EQ(line.frame.t_pose.mass_kg, mass_kg);
    EXPECT_TRUE(line.frame.valid);
    ExpectFinite(ToCharacterFrame(line.frame, {}, {}, "boards", "one"));
    std::unique_ptr<SubjectRun> done;
    ASSERT_TRUE(line.subjects.done.Pop(done));
  }
}

TEST(PoseRun, ARecordedInputHasItsMode) {
  made::Options options;
  options.mode = made::Mode::kPaper;
  ASSERT_TRUE(made::LeaveOut({"basis", "angular_momentum"}, options).ok());
  const auto message = ToAppliedInput({}, {}, options, true);
  EXPECT_TRUE(message.pose().same_person());
  const auto back = OptionsFrom(message, {});
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->mode, made::Mode::kPaper);
  EXPECT_EQ(made::LeftOut(*back), (std::vector<std::string>{"angular_momentum", "basis"}));
  auto old = message;
  old.mutable_pose()->clear_mode();
  EXPECT_EQ(OptionsFrom(old, {})->mode, made::Mode::kBest) << "recorded before modes were";
  auto other = message;
  other.mutable_pose()->add_left_out("gravity");
  const auto refused = OptionsFrom(other, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("unknown part gravity"), std::string::npos);
}

TEST(PoseRun, AppliedInputsComeBackBitForBitAndRunAgainToTheSameHash) {
  Line line;
  std::vector<PoseApplied> applied;
  for (std::size_t i = 0; i < line.measured.size(); ++i) {
    if (i % 7 == 3) {
      line.Quiet();
      continue;
    }
    line.told.sensors = line.measured[i];
    line.Press(i);
    if (i % 200 > 150) line.Wear(i);
    if (i % 100 > 70) line.HoldAnArm();
    if (i % 90 > 40) line.SeeJoints(i);
    if (i % 130 > 30) line.Turn(i);
    if (i % 200 == 0) line.told.insoles = {};
    line.inputs.Write(line.told);
    line.run.StepOnSimThread(line.inputs, line.frame);
    for (int k = 0; k < line.frame.applied_count; ++k) {
      const auto message =
          ToAppliedInput(line.frame.applied[static_cast<std::size_t>(k)], {"p1", 1.75, 70, 0}, {});
      EXPECT_EQ(SubjectFrom(message).code, "p1");
      applied.push_back(PoseAppliedFrom(message));
    }
    line.run.FillOnSimThread(line.frame);
    line.run.TakenOnSimThread(line.frame);
  }
  const std::uint64_t hash = line.frame.state_hash, steps = line.frame.step;

  Line again;
  std::size_t next = 0;
  for (std::uint64_t step = 1; step <= steps; ++step) {
    if (next < applied.size() && applied[next].step == step) {
      again.inputs.Write(applied[next++].inputs);
    }
    again.Quiet();
  }
  EXPECT_EQ(next, applied.size());
  EXPECT_EQ(again.frame.state_hash, hash);
}

}  // namespace
}  // namespace footing::pose_service
