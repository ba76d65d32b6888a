#include "daemon/simulation/gait/angular_momentum.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// One rigid link: its moment of momentum about the whole COM. `across` is its inertia about axes
/// across the leg, `along` about the leg itself.
Vector3d LinkMomentum(const biped::BodyState& body, const biped::BipedParameters& biped,
                      const Vector3d& p_W, const Vector3d& v_W, const Vector3d& w_W,
                      const Vector3d& u_W) {
  const Vector3d along = u_W.dot(w_W) * u_W;
  return biped.link_mass_kg * (p_W - body.p_WC).cross(v_W - body.v_WC) +
         biped.link_inertia_across_kgm2 * (w_W - along) + biped.link_inertia_along_kgm2 * along;
}

}  // namespace

Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  Vector3d momentum = Vector3d::Zero();
  for (const biped::LegState& leg : body.legs) {
    const Vector3d rates(leg.joint_velocity[0], leg.joint_velocity[1], leg.joint_velocity[2]);
    const Vector3d w = body.w_WB + leg.hinge_axes_W * rates;
    const Vector3d v_WH = body.v_WB + body.w_WB.cross(leg.p_WH - body.p_WB);
    const Vector3d& u = leg.u_HF_W;
    const Vector3d hip_link = biped.hip_link_com_below_hip_m * u;
    const Vector3d knee_link = (leg.length_m - biped.foot_below_knee_link_com_m) * u;
    momentum += LinkMomentum(body, biped, leg.p_WH + hip_link, v_WH + w.cross(hip_link), w, u);
    momentum += LinkMomentum(body, biped, leg.p_WH + knee_link,
                             v_WH + w.cross(knee_link) + leg.length_rate_mps * u, w, u);
  }
  return momentum;
}

Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  const Vector3d inertia_B(biped.body_inertia_roll_kgm2, biped.body_inertia_pitch_kgm2,
                           biped.body_inertia_yaw_kgm2);
  return body.R_WB * inertia_B.asDiagonal() * body.R_WB.transpose() * body.w_WB +
         biped.body_mass_kg * (body.p_WB - body.p_WC).cross(body.v_WB - body.v_WC) +
         LegsMomentum(body, biped);
}

}  // namespace footing::gait
