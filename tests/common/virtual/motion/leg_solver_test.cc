#include "common/virtual/motion/leg_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace footing::motion {
namespace {

using body::Landmark;

class Leg : public testing::Test {
 protected:
  body::Kinematics At(const Eigen::VectorXd& q) const {
    body::Kinematics at(body_.skeleton);
    body::ComputeKinematics(body_.skeleton, q, at);
    return at;
  }
  Eigen::Vector3d Place(const Eigen::VectorXd& q, Landmark landmark) const {
    return At(q).p_WJ[static_cast<std::size_t>(body_.landmarks[landmark])];
  }
  /// The left foot's place of the T-pose, `by_m` further.
  FootPlace Moved(const Eigen::Vector3d& by_m) const {
    const body::Kinematics at = At(t_pose_);
    const auto ankle = static_cast<std::size_t>(body_.landmarks[Landmark::kLeftAnkle]);
    return {at.p_WJ[ankle] + by_m, at.R_WJ[ankle]};
  }

  body::Body body_ = body::MakeBody(body::StandardPerson(1.75), {}).value();
  Eigen::VectorXd t_pose_ = body::TPose(body_.skeleton, body_.landmarks);
};

TEST_F(Leg, ThighIsNotTurnedInTheTPose) {
  for (const bool left : {true, false}) {
    EXPECT_NEAR(LegSolver(body_, left).ThighTurn(At(t_pose_)), 0, 1e-9);
  }
}

TEST_F(Leg, ThighTurnIsTheTurnAboutTheThighAlone) {
  const int hip = body_.landmarks[Landmark::kLeftHip];
  Eigen::VectorXd q = t_pose_;
  const Eigen::Matrix3d turn =  // About itself, then ahead by half a right angle.
      body::AxisRotation(body::Axis::kY, -0.8) * body::AxisRotation(body::Axis::kZ, 0.3);
  body::SetJointRotation(body_.skeleton.joint(hip),
                         turn * At(t_pose_).R_WJ[static_cast<std::size_t>(hip)], q);
  EXPECT_NEAR(LegSolver(body_, true).ThighTurn(At(q)), 0.3, 1e-6);
}

TEST_F(Leg, KneeBendsAheadWithTheThighTurnedAsAsked) {
  LegSolver leg(body_, true, LegAim::kWhole);
  for (const Eigen::Vector3d& by_m :
       {Eigen::Vector3d(0, 0, 0.002), Eigen::Vector3d(0, 0.2, 0.05), Eigen::Vector3d(0, 0.3, 0.08),
        Eigen::Vector3d(0.2, 0.05, 0.1), Eigen::Vector3d(-0.2, 0, 0.1),
        Eigen::Vector3d(0.1, -0.05, 0.2)}) {
    for (const double turn_rad : {0.0, 0.3, -0.3}) {
      FootPlace place = Moved(by_m);
      place.thigh_turn_rad = turn_rad;
      Eigen::VectorXd q = t_pose_;
      leg.BendKnee(0.2, q);
      EXPECT_LT(leg.Solve(place, q), 1e-3) << by_m.transpose();
      EXPECT_NEAR(leg.ThighTurn(At(q)), turn_rad, 0.01) << by_m.transpose();
      EXPECT_LT((Place(q, Landmark::kLeftAnkle) - place.p_WA).norm(), 1e-3);
      // Ahead of the line from hip to ankle, as the thigh looks.
      const Eigen::Vector3d hip = Place(q, Landmark::kLeftHip),
                            knee = Place(q, Landmark::kLeftKnee);
      const Eigen::Vector3d along = (place.p_WA - hip).normalized();
      const Eigen::Vector3d off_m = knee - hip - along * along.dot(knee - hip);
      EXPECT_GT(off_m.x(), 0.8 * off_m.norm()) << by_m.transpose() << " turned " << turn_rad;
    }
  }
}

TEST_F(Leg, SolvedLegStaysAsItIs) {
  LegSolver leg(body_, true, LegAim::kWhole);
  FootPlace place = Moved({0.1, 0.1, 0.1});
  Eigen::VectorXd q = t_pose_;
  leg.BendKnee(0.2, q);
  leg.Solve(place, q);
  Eigen::VectorXd again = q;
  leg.Solve(place, again);
  EXPECT_LT((again - q).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace footing::motion
