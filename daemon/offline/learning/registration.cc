#include "daemon/offline/learning/registration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/body/kinematics.h"
#include "common/base/result.h"
#include "common/base/quantile.h"
#include "common/virtual/motion/edit.h"

namespace footing::learning {
namespace {

constexpr int kRounds = 8;
constexpr double kOutlierMedians = 2.5;  // Of the median distance.

Eigen::Matrix2d Turn(double yaw_rad) {
  return body::AxisRotation(body::Axis::kZ, yaw_rad).topLeftCorner<2, 2>();
}

FloorPlacement Fit(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to,
                   const std::vector<Eigen::Index>& counts) {
  const Eigen::Matrix2Xd a = from(Eigen::all, counts), b = to(Eigen::all, counts);
  const Eigen::Vector2d a_mean = a.rowwise().mean(), b_mean = b.rowwise().mean();
  const Eigen::Matrix2d moment = (b.colwise() - b_mean) * (a.colwise() - a_mean).transpose();
  FloorPlacement placement;
  placement.yaw_rad = std::atan2(moment(1, 0) - moment(0, 1), moment(0, 0) + moment(1, 1));
  placement.shift_m = b_mean - Turn(placement.yaw_rad) * a_mean;
  return placement;
}

}  // namespace

FloorPlacement PlaceFloor(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to) {
  FOOTING_CHECK(from.cols() == to.cols() && from.cols() >= 3);
  std::vector<Eigen::Index> counts(static_cast<std::size_t>(from.cols()));
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<Eigen::Index>(i);
  FloorPlacement placement = Fit(from, to, counts);
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Matrix2Xd moved = (Turn(placement.yaw_rad) * from).colwise() + placement.shift_m;
    const Eigen::VectorXd off_m = (moved - to).colwise().norm();
    const double median_m = text::Median({off_m.begin(), off_m.end()});
    counts.clear();
    double squares = 0;
    for (Eigen::Index i = 0; i < off_m.size(); ++i) {
      if (off_m(i) > kOutlierMedians * median_m + 1e-9) continue;
      counts.push_back(i);
      squares += off_m(i) * off_m(i);
    }
    placement = Fit(from, to, counts);
    placement.points = std::ssize(counts);
    placement.rms_m = std::sqrt(squares / static_cast<double>(counts.size()));
  }
  return placement;
}

motion::Motion Placed(const motion::Motion& motion, const FloorPlacement& placement) {
  motion::Motion placed = motion;
  const Eigen::Matrix3d R = body::AxisRotation(body::Axis::kZ, placement.yaw_rad);
  const Eigen::Vector3d shift_m(placement.shift_m.x(), placement.shift_m.y(), 0);
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const Eigen::Matrix3d R_WJ = body::JointRotation(root, motion.q.col(t));
    body::SetJointRotation(root, R * R_WJ, placed.q.col(t));
    placed.q.col(t).head<3>() = R * motion.q.col(t).head<3>() + shift_m;
  }
  return motion::Continuous(std::move(placed));
}

}  // namespace footing::learning
