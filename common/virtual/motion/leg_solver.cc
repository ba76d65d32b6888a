#include "common/virtual/motion/leg_solver.h"

#include <Eigen/Cholesky>
#include <array>

namespace footing::motion {
namespace {

using body::Landmark;

constexpr int kIterations = 12;
constexpr double kArrivedM = 1e-7;
constexpr double kDamping = 1e-6;  // m², against the normal equations; keeps a straight knee sane.
constexpr double kLargestStepRad = 0.3;
/// A point of the foot, m in the ankle's frame, and how much of its distance counts.
struct FootPoint {
  Eigen::Vector3d p_A_m;
  double weight;
};

// Where the foot is and where it points come before how it lies, which many ankles cannot choose.
const std::array<FootPoint, 3> kPoints = {FootPoint{{0, 0, 0}, 1}, FootPoint{{0.2, 0, 0}, 1},
                                          FootPoint{{0, 0.2, 0}, 0.1}};
constexpr std::size_t kPointsAhead = 2;

}  // namespace

LegSolver::LegSolver(const body::Body& body, bool left, FootAim aim)
    : body_(body),
      aim_(aim),
      hip_(body.landmarks[left ? Landmark::kLeftHip : Landmark::kRightHip]),
      knee_(body.landmarks[left ? Landmark::kLeftKnee : Landmark::kRightKnee]),
      ankle_(body.landmarks[left ? Landmark::kLeftAnkle : Landmark::kRightAnkle]),
      thigh_m_(body.skeleton.joint(knee_).offset_m.norm()),
      shank_m_(body.skeleton.joint(ankle_).offset_m.norm()),
      at_(body.skeleton),
      J_(3, body.skeleton.dof) {
  for (const int joint : {hip_, knee_, ankle_}) {
    const body::Joint& one = body.skeleton.joint(joint);
    const int turns = static_cast<int>(one.rotations.size());
    const bool last_only = joint == ankle_ && aim == FootAim::kAhead;
    for (int i = last_only ? turns - 1 : 0; i < turns; ++i) dofs_.push_back(one.first_dof + i);
  }
}

double LegSolver::Solve(const FootPlace& place, Eigen::Ref<Eigen::VectorXd> q) {
  const auto n = static_cast<Eigen::Index>(dofs_.size());
  Eigen::MatrixXd H(n, n);
  Eigen::VectorXd g(n);
  Eigen::Matrix<double, 3, Eigen::Dynamic> columns(3, n);
  double rest = 0;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    body::ComputeKinematics(body_.skeleton, q, at_);
    const auto ankle = static_cast<std::size_t>(ankle_);
    H.setZero();
    g.setZero();
    rest = 0;
    for (std::size_t i = 0; i < (aim_ == FootAim::kFlat ? kPoints.size() : kPointsAhead); ++i) {
      const auto& [p_A_m, weight] = kPoints[i];
      const Eigen::Vector3d p_W = at_.p_WJ[ankle] + at_.R_WJ[ankle] * p_A_m;
      const Eigen::Vector3d error = place.p_WA + place.R_WA * p_A_m - p_W;
      body::PointJacobian(body_.skeleton, at_, ankle_, p_W, J_);
      for (Eigen::Index k = 0; k < n; ++k)
        columns.col(k) = J_.col(dofs_[static_cast<std::size_t>(k)]);
      H.noalias() += weight * columns.transpose() * columns;
      g.noalias() += weight * columns.transpose() * error;
      if (i < kPointsAhead) rest = std::max(rest, error.norm());
    }
    if (rest < kArrivedM || iteration == kIterations) break;
    H.diagonal().array() += kDamping;
    Eigen::VectorXd step = H.ldlt().solve(g);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > kLargestStepRad) step *= kLargestStepRad / largest;
    for (Eigen::Index k = 0; k < n; ++k) q(dofs_[static_cast<std::size_t>(k)]) += step(k);
  }
  return rest;
}

}  // namespace footing::motion
