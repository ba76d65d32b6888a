#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/body/kinematics.h"
#include "daemon/simulation/pose_service/publish.h"
#include "tests/simulation/reconstruction/made_person.h"

namespace footing::pose_service {
namespace {

using testing::HasSubstr;

/// 70 kg on both boards, T-pose taken, hands seen.
PoseFrame Well() {
  PoseFrame frame;
  frame.input.feet_measured = {true, true};
  frame.input.hands_valid = {true, true};
  frame.input.load_n = {343, 343};
  frame.t_pose.complete = true;
  frame.valid = true;
  frame.t_pose.mass_kg = 70;
  for (auto& foot : frame.momentum.feet) foot.contact = foot.valid = true;
  return frame;
}

const Subject kSubject{"p07", 1.75, 70, 0};

TEST(PoseNote, SaysNothingWhenAllIsWell) { EXPECT_EQ(PoseNote(Well(), kSubject), ""); }

TEST(PoseNote, SaysThatWhatIsMeasuredFitsNoPose) {
  PoseFrame frame = Well();
  frame.valid = false;
  frame.momentum.valid = true;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("fits no pose"));
  frame.momentum.trusted = false;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("the height by the loads is not certain"));
  frame.momentum.valid = false;  // The boards are what is wrong.
  EXPECT_EQ(PoseNote(frame, kSubject), "");
}

TEST(PoseNote, SaysThatAPartOfTheWeightIsElsewhere) {
  PoseFrame frame = Well();
  frame.valid = frame.momentum.trusted = frame.momentum.whole_weight = false;
  frame.momentum.valid = true;
  frame.momentum.load_share = 0.52;
  EXPECT_EQ(
      PoseNote(frame, kSubject),
      "the boards carry 52 % of the weight of the T-pose: stand on them with both feet, and on "
      "nothing else, or take the T-pose again");
  frame.momentum.load_share = 1.5;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("put down what you carry"));
}

TEST(PoseNote, SaysThatAFootPressesOnTheEdgeOfItsBoard) {
  PoseFrame frame = Well();
  frame.momentum.feet[1].at_edge_s = 1;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("the right foot presses on the edge"));
  frame.t_pose.complete = false;
  frame.input.at_edge = {true, false};
  EXPECT_EQ(PoseNote(frame, kSubject),
            "the left foot presses on the edge of its board: put it in the middle of the board");
}

TEST(PoseNote, SaysThatAFootHasStepped) {
  PoseFrame frame = Well();
  frame.valid = false;
  frame.momentum.valid = true;
  frame.momentum.stepped = true;
  EXPECT_EQ(PoseNote(frame, kSubject),
            "a foot has stepped ahead or back: where the body is, is not certain until it has "
            "stood for some seconds");
}

TEST(PoseNote, LeadsThroughTheTPose) {
  PoseFrame frame = Well();
  frame.t_pose.complete = false;
  frame.input.load_n = {0, 0};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("step on"));
  frame.input.load_n = {600, 86};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("weight on the right foot"));
  frame.input.load_n = {343, 343};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("arms out to the sides"));
  frame.input.hands_off_t_pose = {true, true};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("raise both arms"));
  frame.input.hands_off_t_pose = {false, true};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("raise the right arm"));
  frame.input.hands_off_t_pose = {};
  frame.t_pose.progress = 0.5;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("hold still, 2.5 s more"));
  frame.t_pose.progress = 0;
  frame.t_pose.restarts = 1;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("you moved"));
}

TEST(PoseNote, NamesTheBoardThatIsLost) {
  PoseFrame frame = Well();
  frame.input.feet_measured[1] = false;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("the right board"));
  frame.input.feet_measured[0] = false;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("are both on"));
}

TEST(PoseNote, NamesTheFootThatIsOffAndTheHandThatIsNotSeen) {
  PoseFrame frame = Well();
  frame.momentum.feet[0].contact = false;
  frame.momentum.feet[0].airborne_s = 0.3;
  EXPECT_EQ(PoseNote(frame, kSubject), "") << "a step is no fault";
  frame.momentum.feet[0].airborne_s = 1.2;
  frame.input.hands_valid[1] = false;
  const std::string note = PoseNote(frame, kSubject);
  EXPECT_THAT(note, HasSubstr("left foot is off its board for 1.2 s"));
  EXPECT_THAT(note, HasSubstr("right hand is not seen"));
}

TEST(PoseNote, SaysWhatAWiimoteLacksAndWhatToDo) {
  PoseFrame frame = Well();
  frame.input.hands_valid = {false, false};
  EXPECT_EQ(PoseNote(frame, kSubject), "no hand is seen");
  frame.input.arms_valid = {true, true};
  EXPECT_EQ(PoseNote(frame, kSubject), "");
  frame.input.arms_valid[0] = false;
  frame.input.hand_trouble[0] = HandTrouble::kSilent;
  EXPECT_EQ(PoseNote(frame, kSubject), "nothing comes from the left Wiimote: its arm is guessed");
  frame.input.hand_trouble[0] = HandTrouble::kAwaitsTPose;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("take the T-pose again"));
  frame.input.arms_valid[1] = false;
  frame.input.hand_trouble = {HandTrouble::kNoGyroscope, HandTrouble::kNoModel};
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("is a MotionPlus in it?"));
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("the right Wiimote is not followed"));
  frame.input.hands_valid = {true, true};
  EXPECT_EQ(PoseNote(frame, kSubject), "") << "a tracker sees both";
}

TEST(PoseNote, SpeaksOfInsolesToWhoWalksInThem) {
  PoseFrame frame = Well();
  frame.input.source = PoseSource::kInsoles;
  EXPECT_EQ(PoseNote(frame, kSubject), "");
  frame.input.feet_measured[1] = false;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("the right insole"));
  frame.input.feet_measured[0] = false;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("nothing comes from the insoles"));
  frame = Well();
  frame.input.insoles_idle = true;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("best mode without lag"));
  frame = Well();
  frame.input.insoles_await = true;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("insoles need a T-pose of their own"));
}

TEST(PoseNote, AnotherPersonsWeightIsToldFromThreePercentOn) {
  PoseFrame frame = Well();
  frame.t_pose.mass_kg = 71.9;
  EXPECT_EQ(PoseNote(frame, kSubject), "");
  frame.t_pose.mass_kg = 72.3;
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("72.3 kg"));
  EXPECT_THAT(PoseNote(frame, kSubject), HasSubstr("is it p07"));
}

TEST(PoseEvents, ABoardLostAndBackIsToldOnceEach) {
  PoseEvents events;
  PoseFrame frame = Well();
  events.Between(frame, kSubject, 1);
  EXPECT_EQ(events.Between(frame, kSubject, 2).events_size(), 0);
  frame.input.feet_measured[0] = false;
  const v1::Events lost = events.Between(frame, kSubject, 3);
  ASSERT_EQ(lost.events_size(), 1);
  EXPECT_EQ(lost.events(0).kind(), v1::Event::KIND_STREAM_LOST);
  EXPECT_EQ(events.Between(frame, kSubject, 4).events_size(), 0);
  frame.input.feet_measured[0] = true;
  EXPECT_EQ(events.Between(frame, kSubject, 5).events(0).kind(), v1::Event::KIND_STREAM_BACK);
}

TEST(PoseEvents, TheSourceThatIsFollowedIsNamed) {
  PoseEvents events;
  PoseFrame frame = Well();
  events.Between(frame, kSubject, 1);
  frame.input.source = PoseSource::kInsoles;
  EXPECT_THAT(events.Between(frame, kSubject, 2).events(0).text(),
              HasSubstr("follows the insoles"));
  frame.input.feet_measured = {false, true};
  EXPECT_THAT(events.Between(frame, kSubject, 3).events(0).text(), HasSubstr("an insole is lost"));
}

TEST(PoseEvents, AWiimoteLostAndBackIsToldOnceEach) {
  PoseEvents events;
  PoseFrame frame = Well();
  events.Between(frame, kSubject, 1);
  frame.input.hand_trouble[1] = HandTrouble::kSilent;
  const v1::Events lost = events.Between(frame, kSubject, 2);
  ASSERT_EQ(lost.events_size(), 1);
  EXPECT_EQ(lost.events(0).kind(), v1::Event::KIND_STREAM_LOST);
  EXPECT_THAT(lost.events(0).text(), HasSubstr("the right Wiimote"));
  EXPECT_EQ(events.Between(frame, kSubject, 3).events_size(), 0);
  frame.input.hand_trouble[1] = HandTrouble::kNone;
  EXPECT_EQ(events.Between(frame, kSubject, 4).events(0).kind(), v1::Event::KIND_STREAM_BACK);
}

TEST(PoseEvents, TheNextSubjectIsNamed) {
  PoseEvents events;
  PoseFrame frame = Well();
  events.Between(frame, kSubject, 1);
  frame.subject_number = 2;
  frame.t_pose.complete = false;
  const v1::Events next = events.Between(frame, {"p08", 1.6, 0, 0}, 2);
  ASSERT_EQ(next.events_size(), 1);
  EXPECT_THAT(next.events(0).text(), HasSubstr("p08"));
  frame.t_pose.complete = true;
  EXPECT_THAT(events.Between(frame, {"p08", 1.6, 0, 0}, 3).events(0).text(), HasSubstr("70.0 kg"));
}

TEST(PosePublish, TheSkeletonHasALinkForEveryJointWithItsParent) {
  const body::Body person = reconstruction::MadePerson();
  const stream::Skeleton skeleton = ToSkeleton(person);
  ASSERT_EQ(skeleton.links.size(), person.skeleton.joints.size());
  for (std::size_t i = 0; i < skeleton.links.size(); ++i) {
    EXPECT_EQ(skeleton.links[i].name, person.skeleton.joints[i].name);
    EXPECT_EQ(skeleton.links[i].parent, person.skeleton.joints[i].parent);
    EXPECT_GT(skeleton.links[i].size_m.minCoeff(), 0);
  }
}

TEST(SubjectBody, HasTheSubjectsHeightAndWeight) {
  const auto body = MakeSubjectBody({"a", 1.62, 58, 0});
  ASSERT_TRUE(body.ok());
  EXPECT_DOUBLE_EQ(body->height_m, 1.62);
  EXPECT_NEAR(body->mass_kg, 58, 1e-9);
}

TEST(SubjectBody, WithoutAWeightItIsAnAverageOne) {
  const auto body = MakeSubjectBody({"a", 2.0, 0, 0});
  ASSERT_TRUE(body.ok());
  EXPECT_NEAR(body->mass_kg, 22.5 * 4, 1e-9);
}

TEST(SubjectBody, AKnownFootIsAsLongAsItWasMeasured) {
  const auto body = MakeSubjectBody({"a", 1.75, 70, 0.30});
  ASSERT_TRUE(body.ok());
  body::Kinematics at(body->skeleton);
  body::ComputeKinematics(body->skeleton, body::TPose(body->skeleton, body->landmarks), at);
  const auto place = [&](body::Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body->landmarks[landmark])];
  };
  const Eigen::Vector3d to_tip =
      place(body::Landmark::kLeftToeEnd) - place(body::Landmark::kLeftAnkle);
  // The ankle is a quarter of the foot ahead of the heel.
  EXPECT_NEAR(to_tip.head<2>().norm(), 0.75 * 0.30, 0.01);
}

}  // namespace
}  // namespace footing::pose_service
