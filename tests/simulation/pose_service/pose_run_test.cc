#include "daemon/simulation/pose_service/pose_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "daemon/simulation/pose_service/pose_applied.h"
#include "tests/simulation/reconstruction/made_person.h"

namespace footing::pose_service {
namespace {

namespace made = reconstruction;

/// A person who stands in a T-pose for 6 s and then moves, in the steps of the simulation thread.
struct Line {
  explicit Line(double seconds = 8)
      : person(made::MadePerson()),
        motion(made::MadeMotion(person, seconds)),
        measured(made::Measured(person, motion)),
        models(made::MakeModels({made::BasisOf(person, motion)}).value()),
        run(Subject(1), made::kMadeRateHz, subjects) {
    told.subject_number = 1;
  }

  std::unique_ptr<SubjectRun> Subject(std::uint64_t number) const {
    made::Options options;
    options.rate_hz = made::kMadeRateHz;
    return std::make_unique<SubjectRun>(
        SubjectRun{number, made::Reconstruction::Create(person, models, options).value(),
                   made::InsoleWalk::Create(person, models, options).value()});
  }
  /// The person wears insoles, too: all of a foot's load in one cell under its middle.
  void Wear(std::size_t i) {
    const made::Inputs& seen = measured[i % measured.size()];
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      told.insoles[f].valid = true;
      told.insoles[f].count = 1;
      told.insoles[f].p_S_m[0] = {0.11, 0};
      told.insoles[f].load_n[0] = momentum::PressureOf(seen.loads.feet[f], 1).total_n;
    }
  }
  /// What the boards have felt until the i-th frame, which comes at once.
  void Press(std::size_t i) {
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const momentum::FootLoads& foot = measured[i].loads.feet[f];
      std::array<double, board::kCorners> load_n{};
      for (std::size_t k = 0; k < board::kCorners; ++k) load_n[k] = foot.cells[k].load_n;
      meters[f].Add(1 + static_cast<double>(i) / made::kMadeRateHz, load_n);
      told.impulses[f] = meters[f].impulse();
    }
  }
  /// The left hand is not seen, but a Wiimote tells of its arm.
  void HoldAnArm() {
    told.sensors.hands[0].valid = false;
    told.sensors.arms[0].valid = true;
    told.sensors.arms[0].directions.upper = Eigen::Vector3d(0.3, 0.8, -0.4).normalized();
  }
  /// A camera sees two joints, one of them with errors that depend on each other.
  void SeeJoints(std::size_t i) {
    made::JointInputs& joints = told.sensors.joints;
    joints = {};
    joints[0] = {true, {0.01, 0, 1.6 + 1e-4 * static_cast<double>(i % 10)}, {0.04, 0.05, 0.1}};
    joints[7] = {true, {0, 0.1, 0.9}, {0.04, 0.05, 0.1}, {0.001, -0.0005, 0.002}};
    told.sensors.hands[0].of_skeleton = i % 2 == 0;
  }
  /// One step with the i-th frame that was measured.
  void Step(std::size_t i) {
    told.sensors = measured[i % measured.size()];
    inputs.Write(told);
    Quiet();
  }
  /// One step without a word of the sensors.
  void Quiet() {
    run.StepOnSimThread(inputs, frame);
    run.FillOnSimThread(frame);
    run.TakenOnSimThread(frame);
  }

  body::Body person;
  motion::Motion motion;
  std::vector<made::Inputs> measured;
  made::Models models;
  SubjectExchange subjects;
  PoseRun run;
  exchange::Latest<PoseInputs> inputs;
  PoseInputs told;
  std::array<board::ImpulseMeter, momentum::kFeet> meters;
  PoseFrame frame;
};

void ExpectFinite(const v1::CharacterFrame& message) {
  for (const v1::LinkPose& link : message.characters(0).links()) {
    for (const double number : {link.position_m().x(), link.position_m().y(), link.position_m().z(),
                                link.orientation().w(), link.orientation().x(),
                                link.orientation().y(), link.orientation().z()}) {
      ASSERT_TRUE(std::isfinite(number));
    }
  }
  for (const double sd_m : message.characters(0).body().link_sd_m()) {
    ASSERT_TRUE(std::isfinite(sd_m) && sd_m >= 0);
  }
}

TEST(PoseRun, TakesTheTPoseAndThenPublishesTheWholeBody) {
  Line line;
  for (std::size_t i = 0; i < 120; ++i) line.Step(i);
  EXPECT_FALSE(line.frame.t_pose.complete);
  EXPECT_NEAR(line.frame.t_pose.progress, 2.0 / 5, 0.05);
  for (std::size_t i = 120; i < line.measured.size(); ++i) {
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, "best", "boards", "one"));
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
    ExpectFinite(ToCharacterFrame(line.frame, {}, "best", "boards", "one"));
  }
  for (std::size_t i = 0; i < 200; ++i) {
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, "best", "boards", "one"));
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
    if (i % 200 == 0) line.told.insoles = {};
    line.inputs.Write(line.told);
    line.run.StepOnSimThread(line.inputs, line.frame);
    for (int k = 0; k < line.frame.applied_count; ++k) {
      const auto message =
          ToAppliedInput(line.frame.applied[static_cast<std::size_t>(k)], {"p1", 1.75, 70, 0});
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

TEST(PoseRun, InsolesAreFollowedWhileTheyTellAndBoardsKnowThePersonWhenTheyStop) {
  Line line;
  for (std::size_t i = 0; i < 400; ++i) {
    line.Wear(i);
    line.Step(i);
    ExpectFinite(ToCharacterFrame(line.frame, {}, "best", "boards", "one"));
  }
  const auto message = ToCharacterFrame(line.frame, {}, "best", "boards", "one");
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
      ExpectFinite(ToCharacterFrame(line.frame, {}, "best", "boards", "one"));
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
