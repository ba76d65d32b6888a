#include "common/body/kinematics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace footing::body {
namespace {

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// R = R * R(axis, angle), on two columns only.
void RotateColumns(Axis axis, double angle_rad, Eigen::Matrix3d& R) {
  const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  const int i = (static_cast<int>(axis) + 1) % 3, j = (static_cast<int>(axis) + 2) % 3;
  const Eigen::Vector3d first = R.col(i), second = R.col(j);
  R.col(i) = cosine * first + sine * second;
  R.col(j) = cosine * second - sine * first;
}

/// One joint, whose parent is placed already.
inline void Place(const Skeleton& skeleton, const PoseRef& q, std::size_t i, Kinematics& out) {
  const Joint& joint = skeleton.joints[i];
  Eigen::Matrix3d& R = out.R_WJ[i];
  if (joint.parent < 0) {
    R = joint.axes;
    out.p_WJ[i] = q.head<3>();
  } else {
    const std::size_t parent = Index(joint.parent);
    out.p_WJ[i].noalias() = out.p_WJ[parent] + out.R_WJ[parent] * joint.offset_m;
    if (joint.rotations.empty()) {
      R = out.R_WJ[parent];
      return;
    }
    if (joint.plain_axes) {
      R = out.R_WJ[parent];
    } else {
      R.noalias() = out.R_WJ[parent] * joint.axes;
    }
  }
  int dof = joint.first_dof;
  for (const Rotation& rotation : joint.rotations) {
    out.axis_W[Index(dof)] = R.col(static_cast<int>(rotation.axis));
    RotateColumns(rotation.axis, q(dof), R);
    ++dof;
  }
  if (!joint.plain_axes) R = (R * joint.axes.transpose()).eval();
}

}  // namespace

Kinematics::Kinematics(const Skeleton& skeleton)
    : R_WJ(Index(skeleton.size()), Eigen::Matrix3d::Identity()),
      p_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      axis_W(Index(skeleton.dof), Eigen::Vector3d::Zero()) {}

JointVelocities::JointVelocities(const Skeleton& skeleton)
    : w_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      v_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()) {}

JointAccelerations::JointAccelerations(const Skeleton& skeleton)
    : alpha_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      a_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()) {}

void ComputeKinematics(const Skeleton& skeleton, PoseRef q, Kinematics& out) {
  FOOTING_CHECK(q.size() == skeleton.dof);
  for (int axis = 0; axis < 3; ++axis) out.axis_W[Index(axis)] = Eigen::Vector3d::Unit(axis);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) Place(skeleton, q, i, out);
}

void ComputeKinematics(const Skeleton& skeleton, PoseRef q, std::span<const int> joints,
                       Kinematics& out) {
  FOOTING_CHECK(q.size() == skeleton.dof);
  for (const int joint : joints) Place(skeleton, q, Index(joint), out);
}

void ComputeVelocities(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                       JointVelocities& out) {
  FOOTING_CHECK(q_dot.size() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    if (joint.parent < 0) {
      out.v_WJ[i] = q_dot.head<3>();
    } else {
      const std::size_t parent = Index(joint.parent);
      w = out.w_WJ[parent];
      out.v_WJ[i] = out.v_WJ[parent] + w.cross(at.p_WJ[i] - at.p_WJ[parent]);
    }
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) w += at.axis_W[Index(dof)] * q_dot(dof);
    out.w_WJ[i] = w;
  }
}

void ComputeAccelerations(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                          PoseRef q_ddot, const JointVelocities& velocities,
                          JointAccelerations& out) {
  FOOTING_CHECK(q_dot.size() == skeleton.dof && q_ddot.size() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    Eigen::Vector3d w = Eigen::Vector3d::Zero(), alpha = Eigen::Vector3d::Zero();
    if (joint.parent < 0) {
      out.a_WJ[i] = q_ddot.head<3>();
    } else {
      const std::size_t parent = Index(joint.parent);
      w = velocities.w_WJ[parent];
      alpha = out.alpha_WJ[parent];
      const Eigen::Vector3d arm = at.p_WJ[i] - at.p_WJ[parent];
      out.a_WJ[i] = out.a_WJ[parent] + alpha.cross(arm) + w.cross(w.cross(arm));
    }
    // Each axis is rotated by the rotations before it.
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      const Eigen::Vector3d turn = at.axis_W[Index(dof)] * q_dot(dof);
      alpha += at.axis_W[Index(dof)] * q_ddot(dof) + w.cross(turn);
      w += turn;
    }
    out.alpha_WJ[i] = alpha;
  }
}

void PointJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                   const Eigen::Vector3d& p_W, JacobianRef out) {
  FOOTING_CHECK(out.cols() == skeleton.dof);
  out.setZero();
  out.leftCols<3>().setIdentity();
  for (int i = joint; i >= 0; i = skeleton.joint(i).parent) {
    const Joint& link = skeleton.joint(i);
    const Eigen::Vector3d arm = p_W - at.p_WJ[Index(i)];
    const int end = link.first_dof + static_cast<int>(link.rotations.size());
    for (int dof = link.first_dof; dof < end; ++dof)
      out.col(dof) = at.axis_W[Index(dof)].cross(arm);
  }
}

namespace {

constexpr double kFistShare = 0.6;

int Of(const Body& body, int side, Landmark left) {
  return body.landmarks[side == 0 ? left : Mirrored(left)];
}

/// Offset of `below` from its ancestor `joint`, with the joints between them at rest.
Eigen::Vector3d OffsetFrom(const Skeleton& skeleton, int joint, int below) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (int at = below; at >= 0 && at != joint; at = skeleton.joint(at).parent) {
    offset += skeleton.joint(at).offset_m;
  }
  return offset;
}

/// The end point that hangs on a joint; -1 where there is none.
int EndOf(const Skeleton& skeleton, int joint) {
  for (int i = joint + 1; i < skeleton.size(); ++i) {
    if (skeleton.joint(i).parent == joint && IsEnd(skeleton, i)) return i;
  }
  return -1;
}

}  // namespace

Point Fist(const Body& body, int side) {
  Point fist;
  fist.joint = Of(body, side, Landmark::kLeftWrist);
  int end = Of(body, side, Landmark::kLeftHandEnd);
  if (end < 0) end = EndOf(body.skeleton, fist.joint);
  if (end >= 0) fist.p_J_m = kFistShare * OffsetFrom(body.skeleton, fist.joint, end);
  return fist;
}

Point Ankle(const Body& body, int side) {
  return {Of(body, side, Landmark::kLeftAnkle), {0, 0, 0}};
}

Point Toe(const Body& body, int side) {
  for (const Landmark landmark : {Landmark::kLeftToe, Landmark::kLeftToeEnd}) {
    const int joint = Of(body, side, landmark);
    if (joint >= 0) return {joint, {0, 0, 0}};
  }
  return Ankle(body, side);
}

Point ToeEnd(const Body& body, int side) {
  const int joint = Of(body, side, Landmark::kLeftToeEnd);
  return joint >= 0 ? Point{joint, {0, 0, 0}} : Toe(body, side);
}

namespace {

constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-9, kMostDamping = 1e6;
constexpr double kLeastDiagonal = 1e-6;
constexpr double kHold = 0.01;  // m/rad.

}  // namespace

PoseFit::PoseFit(const Skeleton& skeleton)
    : skeleton_(skeleton),
      at_(skeleton),
      H_(skeleton.dof, skeleton.dof),
      damped_(skeleton.dof, skeleton.dof),
      gradient_(skeleton.dof),
      hold_(skeleton.dof),
      neutral_(skeleton.dof),
      trial_(skeleton.dof),
      step_(skeleton.dof),
      solver_(skeleton.dof) {}

double PoseFit::PointCost(const std::vector<PointTarget>& targets, const Eigen::VectorXd& q) {
  ComputeKinematics(skeleton_, q, at_);
  double cost = 0;
  for (const PointTarget& target : targets) {
    const auto joint = static_cast<std::size_t>(target.joint);
    const Eigen::Vector3d p_W = at_.p_WJ[joint] + at_.R_WJ[joint] * target.p_J;
    cost += target.weight * (target.p_W - p_W).squaredNorm();
  }
  return cost;
}

void PoseFit::SetHold(const FitOptions& options, const Eigen::Ref<const Eigen::VectorXd>& q) {
  neutral_ = q;
  if (options.neutral != nullptr) neutral_ = *options.neutral;
  hold_.setConstant(kHold * kHold);
  if (options.hold != nullptr) hold_ = options.hold->cwiseAbs2();
  if (options.neutral == nullptr) hold_.head<3>().setZero();
}

double PoseFit::HoldCost(const Eigen::VectorXd& q) const {
  return (q - neutral_).cwiseAbs2().dot(hold_);
}

void PoseFit::Linearise(const std::vector<PointTarget>& targets,
                        const Eigen::Ref<const Eigen::VectorXd>& q) {
  const auto rows = 3 * static_cast<Eigen::Index>(targets.size());
  if (J_.rows() < rows) {
    J_.resize(rows, skeleton_.dof);
    residuals_.resize(rows);
  }
  ComputeKinematics(skeleton_, q, at_);
  Eigen::Index row = 0;
  for (const PointTarget& target : targets) {
    const auto joint = static_cast<std::size_t>(target.joint);
    const double root = std::sqrt(target.weight);
    const Eigen::Vector3d p_W = at_.p_WJ[joint] + at_.R_WJ[joint] * target.p_J;
    PointJacobian(skeleton_, at_, target.joint, p_W, J_.middleRows<3>(row));
    J_.middleRows<3>(row) *= root;
    residuals_.segment<3>(row) = root * (target.p_W - p_W);
    row += 3;
  }
  H_.setZero();
  H_.selfadjointView<Eigen::Lower>().rankUpdate(J_.topRows(rows).transpose());
  H_.diagonal() += hold_;
  gradient_.noalias() = J_.topRows(rows).transpose() * residuals_.head(rows);
  gradient_ -= hold_.cwiseProduct(q - neutral_);
}

bool PoseFit::Step(const std::vector<PointTarget>& targets, Descent& descent,
                   Eigen::Ref<Eigen::VectorXd> q) {
  bool better = false;
  while (!better && descent.damping < kMostDamping) {
    damped_ = H_;
    damped_.diagonal().array() += descent.damping * (H_.diagonal().array() + kLeastDiagonal);
    solver_.compute(damped_);
    step_ = gradient_;
    solver_.solveInPlace(step_);
    trial_ = q + step_;
    const double points = PointCost(targets, trial_);
    descent.gain = descent.cost - points - HoldCost(trial_);
    better = solver_.info() == Eigen::Success && descent.gain >= 0;
    if (better) {
      descent.points = points;
      descent.cost -= descent.gain;
      q = trial_;
    }
    descent.damping = better ? std::max(descent.damping / 10, kLeastDamping) : descent.damping * 10;
  }
  return better;
}

double PoseFit::Fit(const std::vector<PointTarget>& targets, const FitOptions& options,
                    Eigen::Ref<Eigen::VectorXd> q) {
  FOOTING_CHECK(q.size() == skeleton_.dof);
  double weights = 0;
  for (const PointTarget& target : targets) weights += target.weight;
  if (!(weights > 0)) return 0;
  SetHold(options, q);
  trial_ = q;
  Descent descent;
  descent.damping = kFirstDamping;
  descent.points = PointCost(targets, trial_);
  descent.cost = descent.points + HoldCost(trial_);
  for (int i = 0; i < options.iterations; ++i) {
    Linearise(targets, q);
    if (!Step(targets, descent, q) || descent.gain <= options.still * descent.cost) break;
  }
  return std::sqrt(descent.points / weights);
}

namespace {

Eigen::Vector3d CentreOf(const JointMass& mass, const Kinematics& at, std::size_t joint) {
  return at.p_WJ[joint] + at.R_WJ[joint] * mass.com_J;
}

/// I_W w for a body-fixed inertia.
Eigen::Vector3d Spin(const JointMass& mass, const Eigen::Matrix3d& R_WJ, const Eigen::Vector3d& w) {
  return R_WJ * (mass.inertia_J * (R_WJ.transpose() * w));
}

}  // namespace

CompositeMasses::CompositeMasses(const Skeleton& skeleton)
    : mass_kg(skeleton.joints.size(), 0.0),
      first_W(skeleton.joints.size(), Eigen::Vector3d::Zero()),
      inertia_W(skeleton.joints.size(), Eigen::Matrix3d::Zero()) {}

Eigen::Vector3d CentreOfMass(const Body& body, const Kinematics& at) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (mass.mass_kg > 0) sum += mass.mass_kg * CentreOf(mass, at, i);
  }
  return sum / body.mass_kg;
}

Momentum ComputeMomentum(const Body& body, const Kinematics& at,
                         const JointVelocities& velocities) {
  // About the root first, which is near: then moved to C.
  const Eigen::Vector3d origin = at.p_WJ[0];
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Momentum sum;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (!(mass.mass_kg > 0)) continue;
    const Eigen::Vector3d& w = velocities.w_WJ[i];
    const Eigen::Vector3d arm = at.R_WJ[i] * mass.com_J;
    const Eigen::Vector3d place = at.p_WJ[i] + arm - origin;
    const Eigen::Vector3d linear = mass.mass_kg * (velocities.v_WJ[i] + w.cross(arm));
    first += mass.mass_kg * place;
    sum.linear_W += linear;
    sum.angular_W += place.cross(linear) + Spin(mass, at.R_WJ[i], w);
  }
  const Eigen::Vector3d centre = first / body.mass_kg;
  sum.p_WC = origin + centre;
  sum.angular_W -= centre.cross(sum.linear_W);
  return sum;
}

Eigen::Vector3d ComputeCentroidalMatrix(const Body& body, const Kinematics& at,
                                        CompositeMasses& workspace, CentroidalMatrix& out) {
  const Skeleton& skeleton = body.skeleton;
  FOOTING_CHECK(out.cols() == skeleton.dof);
  const Eigen::Vector3d centre = CentreOfMass(body, at);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const JointMass& mass = body.masses[i];
    workspace.mass_kg[i] = mass.mass_kg;
    if (!(mass.mass_kg > 0)) {
      workspace.first_W[i].setZero();
      workspace.inertia_W[i].setZero();
      continue;
    }
    const Eigen::Vector3d d = CentreOf(mass, at, i) - centre;
    workspace.first_W[i] = mass.mass_kg * d;
    const Eigen::Matrix3d half = at.R_WJ[i] * mass.inertia_J;
    workspace.inertia_W[i].noalias() = half * at.R_WJ[i].transpose();
    workspace.inertia_W[i] -= mass.mass_kg * d * d.transpose();
    workspace.inertia_W[i].diagonal().array() += mass.mass_kg * d.squaredNorm();
  }
  for (std::size_t i = skeleton.joints.size() - 1; i > 0; --i) {
    const auto parent = static_cast<std::size_t>(skeleton.joints[i].parent);
    workspace.mass_kg[parent] += workspace.mass_kg[i];
    workspace.first_W[parent] += workspace.first_W[i];
    workspace.inertia_W[parent] += workspace.inertia_W[i];
  }
  out.leftCols<3>().setZero();
  out.topLeftCorner<3, 3>().diagonal().setConstant(body.mass_kg);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const Eigen::Vector3d arm = centre - at.p_WJ[i];
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      const Eigen::Vector3d& axis = at.axis_W[static_cast<std::size_t>(dof)];
      out.col(dof).head<3>() = axis.cross(workspace.first_W[i] + workspace.mass_kg[i] * arm);
      out.col(dof).tail<3>() =
          workspace.inertia_W[i] * axis + workspace.first_W[i].cross(axis.cross(arm));
    }
  }
  return centre;
}

Eigen::Vector3d ComJacobian(const Body& body, const Kinematics& at, CompositeMasses& workspace,
                            JacobianRef out) {
  const Skeleton& skeleton = body.skeleton;
  FOOTING_CHECK(out.cols() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const JointMass& mass = body.masses[i];
    workspace.mass_kg[i] = mass.mass_kg;
    workspace.first_W[i].setZero();  // From the root, as far as this function goes.
    if (mass.mass_kg > 0)
      workspace.first_W[i] = mass.mass_kg * (CentreOf(mass, at, i) - at.p_WJ[0]);
  }
  for (std::size_t i = skeleton.joints.size() - 1; i > 0; --i) {
    const auto parent = static_cast<std::size_t>(skeleton.joints[i].parent);
    workspace.mass_kg[parent] += workspace.mass_kg[i];
    workspace.first_W[parent] += workspace.first_W[i];
  }
  out.leftCols<3>().setIdentity();
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const Eigen::Vector3d moment =
        (workspace.first_W[i] - workspace.mass_kg[i] * (at.p_WJ[i] - at.p_WJ[0])) / body.mass_kg;
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      out.col(dof) = at.axis_W[static_cast<std::size_t>(dof)].cross(moment);
    }
  }
  return at.p_WJ[0] + workspace.first_W[0] / body.mass_kg;
}

}  // namespace footing::body
