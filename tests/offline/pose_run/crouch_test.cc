#include "daemon/offline/pose_run/crouch.h"

#include <gtest/gtest.h>

namespace footing::pose_run {
namespace {

using body::Landmark;

/// Frames of somebody on both feet; the first one is in the T-pose.
struct CrouchStage {
  PoseRun run;

  CrouchStage() {
    const body::Skeleton skeleton = body::StandardPerson(1.75);
    run.body = body::MakeBody(skeleton, {}).value();
    Add();
  }
  Frame& Add() {
    Frame frame;
    frame.q = body::TPose(run.body.skeleton, run.body.landmarks);
    frame.feet[0].load_n = frame.feet[1].load_n = 370;
    run.frames.push_back(frame);
    return run.frames.back();
  }
  void Turn(Frame& frame, Landmark landmark, double deg) const {
    const body::Joint& joint = run.body.skeleton.joint(run.body.landmarks[landmark]);
    body::SetJointRotation(joint, body::AxisRotation(body::Axis::kY, DegreesToRadians(deg)),
                           frame.q);
  }
  void Squat(Frame& frame, double knee_deg) const {
    for (const Landmark hip : {Landmark::kLeftHip, Landmark::kRightHip}) Turn(frame, hip, -80);
    for (const Landmark knee : {Landmark::kLeftKnee, Landmark::kRightKnee})
      Turn(frame, knee, knee_deg);
  }
};

TEST(DeepestCrouch, BendsEveryKneeAndHip) {
  CrouchStage stage;
  stage.Squat(stage.Add(), 50);
  stage.Squat(stage.Add(), 70);
  stage.Squat(stage.Add(), 60);
  const Crouch crouch = DeepestCrouch(stage.run, 0);
  EXPECT_EQ(crouch.frame, 2u);
  EXPECT_NEAR(RadiansToDegrees(crouch.bend_rad), 70, 5);  // Less by how far apart the legs are.
  EXPECT_GT(crouch.bend_rad, kCrouchRad);
}

TEST(DeepestCrouch, IsNeitherABowNorARaisedKneeNorAJump) {
  CrouchStage stage;
  Frame& bow = stage.Add();
  bow.com_m.z() = 0.1;
  for (const Landmark hip : {Landmark::kLeftHip, Landmark::kRightHip}) stage.Turn(bow, hip, -90);
  Frame& knee = stage.Add();
  stage.Turn(knee, Landmark::kLeftHip, -90);
  stage.Turn(knee, Landmark::kLeftKnee, 90);
  Frame& jump = stage.Add();
  stage.Squat(jump, 90);
  jump.feet[0].load_n = jump.feet[1].load_n = 0;
  EXPECT_LT(DeepestCrouch(stage.run, 0).bend_rad, kCrouchRad / 2);
}

TEST(DeepestCrouch, IsLookedForFromTheGivenFrameOn) {
  CrouchStage stage;
  stage.Squat(stage.Add(), 90);
  stage.Squat(stage.Add(), 60);
  EXPECT_EQ(DeepestCrouch(stage.run, 2).frame, 2u);
}

}  // namespace
}  // namespace footing::pose_run
