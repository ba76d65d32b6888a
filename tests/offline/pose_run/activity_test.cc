#include "daemon/offline/pose_run/activity.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

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

}  // namespace
}  // namespace footing::pose_run
