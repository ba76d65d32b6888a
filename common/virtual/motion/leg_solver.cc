#include "common/virtual/motion/leg_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

#include "common/base/rotation.h"

namespace footing::motion {
namespace {

using body::Landmark;

constexpr int kIterations = 12;
constexpr double kArrivedM = 1e-7;
constexpr double kDamping = 1e-6;  // m², against the normal equations; keeps a straight knee sane.
constexpr double kLargestStepRad = 0.3;
constexpr double kPointM = 0.2;  // From a joint: turns by 1 rad count as much as this distance.
// How the sole rolls counts so little that it moves what is asked for by less than a millimetre
// where the ankle has no angle for it.
constexpr double kRollWeight = 1e-4;
const Eigen::Vector3d kBeside_A(0, kPointM, 0);

}  // namespace

/// Least squares in the leg's angles.
struct LegSolver::Equations {
  explicit Equations(Eigen::Index n) : H(Eigen::MatrixXd::Zero(n, n)), g(Eigen::VectorXd::Zero(n)) {
    H.diagonal().setConstant(kDamping);
  }
  void Add(double weight, const Eigen::Matrix3Xd& columns, const Eigen::Vector3d& error_m) {
    H.noalias() += weight * columns.transpose() * columns;
    g.noalias() += weight * columns.transpose() * error_m;
  }

  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

LegSolver::LegSolver(const body::Body& body, bool left, LegAim aim)
    : body_(body),
      aim_(aim),
      hip_(body.landmarks[left ? Landmark::kLeftHip : Landmark::kRightHip]),
      knee_(body.landmarks[left ? Landmark::kLeftKnee : Landmark::kRightKnee]),
      ankle_(body.landmarks[left ? Landmark::kLeftAnkle : Landmark::kRightAnkle]),
      ahead_A_(kPointM, 0, 0),
      thigh_m_(body.skeleton.joint(knee_).offset_m.norm()),
      shank_m_(body.skeleton.joint(ankle_).offset_m.norm()),
      at_(body.skeleton),
      J_(3, body.skeleton.dof) {
  for (const int joint : {hip_, knee_, ankle_}) {
    const body::Joint& one = body.skeleton.joint(joint);
    const int turns = static_cast<int>(one.rotations.size());
    const bool last_only = joint == ankle_ && aim == LegAim::kFoot;
    for (int i = last_only ? turns - 1 : 0; i < turns; ++i) dofs_.push_back(one.first_dof + i);
  }
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at_);
  t_pose_ = ThighOf(at_);
  const int toe = body.landmarks[left ? Landmark::kLeftToe : Landmark::kRightToe];
  if (aim == LegAim::kWhole && toe >= 0) {
    const auto foot = static_cast<std::size_t>(ankle_), ball = static_cast<std::size_t>(toe);
    const Eigen::Vector3d to_toe_W = (at_.p_WJ[ball] - at_.p_WJ[foot]).normalized();
    ahead_A_ = kPointM * at_.R_WJ[foot].transpose() * to_toe_W;
  }
}

LegSolver::Thigh LegSolver::ThighOf(const body::Kinematics& at) const {
  const auto hip = static_cast<std::size_t>(hip_), knee = static_cast<std::size_t>(knee_);
  const Eigen::Matrix3d R_PW = at.R_WJ[pelvis()].transpose();
  return {R_PW * (at.p_WJ[knee] - at.p_WJ[hip]).normalized(), R_PW * at.R_WJ[hip]};
}

Eigen::Matrix3d LegSolver::Untwisted(const Thigh& thigh) const {
  return LeastTurn(t_pose_.along_P, thigh.along_P) * t_pose_.R_PH;
}

double LegSolver::ThighTurn(const body::Kinematics& at) const {
  const Thigh thigh = ThighOf(at);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(thigh.R_PH * Untwisted(thigh).transpose()));
  return turn.axis().dot(thigh.along_P) < 0 ? turn.angle() : -turn.angle();
}

void LegSolver::BendKnee(double angle_rad, Eigen::Ref<Eigen::VectorXd> q) {
  body::ComputeKinematics(body_.skeleton, q, at_);
  const body::Joint& joint = body_.skeleton.joint(knee_);
  const Eigen::Vector3d left_W =
      at_.R_WJ[static_cast<std::size_t>(hip_)] * t_pose_.R_PH.transpose().col(1);
  const Eigen::Matrix3d R_WK =
      Eigen::AngleAxisd(angle_rad, left_W) * at_.R_WJ[static_cast<std::size_t>(knee_)];
  const Eigen::Matrix3d& R_WP = at_.R_WJ[static_cast<std::size_t>(joint.parent)];
  body::SetJointRotation(joint, R_WP.transpose() * R_WK, q);
}

Eigen::Matrix3Xd LegSolver::Columns(int joint, const Eigen::Vector3d& p_W) {
  body::PointJacobian(body_.skeleton, at_, joint, p_W, J_);
  return J_(Eigen::all, dofs_);
}

double LegSolver::AddThigh(double turn_rad, Equations& equations) {
  const Thigh thigh = ThighOf(at_);
  const Eigen::Matrix3d& R_WP = at_.R_WJ[pelvis()];
  const Eigen::Vector3d ahead_H = t_pose_.R_PH.transpose().col(0);
  const Eigen::Vector3d ahead_P = thigh.R_PH * ahead_H;
  const Eigen::Vector3d wanted_P =
      Eigen::AngleAxisd(turn_rad, -thigh.along_P) * (Untwisted(thigh) * ahead_H);
  // Only the way to the side: along the thigh and ahead is what swinging it does.
  const Eigen::Vector3d side_W = R_WP * thigh.along_P.cross(ahead_P);
  const Eigen::Vector3d p_W = at_.p_WJ[static_cast<std::size_t>(hip_)] + kPointM * R_WP * ahead_P;
  const Eigen::Matrix3d to_side = side_W * side_W.transpose();
  const Eigen::Vector3d error_m = kPointM * to_side * (R_WP * (wanted_P - ahead_P));
  equations.Add(1, to_side * Columns(hip_, p_W), error_m);
  return error_m.norm();
}

double LegSolver::AddFoot(const FootPlace& place, const Eigen::Vector3d& p_A, double weight,
                          Equations& equations) {
  const auto ankle = static_cast<std::size_t>(ankle_);
  const Eigen::Vector3d p_W = at_.p_WJ[ankle] + at_.R_WJ[ankle] * p_A;
  const Eigen::Vector3d error_m = place.p_WA + place.R_WA * p_A - p_W;
  equations.Add(weight, Columns(ankle_, p_W), error_m);
  return error_m.norm();
}

double LegSolver::Solve(const FootPlace& place, Eigen::Ref<Eigen::VectorXd> q) {
  double rest_m = 0;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    body::ComputeKinematics(body_.skeleton, q, at_);
    Equations equations(static_cast<Eigen::Index>(dofs_.size()));
    rest_m = std::max(AddFoot(place, Eigen::Vector3d::Zero(), 1, equations),
                      AddFoot(place, ahead_A_, 1, equations));
    if (aim_ == LegAim::kWhole) {
      rest_m = std::max(rest_m, AddThigh(place.thigh_turn_rad, equations));
      AddFoot(place, kBeside_A, kRollWeight, equations);
    }
    if (rest_m < kArrivedM || iteration == kIterations) break;
    Eigen::VectorXd step = equations.H.ldlt().solve(equations.g);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > kLargestStepRad) step *= kLargestStepRad / largest;
    q(dofs_) += step;
  }
  return rest_m;
}

}  // namespace footing::motion
