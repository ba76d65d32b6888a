#include "daemon/offline/learning/alignment.h"

#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/base/result.h"
#include "common/base/quantile.h"
#include "common/base/angle.h"

namespace footing::learning {
namespace {

using body::Landmark;

constexpr double kToeAboveFloorM = 0.015;
constexpr double kPartBelowFloor = 0.02;

void Unwrap(const body::Skeleton& skeleton, Eigen::MatrixXd& q) {
  for (int row = 3; row < skeleton.dof; ++row) {
    for (Eigen::Index t = 1; t < q.cols(); ++t) {
      q(row, t) = NearestTurn(q(row, t), q(row, t - 1));
    }
  }
}

}  // namespace

double Quantile(const Eigen::VectorXd& values, double share) {
  FOOTING_CHECK(values.size() > 0);
  return text::Quantile(std::vector<double>(values.data(), values.data() + values.size()), share);
}

motion::Motion Aligned(const motion::Motion& motion, const body::Landmarks& landmarks) {
  FOOTING_CHECK(motion.frames() > 0);
  const body::Skeleton& skeleton = motion.skeleton;
  body::Kinematics at(skeleton);
  Eigen::Matrix2Xd left_W(2, motion.frames()), feet_W_m(2, motion.frames());
  Eigen::VectorXd lowest_m(motion.frames());
  const auto toe = [&](Landmark end, Landmark ankle) {
    return landmarks[end] >= 0 ? landmarks[end] : landmarks[ankle];
  };
  const int left_toe = toe(Landmark::kLeftToe, Landmark::kLeftAnkle);
  const int right_toe = toe(Landmark::kRightToe, Landmark::kRightAnkle);
  const auto place = [&](int joint) { return at.p_WJ[static_cast<std::size_t>(joint)]; };
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    ComputeKinematics(skeleton, motion.q.col(t), at);
    left_W.col(t) =
        (place(landmarks[Landmark::kLeftHip]) - place(landmarks[Landmark::kRightHip])).head<2>();
    feet_W_m.col(t) = (place(landmarks[Landmark::kLeftAnkle]) + place(left_toe) +
                       place(landmarks[Landmark::kRightAnkle]) + place(right_toe))
                          .head<2>() /
                      4;
    lowest_m(t) = std::min(place(left_toe).z(), place(right_toe).z());
  }
  const Eigen::Vector2d left_mean_W = left_W.rowwise().mean();
  const double yaw_rad = std::atan2(-left_mean_W.x(), left_mean_W.y());  // Of the facing.
  const Eigen::Matrix3d R = body::AxisRotation(body::Axis::kZ, -yaw_rad);
  const Eigen::Matrix2Xd feet_m = R.topLeftCorner<2, 2>() * feet_W_m;
  const Eigen::Vector3d origin_m(Quantile(feet_m.row(0), 0.5), Quantile(feet_m.row(1), 0.5),
                                 Quantile(lowest_m, kPartBelowFloor) - kToeAboveFloorM);

  motion::Motion aligned = motion;
  const body::Joint& root = skeleton.joint(0);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const Eigen::Matrix3d R_WJ = JointRotation(root, motion.q.col(t));
    if (t > 0) {  // The triple of angles nearest to the frame before.
      const auto turning = static_cast<Eigen::Index>(root.rotations.size());
      aligned.q.col(t).segment(root.first_dof, turning) =
          aligned.q.col(t - 1).segment(root.first_dof, turning);
    }
    SetJointRotation(root, R * R_WJ, aligned.q.col(t));
    aligned.q.col(t).head<3>() = R * motion.q.col(t).head<3>() - origin_m;
  }
  Unwrap(skeleton, aligned.q);
  return aligned;
}

}  // namespace footing::learning
