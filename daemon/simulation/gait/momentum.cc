#include "daemon/simulation/gait/momentum.h"

#include <Eigen/Geometry>

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// Of one link: its centre's motion about the COM, and its own spin.
Vector3d LinkMomentum(const biped::BodyState& body, const biped::BipedParameters& biped,
                      const Vector3d& p_W, const Vector3d& v_W, const Vector3d& u_W,
                      const Vector3d& w_W) {
  const double along = u_W.dot(w_W);
  return biped.link_mass_kg * (p_W - body.p_WC).cross(v_W - body.v_WC) +
         biped.link_inertia_across_kgm2 * (w_W - along * u_W) +
         biped.link_inertia_along_kgm2 * along * u_W;
}

}  // namespace

Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  Vector3d momentum = Vector3d::Zero();
  for (const biped::LegState& leg : body.legs) {
    const Vector3d w_W =
        body.w_WB + leg.hinge_axes_W * Vector3d(leg.joint_velocity[0], leg.joint_velocity[1],
                                                leg.joint_velocity[2]);
    const Vector3d v_WH = body.v_WB + body.w_WB.cross(leg.p_WH - body.p_WB);
    const Vector3d& u_W = leg.u_HF_W;
    const Vector3d r_hip_link = biped.hip_link_com_below_hip_m * u_W;
    const Vector3d r_knee_link = (leg.length_m - biped.foot_below_knee_link_com_m) * u_W;
    momentum +=
        LinkMomentum(body, biped, leg.p_WH + r_hip_link, v_WH + w_W.cross(r_hip_link), u_W, w_W);
    momentum += LinkMomentum(body, biped, leg.p_WH + r_knee_link,
                             v_WH + w_W.cross(r_knee_link) + leg.length_rate_mps * u_W, u_W, w_W);
  }
  return momentum;
}

Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  const Vector3d inertia_kgm2(biped.body_inertia_roll_kgm2, biped.body_inertia_pitch_kgm2,
                              biped.body_inertia_yaw_kgm2);
  const Vector3d w_B = body.R_WB.transpose() * body.w_WB;
  return LegsMomentum(body, biped) + body.R_WB * inertia_kgm2.cwiseProduct(w_B) +
         biped.body_mass_kg * (body.p_WB - body.p_WC).cross(body.v_WB - body.v_WC);
}

}  // namespace footing::gait
