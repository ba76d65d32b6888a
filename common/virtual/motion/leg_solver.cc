#include "common/virtual/choreography/legs.h"

#include <Eigen/Cholesky>
#include <array>

namespace footing::choreography {
namespace {

using body::Landmark;

constexpr int kIterations = 12;
constexpr double kArrivedM = 1e-7;
constexpr double kDamping = 1e-6;  // m², against the normal equations; keeps a straight knee sane.
constexpr double kLargestStepRad = 0.3;
// Points of the foot that fix where it is and where it points, m in the ankle's frame.
const std::array<Eigen::Vector3d, 2> kPoints = {Eigen::Vector3d(0, 0, 0),
                                                Eigen::Vector3d(0.2, 0, 0)};

}  // namespace

LegSolver::LegSolver(const body::Body& body, bool left)
    : body_(body),
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
    for (int i = joint == ankle_ ? turns - 1 : 0; i < turns; ++i)
      dofs_.push_back(one.first_dof + i);
  }
}

double LegSolver::Solve(const FootPlace& place, Eigen::Ref<Eigen::VectorXd> q) {
  const auto n = static_cast<Eigen::Index>(dofs_.size());
  Eigen::MatrixXd H(n, n);
  Eigen::VectorXd g(n);
  Eigen::Matrix<double, 3, Eigen::Dynamic> columns(3, n);
  double rest = 0;
  for (int i = 0; i <= kIterations; ++i) {
    body::ComputeKinematics(body_.skeleton, q, at_);
    const auto ankle = static_cast<std::size_t>(ankle_);
    H.setZero();
    g.setZero();
    rest = 0;
    for (const Eigen::Vector3d& point : kPoints) {
      const Eigen::Vector3d p_W = at_.p_WJ[ankle] + at_.R_WJ[ankle] * point;
      const Eigen::Vector3d error = place.p_WA + place.R_WA * point - p_W;
      body::PointJacobian(body_.skeleton, at_, ankle_, p_W, J_);
      for (Eigen::Index k = 0; k < n; ++k)
        columns.col(k) = J_.col(dofs_[static_cast<std::size_t>(k)]);
      H.noalias() += columns.transpose() * columns;
      g.noalias() += columns.transpose() * error;
      rest = std::max(rest, error.norm());
    }
    if (rest < kArrivedM || i == kIterations) break;
    H.diagonal().array() += kDamping;
    Eigen::VectorXd step = H.ldlt().solve(g);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > kLargestStepRad) step *= kLargestStepRad / largest;
    for (Eigen::Index k = 0; k < n; ++k) q(dofs_[static_cast<std::size_t>(k)]) += step(k);
  }
  return rest;
}

}  // namespace footing::choreography
