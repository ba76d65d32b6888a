#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/camera_pose/camera_pose.h"
#include "common/result/result.h"

namespace footing::camera_pose {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Column = Eigen::Matrix<double, 7, 1>;  // Turn, shift, scale about the camera.
using Normal = Eigen::Matrix<double, 7, 7>;
using Rows = Eigen::Matrix<double, 3, 7>;

constexpr int kIterations = 15;
constexpr double kUnknownM = 10;  // Standard deviation of what is not known.

Matrix3d Cross(const Vector3d& v) {
  Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

/// Kabsch: the turn and shift that bring the seen marks nearest to their places, all alike.
Eigen::Isometry3d Start(const std::vector<SeenMark>& marks) {
  Eigen::Matrix3Xd seen(3, marks.size()), places(3, marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    seen.col(static_cast<Eigen::Index>(i)) = marks[i].seen.p_C_m;
    places.col(static_cast<Eigen::Index>(i)) = marks[i].p_W_m;
  }
  return Eigen::Isometry3d(Eigen::umeyama(seen, places, false));
}

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
};

void AddMark(const SeenMark& mark, const Eigen::Isometry3d& X_WC, double scale,
             double placement_sd_m, Sums& sums) {
  const Vector3d arm = scale * (X_WC.linear() * mark.seen.p_C_m);
  const Vector3d place = arm + X_WC.translation();
  Rows jacobian;
  jacobian << -Cross(place), Matrix3d::Identity(), arm / scale;
  const Matrix3d covariance = X_WC.linear() * mark.seen.covariance_m2 * X_WC.linear().transpose() +
                              placement_sd_m * placement_sd_m * Matrix3d::Identity();
  sums.Add(jacobian, mark.p_W_m - place, covariance, 3);
}

/// The line from low to high has no level part; how long it is nobody knows.
void AddPlumb(const SeenPlumb& plumb, const Eigen::Isometry3d& X_WC, double scale,
              double placement_sd_m, Sums& sums) {
  const Vector3d line = scale * (X_WC.linear() * (plumb.high.p_C_m - plumb.low.p_C_m));
  Rows jacobian;
  jacobian << -Cross(line), Matrix3d::Zero(), Vector3d::Zero();
  const double leaning_m = line.norm() * std::sin(plumb.tilt_rad);
  Matrix3d covariance = X_WC.linear() * (plumb.low.covariance_m2 + plumb.high.covariance_m2) *
                        X_WC.linear().transpose();
  covariance +=
      (2 * placement_sd_m * placement_sd_m + leaning_m * leaning_m / 2) * Matrix3d::Identity();
  covariance(2, 2) += kUnknownM * kUnknownM;
  sums.Add(jacobian, Vector3d(-line.x(), -line.y(), 0), covariance, 2);
}

/// The estimate with the scale as a parameter, or held at 1.
struct Solution {
  Eigen::Isometry3d X_WC;
  double scale = 1;
  Normal covariance;
  double misfit = 0;
};

Solution Solve(const Observations& observations, bool with_scale) {
  Solution solution;
  solution.X_WC = Start(observations.marks);
  const int unknowns = with_scale ? 7 : 6;
  for (int i = 0; i <= kIterations; ++i) {
    Sums sums;
    for (const SeenMark& mark : observations.marks)
      AddMark(mark, solution.X_WC, solution.scale, observations.placement_sd_m, sums);
    for (const SeenPlumb& plumb : observations.plumbs)
      AddPlumb(plumb, solution.X_WC, solution.scale, observations.placement_sd_m, sums);
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
    if (with_scale) solution.scale += step[6];
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
  pose.scale_sd = std::sqrt(scaled.covariance(6, 6));
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
  rows << -Cross(p_W_m), Matrix3d::Identity();
  return rows * covariance * rows.transpose();
}

double CameraPose::TurnSdRad() const {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> turn(covariance.topLeftCorner<3, 3>());
  return std::sqrt(turn.eigenvalues().maxCoeff());
}

}  // namespace footing::camera_pose
