#include "daemon/simulation/reconstruction/head_seat.h"

#include <gtest/gtest.h>

#include "common/body/points.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

constexpr double kCapM = 0.15;

struct HeadSeatTest : testing::Test {
  World world;
  SubjectModel model = BestSubjectModel(world.person, world.models, world.AtRate()).value();

  /// A sphere `above_m` the middle of the head, fixed to it, in a pose.
  JointInputs Sphere(const body::Kinematics& at, double above_m) const {
    body::Point point = model.joints[kHeadJoint];
    point.p_J_m += model.t_pose_at.R_WJ[static_cast<std::size_t>(point.joint)].transpose() *
                   Eigen::Vector3d(0, 0, above_m);
    JointInputs joints;
    joints[kHeadJoint].valid = true;
    joints[kHeadJoint].p_W_m = body::Place(point, at);
    joints[kHeadJoint].sd_m.setConstant(0.01);
    return joints;
  }
  /// The mean error of the neck over the motion, with a sphere `above_m` the head.
  double NeckErrorM(double above_m, bool seen_in_t_pose) {
    Reconstruction run = world.Made(world.AtRate());
    const auto neck = static_cast<std::size_t>(world.person.landmarks[body::Landmark::kNeck]);
    double sum_m = 0, frames = 0;
    for (std::size_t i = 0; i < world.inputs.size(); ++i) {
      body::ComputeKinematics(world.person.skeleton,
                              world.motion.q.col(static_cast<Eigen::Index>(i)), world.at);
      Inputs inputs = world.inputs[i];
      if (seen_in_t_pose || run.output().calibrated) inputs.joints = Sphere(world.at, above_m);
      run.Advance(inputs);
      EXPECT_TRUE(Finite(run.output())) << i;
      if (i < 400) continue;
      sum_m += (run.output().p_WJ_m[neck] - world.at.p_WJ[neck]).norm();
      ++frames;
    }
    return sum_m / frames;
  }
};

TEST_F(HeadSeatTest, ACapIsWhereThePoseHasItAfterTheTPose) {
  const body::Point& middle = model.joints[kHeadJoint];
  HeadSeat seat;
  seat.Start(middle);
  for (int i = 0; seat.Seeks(); ++i) {
    ASSERT_LT(i, 51);
    EXPECT_FALSE(seat.found());
    JointInputs joints = Sphere(model.t_pose_at, kCapM);
    joints[kHeadJoint].valid = i >= 4;  // A tracker is late.
    seat.See(joints, model.t_pose_at, 0.01);
  }
  ASSERT_TRUE(seat.found());
  const Eigen::Vector3d off_m =
      body::Place(seat.point(), model.t_pose_at) - body::Place(middle, model.t_pose_at);
  EXPECT_LT((off_m - Eigen::Vector3d(0, 0, kCapM)).norm(), 1e-9);
  seat.See(Sphere(model.t_pose_at, 1), model.t_pose_at, 0.01);
  EXPECT_LT(
      (body::Place(seat.point(), model.t_pose_at) - body::Place(middle, model.t_pose_at)).norm(),
      kCapM + 1e-9)
      << "it is found once";
  seat.Start(middle);
  EXPECT_TRUE(seat.Seeks());
  EXPECT_EQ(seat.point().p_J_m, middle.p_J_m);
}

TEST_F(HeadSeatTest, ASkeletonsHeadAndOneSeldomSeenFarOffOrRoughHaveNoSeat) {
  const body::Point& middle = model.joints[kHeadJoint];
  HeadSeat skeletons, seldom, far, rough;
  for (HeadSeat* seat : {&skeletons, &seldom, &far, &rough}) seat->Start(middle);
  for (int i = 0; far.Seeks(); ++i) {
    JointInputs joints = Sphere(model.t_pose_at, kCapM);
    joints[kHeadJoint].valid = i % 3 == 0;
    seldom.See(joints, model.t_pose_at, 0.01);
    for (JointInput& joint : joints) joint.valid = true;
    skeletons.See(joints, model.t_pose_at, 0.01);
    JointInputs kinect = Sphere(model.t_pose_at, 0.04);
    kinect[kHeadJoint].sd_m.setConstant(0.043);
    rough.See(kinect, model.t_pose_at, 0.01);
    far.See(Sphere(model.t_pose_at, 0.4), model.t_pose_at, 0.01);
  }
  for (HeadSeat* seat : {&skeletons, &seldom, &far, &rough}) {
    EXPECT_FALSE(seat->Seeks() || seat->found());
    EXPECT_EQ(seat->point().p_J_m, middle.p_J_m);
  }
}

TEST_F(HeadSeatTest, ACapShowsTheTrunkAsWellAsAPointWithinTheHead) {
  const double none_m = NeckErrorM(10, false);  // Not plausible: as if there were none.
  const double cap_m = NeckErrorM(kCapM, true), within_m = NeckErrorM(0, true);
  EXPECT_LT(cap_m, 0.9 * none_m);
  EXPECT_NEAR(cap_m, within_m, 0.003);
}

}  // namespace
}  // namespace footing::reconstruction
