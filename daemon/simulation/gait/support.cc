#include "daemon/simulation/gait/support.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "daemon/simulation/gait/frames.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// Loads are believed up to this much beyond the measured ones, so that a foot can take load up.
constexpr double kLoadGrowth = 1.5;
constexpr double kLoadOffsetN = 3.0;
/// Below this total force two supporting legs share evenly.
constexpr double kShareForceN = 1.0;
/// Turning by both feet: half by each, at most this share of friction.
constexpr double kDifferentialShare = 0.5;
constexpr double kDifferentialFriction = 0.3;

bool Supports(const Targets& targets, int leg) {
  return targets.legs[leg].task == LegTask::kSupport;
}

Vector3d HipReaction(const biped::LegState& leg, const double* hip_efforts) {
  const Vector3d efforts(hip_efforts[0], hip_efforts[1], hip_efforts[2]);
  return leg.hinge_axes_W.transpose().inverse() * efforts;
}

/// Torque at one hip within what its foot's contact can hold.
Vector3d WithinFriction(const biped::LegState& leg, const biped::BipedParameters& biped,
                        const AttitudeGains& gains, double load_n, const Vector3d& moment_W) {
  const double along_nm = moment_W.dot(leg.u_HF_W);
  Vector3d across = moment_W - along_nm * leg.u_HF_W;
  const double limit_nm = gains.friction_share * biped.sliding_friction * load_n * leg.length_m;
  if (across.norm() > limit_nm) across *= limit_nm / across.norm();
  const double twist_nm = gains.turning_friction_share * biped.torsional_friction_m * load_n;
  return across + std::clamp(along_nm, -twist_nm, twist_nm) * leg.u_HF_W;
}

}  // namespace

void CarryBody(const biped::BodyState& body, const biped::BipedParameters& biped,
               const AttitudeGains& gains, const Targets& targets, double heading_rad,
               const Vector3d& moment_W_nm, const std::array<double, 2>& axial_n,
               physics::JointEfforts& efforts) {
  const bool both = Supports(targets, 0) && Supports(targets, 1);
  const double total_n = axial_n[0] + axial_n[1];
  Vector3d needed = moment_W_nm;
  for (int i = 0; i < 2; ++i) {
    const biped::LegState& leg = body.legs[i];
    if (!Supports(targets, i)) {
      needed += HipReaction(leg, &efforts[4 * i]);
      continue;
    }
    // Jumping takes the mean force: legs pressed unequally then right the body like a roll spring.
    const double force_n = both && targets.jumping ? total_n / 2 : axial_n[i];
    needed -= (leg.p_WH - body.p_WB).cross(-force_n * leg.u_HF_W);
  }
  const double turning_nm =
      both ? std::clamp(needed.z(), -gains.turning_limit_nm, gains.turning_limit_nm) : 0;
  for (int i = 0; i < 2; ++i) {
    if (!Supports(targets, i)) continue;
    const biped::LegState& leg = body.legs[i];
    const double share = !both ? 1 : total_n > kShareForceN ? axial_n[i] / total_n : 0.5;
    const double load_n = std::max(0.0, std::min(-axial_n[i] * leg.u_HF_W.z(),
                                                 kLoadGrowth * leg.normal_force_n + kLoadOffsetN));
    Vector3d torque = WithinFriction(leg, biped, gains, load_n, -share * needed);
    if (both) {
      const double fore_n =
          -biped::Side(i) * kDifferentialShare * turning_nm / (2 * biped.hip_half_spacing_m);
      const double limit_nm = kDifferentialFriction * biped.sliding_friction * load_n;
      const double pitch_nm = std::clamp(fore_n * leg.length_m, -limit_nm, limit_nm);
      torque += ToWorld(heading_rad, {0, pitch_nm, 0});
    }
    const Vector3d hinges = leg.hinge_axes_W.transpose() * torque;
    std::copy(hinges.data(), hinges.data() + 3, &efforts[4 * i]);
  }
}

}  // namespace footing::gait
