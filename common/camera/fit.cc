#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/camera/camera_pose.h"
#include "common/base/result.h"
#include "common/base/rotation.h"

namespace footing::camera_pose {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
/// Turn, shift, the common error of depth, scale about the camera.
constexpr int kUnknowns = 8;
constexpr int kCommon = 6, kScale = 7;
using Column = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Rows = Eigen::Matrix<double, 3, kUnknowns>;

constexpr int kIterations = 15;
constexpr double kUnknownM = 10;  // Standard deviation of what is not known.

/// Kabsch: the turn and shift that bring the seen marks nearest to their places, all alike.
Eigen::Isometry3d Start(const std::vector<SeenMark>& marks) {
  Eigen::Matrix3Xd seen(3, marks.size()), places(3, marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    seen.col(static_cast<Eigen::Index>(i)) = marks[i].seen.p_C_m;
    places.col(static_cast<Eigen::Index>(i)) = marks[i].p_W_m;
  }
  return Eigen::Isometry3d(Eigen::umeyama(seen, places, false));
}

/// The estimate with the scale as a parameter, or held at 1.
struct Solution {
  Eigen::Isometry3d X_WC;
  double common = 0;  ///< Error of depth that all points share, in standard deviations.
  double scale = 1;
  Normal covariance;
  double misfit = 0;
};

/// Sums of weighted rows.
struct Sums {
  Normal normal = Normal::Zero();
  Column gradient = Column::Zero();
  double misfit = 0;
  int rows = 0;

  void Add(const Rows& jacobian, const Vector3d& error, const Matrix3d& covariance, int count) {
    const Eigen::LDLT<Matrix3d> weight(covariance);
    normal += jacobian.transpose() * weight.solve(jacobian);
    gradient += jacobian.transpose() * weight.solve(error);
    misfit += error.dot(weight.solve(error));
    rows += count;
  }
  /// The unknown is 0 with a standard deviation of 1.
  void AddPrior(int unknown, double error) {
    normal(unknown, unknown) += 1;
    gradient[unknown] += error;
    misfit += error * error;
    rows += 1;
  }
};

/// Of a point's depth: half its variance is taken as common to all points (blur and limb of the
/// camera file, light from within the sphere), half as its own (its pixels).
constexpr double kCommonShare = 0.5;

/// One standard deviation of what is common, along the point's ray.
Vector3d CommonSd(const SeenPoint& seen) {
  const Vector3d along = seen.covariance_m2 * seen.p_C_m;
  const double variance = seen.p_C_m.dot(along);
  return variance > 0 ? Vector3d(std::sqrt(kCommonShare / variance) * along) : Vector3d::Zero();
}

Matrix3d OwnCovariance(const SeenPoint& seen) {
  const Vector3d common_sd = CommonSd(seen);
  return seen.covariance_m2 - common_sd * common_sd.transpose();
}

void AddMark(const SeenMark& mark, const Solution& at, double placement_sd_m, Sums& sums) {
  const Matrix3d& turn = at.X_WC.linear();
  const Vector3d common_sd = turn * CommonSd(mark.seen);
  const Vector3d arm = at.scale * (turn * mark.seen.p_C_m);
  const Vector3d place = arm + at.X_WC.translation() - at.common * common_sd;
  Rows jacobian;
  jacobian << -CrossMatrix(place), Matrix3d::Identity(), -common_sd, arm / at.scale;
  const Matrix3d covariance = turn * OwnCovariance(mark.seen) * turn.transpose() +
                              placement_sd_m * placement_sd_m * Matrix3d::Identity();
  sums.Add(jacobian, mark.p_W_m - place, covariance, 3);
}

/// The line from low to high has no level part; how long it is nobody knows.
void AddPlumb(const SeenPlumb& plumb, const Solution& at, double placement_sd_m, Sums& sums) {
  const Matrix3d& turn = at.X_WC.linear();
  const Vector3d common_sd = turn * (CommonSd(plumb.high) - CommonSd(plumb.low));
  const Vector3d line =
      at.scale * (turn * (plumb.high.p_C_m - plumb.low.p_C_m)) - at.common * common_sd;
  Rows jacobian;
  jacobian << -CrossMatrix(line), Matrix3d::Zero(), -common_sd, Vector3d::Zero();
  const double leaning_m = line.norm() * std::sin(plumb.tilt_rad);
  Matrix3d covariance =
      turn * (OwnCovariance(plumb.low) + OwnCovariance(plumb.high)) * turn.transpose();
  covariance +=
      (2 * placement_sd_m * placement_sd_m + leaning_m * leaning_m / 2) * Matrix3d::Identity();
  covariance(2, 2) += kUnknownM * kUnknownM;
  sums.Add(jacobian, Vector3d(-line.x(), -line.y(), 0), covariance, 2);
}

Solution Solve(const Observations& observations, bool with_scale) {
  Solution solution;
  solution.X_WC = Start(observations.marks);
  const int unknowns = with_scale ? kUnknowns : kScale;
  for (int i = 0; i <= kIterations; ++i) {
    Sums sums;
    for (const SeenMark& mark : observations.marks)
      AddMark(mark, solution, observations.placement_sd_m, sums);
    for (const SeenPlumb& plumb : observations.plumbs)
      AddPlumb(plumb, solution, observations.placement_sd_m, sums);
    sums.AddPrior(kCommon, -solution.common);
    const Eigen::MatrixXd inverse = sums.normal.topLeftCorner(unknowns, unknowns)
                                        .ldlt()
                                        .solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
    solution.misfit = sums.misfit / std::max(1, sums.rows - unknowns);
    solution.covariance.setZero();
    solution.covariance.topLeftCorner(unknowns, unknowns) = inverse;
    if (i == kIterations) break;
    const Eigen::VectorXd step = inverse * sums.gradient.head(unknowns);
    const Vector3d turn = step.head<3>();
    const Eigen::AngleAxisd rotation(turn.norm(), turn.stableNormalized());
    Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0) change.linear() = rotation.toRotationMatrix();
    change.translation() = step.segment<3>(3);
    solution.X_WC = change * solution.X_WC;
    solution.common += step[kCommon];
    if (with_scale) solution.scale += step[kScale];
  }
  return solution;
}

double Tilt(const Observations& observations, const Eigen::Isometry3d& X_WC) {
  Vector3d up = Vector3d::Zero();
  for (const SeenPlumb& plumb : observations.plumbs)
    up += X_WC.linear() * (plumb.high.p_C_m - plumb.low.p_C_m);
  return observations.plumbs.empty() ? 0 : std::atan2(up.head<2>().norm(), up.z());
}

}  // namespace

CameraPose Fit(const Observations& observations) {
  FOOTING_CHECK(observations.marks.size() >= 3);
  CameraPose pose;
  const Solution rigid = Solve(observations, false);
  const Solution scaled = Solve(observations, true);
  pose.X_WC = rigid.X_WC;
  pose.covariance = rigid.covariance.topLeftCorner<6, 6>();
  pose.misfit = rigid.misfit;
  pose.scale = scaled.scale;
  pose.scale_sd = std::sqrt(scaled.covariance(kScale, kScale));
  double square = 0;
  for (const SeenMark& mark : observations.marks) {
    pose.residuals_m.push_back((mark.p_W_m - pose.X_WC * mark.seen.p_C_m).norm());
    square += pose.residuals_m.back() * pose.residuals_m.back();
  }
  pose.residual_rms_m = std::sqrt(square / static_cast<double>(pose.residuals_m.size()));
  Observations marks_only = observations;
  marks_only.plumbs.clear();
  pose.tilt_rad =
      observations.plumbs.empty() ? 0 : Tilt(observations, Solve(marks_only, false).X_WC);
  return pose;
}

Matrix3d CameraPose::CovarianceAt(const Vector3d& p_W_m) const {
  Eigen::Matrix<double, 3, 6> rows;
  rows << -CrossMatrix(p_W_m), Matrix3d::Identity();
  return rows * covariance * rows.transpose();
}

double CameraPose::TurnSdRad() const {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> turn(covariance.topLeftCorner<3, 3>());
  return std::sqrt(turn.eigenvalues().maxCoeff());
}

}  // namespace footing::camera_pose
