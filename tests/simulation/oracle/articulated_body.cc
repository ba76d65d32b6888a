#include "tests/simulation/oracle/articulated_body.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::oracle {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Skew(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Motion vectors into a frame turned by R (its axes as columns) whose origin is at r.
Matrix6 MotionTransform(const Matrix3d& R, const Vector3d& r) {
  Matrix6 X = Matrix6::Zero();
  X.topLeftCorner<3, 3>() = X.bottomRightCorner<3, 3>() = R.transpose();
  X.bottomLeftCorner<3, 3>() = -R.transpose() * Skew(r);
  return X;
}

Vector6 Spatial(const Vector3d& angular, const Vector3d& linear) {
  Vector6 v;
  v << angular, linear;
  return v;
}

Vector6 CrossMotion(const Vector6& v, const Vector6& m) {
  const Vector3d w = v.head<3>(), u = v.tail<3>();
  return Spatial(w.cross(m.head<3>()), u.cross(m.head<3>()) + w.cross(m.tail<3>()));
}

Vector6 CrossForce(const Vector6& v, const Vector6& f) {
  const Vector3d w = v.head<3>(), u = v.tail<3>();
  return Spatial(w.cross(f.head<3>()) + u.cross(f.tail<3>()), w.cross(f.tail<3>()));
}

Matrix6 RigidInertia(double mass_kg, const Vector3d& com_m, const Vector3d& about_com) {
  const Matrix3d c = Skew(com_m);
  Matrix6 inertia;
  inertia << Matrix3d(about_com.asDiagonal()) - mass_kg * c * c, mass_kg * c, -mass_kg * c,
      mass_kg * Matrix3d::Identity();
  return inertia;
}

}  // namespace

ArticulatedBiped::ArticulatedBiped(const biped::BipedParameters& biped, double step_s)
    : biped_(biped), step_s_(step_s) {
  const auto load = [](Body& body, double mass_kg, const Vector3d& com_m, const Vector3d& inertia) {
    body.mass_kg = mass_kg;
    body.com_m = com_m;
    body.inertia = RigidInertia(mass_kg, com_m, inertia);
  };
  load(bodies_[0], biped.body_mass_kg, Vector3d::Zero(),
       {biped.body_inertia_roll_kgm2, biped.body_inertia_pitch_kgm2, biped.body_inertia_yaw_kgm2});
  const Vector3d link_inertia(biped.link_inertia_across_kgm2, biped.link_inertia_across_kgm2,
                              biped.link_inertia_along_kgm2);
  for (int leg = 0; leg < physics::kLegs; ++leg) {
    const int hinge_axis[3] = {2, 0, 1};  // Yaw, roll, pitch.
    for (int j = 0; j < 4; ++j) {
      Body& body = bodies_[1 + 4 * leg + j];
      body.parent = j == 0 ? 0 : 4 * leg + j;
      if (j < 3) {
        body.axis[hinge_axis[j]] = 1;
        body.armature = biped.hip_armature_kgm2;
      }
    }
    bodies_[1 + 4 * leg].r_parent_m = {0, biped::Side(leg) * biped.hip_half_spacing_m,
                                       -biped.hip_below_body_com_m};
    load(bodies_[3 + 4 * leg], biped.link_mass_kg, {0, 0, -biped.hip_link_com_below_hip_m},
         link_inertia);
    Body& knee = bodies_[KneeOf(leg)];
    knee.axis[5] = -1;
    knee.r_parent_m = {0, 0, biped.foot_below_knee_link_com_m - biped.leg_length_m};
    load(knee, biped.link_mass_kg, Vector3d::Zero(), link_inertia);
  }
  Reset({0, 0, 1}, 0, {});
}

void ArticulatedBiped::Reset(const Vector3d& p_WB_m, double heading_rad,
                             const std::array<double, physics::kJoints>& joint_position) {
  p_WB_ = p_WB_m;
  q_WB_ = Eigen::AngleAxisd(heading_rad, Vector3d::UnitZ());
  position_ = joint_position;
  contacts_ = {};
  SetVelocity(Vector3d::Zero(), Vector3d::Zero(), {});
}

void ArticulatedBiped::SetVelocity(const Vector3d& v_WB_mps, const Vector3d& w_WB_radps,
                                   const std::array<double, physics::kJoints>& joint_velocity) {
  v_WB_ = v_WB_mps;
  w_B_ = q_WB_.conjugate() * w_WB_radps;
  velocity_ = joint_velocity;
  Place();
  ReadObservation();
}

void ArticulatedBiped::Place() {
  R_W_[0] = q_WB_.toRotationMatrix();
  p_W_[0] = p_WB_;
  twist_[0] = Spatial(w_B_, R_W_[0].transpose() * v_WB_);
  for (int i = 1; i < kBodies; ++i) {
    const Body& body = bodies_[i];
    const double q = position_[i - 1];
    const Vector3d hinge = body.axis.head<3>(), slide = body.axis.tail<3>();
    const Matrix3d R = hinge.isZero() ? Matrix3d::Identity().eval()
                                      : Eigen::AngleAxisd(q, hinge).toRotationMatrix();
    const Vector3d r = body.r_parent_m + q * slide;
    from_parent_[i] = MotionTransform(R, r);
    R_W_[i] = R_W_[body.parent] * R;
    p_W_[i] = p_W_[body.parent] + R_W_[body.parent] * r;
    twist_[i] = from_parent_[i] * twist_[body.parent] + body.axis * velocity_[i - 1];
  }
}

/// Normal spring and damper that never pull; an anchored spring and damper along the ground within
/// Coulomb's cone, and one about the normal within torsional friction.
void ArticulatedBiped::TouchGround(int leg) {
  FootContact& foot = contacts_[leg];
  const int knee = KneeOf(leg);
  const Vector3d w_W = R_W_[knee] * twist_[knee].head<3>();
  const Vector3d centre_W = p_W_[knee] - biped_.foot_below_knee_link_com_m * R_W_[knee].col(2);
  const Vector3d p_W = centre_W - biped_.foot_radius_m * Vector3d::UnitZ();
  const Vector3d v_W = R_W_[knee] * twist_[knee].tail<3>() + w_W.cross(p_W - p_W_[knee]);
  const double normal_n =
      -contact_.stiffness_n_per_m * p_W.z() - contact_.damping_ns_per_m * v_W.z();
  if (p_W.z() >= 0 || normal_n <= 0) {
    foot = {};
    return;
  }
  if (!foot.touching) foot.anchor_W_m = p_W.head<2>();
  foot.touching = true;
  foot.normal_force_n = normal_n;
  Eigen::Vector2d slip =
      -contact_.tangential_stiffness_n_per_m * (p_W.head<2>() - foot.anchor_W_m) -
      contact_.tangential_damping_ns_per_m * v_W.head<2>();
  const double cone_n = biped_.sliding_friction * normal_n;
  if (slip.norm() > cone_n) {
    slip *= cone_n / slip.norm();
    foot.anchor_W_m = p_W.head<2>() + slip / contact_.tangential_stiffness_n_per_m;
  }
  foot.force_W_n << slip, normal_n;
  foot.twist_rad += w_W.z() * step_s_;
  const double twist_nm = -contact_.twist_stiffness_nm_per_rad * foot.twist_rad -
                          contact_.twist_damping_nms_per_rad * w_W.z();
  const double limit_nm = biped_.torsional_friction_m * normal_n;
  foot.twist_nm = std::clamp(twist_nm, -limit_nm, limit_nm);
  if (foot.twist_nm != twist_nm) {
    foot.twist_rad = -foot.twist_nm / contact_.twist_stiffness_nm_per_rad;
  }
}

void ArticulatedBiped::Accelerate(const physics::JointEfforts& efforts, const Vector3d& push_W_n,
                                  Vector6& root_acceleration,
                                  std::array<double, physics::kJoints>& joints) const {
  std::array<Matrix6, kBodies> inertia;
  std::array<Vector6, kBodies> bias, coriolis, columns, accelerations;
  std::array<double, kBodies> pivots{}, remaining{};
  for (int i = 0; i < kBodies; ++i) {
    inertia[i] = bodies_[i].inertia;
    bias[i] = CrossForce(twist_[i], bodies_[i].inertia * twist_[i]);
    coriolis[i] = i == 0 ? Vector6::Zero().eval()
                         : CrossMotion(twist_[i], bodies_[i].axis * velocity_[i - 1]);
  }
  bias[0].tail<3>() -= R_W_[0].transpose() * push_W_n;
  for (int leg = 0; leg < physics::kLegs; ++leg) {
    const FootContact& foot = contacts_[leg];
    if (!foot.touching) continue;
    const int knee = KneeOf(leg);
    const Vector3d arm_W = -biped_.foot_below_knee_link_com_m * R_W_[knee].col(2) -
                           biped_.foot_radius_m * Vector3d::UnitZ();
    const Vector3d moment_W = arm_W.cross(foot.force_W_n) + foot.twist_nm * Vector3d::UnitZ();
    bias[knee] -=
        Spatial(R_W_[knee].transpose() * moment_W, R_W_[knee].transpose() * foot.force_W_n);
  }
  for (int i = kBodies - 1; i > 0; --i) {
    const Body& body = bodies_[i];
    columns[i] = inertia[i] * body.axis;
    pivots[i] = body.axis.dot(columns[i]) + body.armature;
    remaining[i] = efforts[i - 1] - body.axis.dot(bias[i]);
    const Matrix6 passed = inertia[i] - columns[i] * columns[i].transpose() / pivots[i];
    const Vector6 force = bias[i] + passed * coriolis[i] + columns[i] * (remaining[i] / pivots[i]);
    inertia[body.parent] += from_parent_[i].transpose() * passed * from_parent_[i];
    bias[body.parent] += from_parent_[i].transpose() * force;
  }
  // Without gravity, which accelerates all of a floating mechanism alike: Step adds it to the root.
  accelerations[0] = -inertia[0].ldlt().solve(bias[0]);
  for (int i = 1; i < kBodies; ++i) {
    const Vector6 carried = from_parent_[i] * accelerations[bodies_[i].parent] + coriolis[i];
    joints[i - 1] = (remaining[i] - columns[i].dot(carried)) / pivots[i];
    accelerations[i] = carried + bodies_[i].axis * joints[i - 1];
  }
  root_acceleration = accelerations[0];
}

void ArticulatedBiped::Step(const physics::JointEfforts& efforts, const Vector3d& push_W_n) {
  for (int leg = 0; leg < physics::kLegs; ++leg) TouchGround(leg);
  Vector6 root;
  std::array<double, physics::kJoints> joints{};
  Accelerate(efforts, push_W_n, root, joints);
  // From the spatial to the origin's own acceleration: a + w x v, in the body's frame.
  const Vector3d v_B = R_W_[0].transpose() * v_WB_;
  v_WB_ += step_s_ * (R_W_[0] * (root.tail<3>() + w_B_.cross(v_B)) -
                      kStandardGravityMps2 * Vector3d::UnitZ());
  w_B_ += step_s_ * root.head<3>();
  p_WB_ += step_s_ * v_WB_;
  const double angle_rad = step_s_ * w_B_.norm();
  if (angle_rad > 0)
    q_WB_ = q_WB_ * Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, w_B_.normalized()));
  q_WB_.normalize();
  for (int j = 0; j < physics::kJoints; ++j) {
    velocity_[j] += step_s_ * joints[j];
    position_[j] += step_s_ * velocity_[j];
  }
  Place();
  ReadObservation();
}

void ArticulatedBiped::ReadObservation() {
  seen_.p_WB = p_WB_;
  seen_.v_WB = v_WB_;
  seen_.R_WB = R_W_[0];
  seen_.w_WB = R_W_[0] * w_B_;
  seen_.joint_position = position_;
  seen_.joint_velocity = velocity_;
  seen_.p_WC.setZero();
  seen_.v_WC.setZero();
  for (int i = 0; i < kBodies; ++i) {
    const Body& body = bodies_[i];
    const Vector3d v = twist_[i].tail<3>() + twist_[i].head<3>().cross(body.com_m);
    seen_.p_WC += body.mass_kg / mass_kg() * (p_W_[i] + R_W_[i] * body.com_m);
    seen_.v_WC += body.mass_kg / mass_kg() * (R_W_[i] * v);
  }
  seen_.contact_force_W_n.setZero();
  for (int leg = 0; leg < physics::kLegs; ++leg) {
    const int knee = KneeOf(leg);
    seen_.p_WH[leg] = p_W_[1 + 4 * leg];
    seen_.p_WF[leg] = p_W_[knee] - biped_.foot_below_knee_link_com_m * R_W_[knee].col(2);
    seen_.normal_force_n[leg] = contacts_[leg].normal_force_n;
    seen_.contact_force_W_n += contacts_[leg].force_W_n;
  }
}

Vector3d ArticulatedBiped::AngularMomentum() const {
  Vector3d momentum = Vector3d::Zero();
  for (int i = 0; i < kBodies; ++i) {
    const Vector6 h = bodies_[i].inertia * twist_[i];
    const Vector3d linear_W = R_W_[i] * h.tail<3>();
    momentum += R_W_[i] * h.head<3>() + (p_W_[i] - seen_.p_WC).cross(linear_W);
  }
  return momentum;
}

double ArticulatedBiped::Energy() const {
  double energy_j = mass_kg() * kStandardGravityMps2 * seen_.p_WC.z();
  for (int i = 0; i < kBodies; ++i) {
    energy_j += twist_[i].dot(bodies_[i].inertia * twist_[i]) / 2;
    if (i > 0) energy_j += bodies_[i].armature * velocity_[i - 1] * velocity_[i - 1] / 2;
  }
  return energy_j;
}

}  // namespace footing::oracle
