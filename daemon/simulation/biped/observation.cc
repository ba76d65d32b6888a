#include <algorithm>
#include <cmath>

#include "daemon/simulation/biped/parts.h"

namespace footing::physics {
namespace {

Eigen::Vector3d Vector(const mjtNum* values) { return {values[0], values[1], values[2]}; }

}  // namespace

void ReadContacts(const mjModel& model, mjData& state, const std::array<int, kLegs>& feet,
                  Observation& observation) {
  observation.normal_force_n.fill(0);
  observation.contact_force_W_n.setZero();
  observation.other_contact = false;
  for (int i = 0; i < state.ncon; ++i) {
    const mjContact& contact = state.contact[i];
    mjtNum force[6];  // Contact frame: its first axis is the normal, from geom1 to geom2.
    mj_contactForce(&model, &state, i, force);
    for (int axis = 0; axis < 3; ++axis) {
      observation.contact_force_W_n += force[axis] * Vector(contact.frame + 3 * axis);
    }
    bool foot = false;
    for (int leg = 0; leg < kLegs; ++leg) {
      if (contact.geom1 != feet[leg] && contact.geom2 != feet[leg]) continue;
      observation.normal_force_n[leg] += force[0];
      foot = true;
    }
    if (!foot) observation.other_contact = true;
  }
}

void ReadMotion(const mjModel& model, const mjData& state, const std::array<int, kLinks>& links,
                const std::array<int, kLegs>& hips, const std::array<int, kLegs>& feet,
                double mass_kg, Observation& observation) {
  const int root = links[0];
  observation.diverged = state.warning[mjWARN_BADQPOS].number > 0 ||
                         state.warning[mjWARN_BADQVEL].number > 0 ||
                         state.warning[mjWARN_BADQACC].number > 0;
  observation.p_WB = Vector(state.qpos);
  observation.v_WB = Vector(state.qvel);
  observation.R_WB =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.xmat + 9 * root);
  observation.w_WB = observation.R_WB * Vector(state.qvel + 3);
  for (int i = 0; i < kJoints; ++i) {
    observation.joint_position[i] = state.qpos[7 + i];
    observation.joint_velocity[i] = state.qvel[kRootDofs + i];
  }
  observation.p_WC = Vector(state.subtree_com + 3 * root);
  // cvel is (angular, linear) at the mechanism's COM, so each link's COM moves with
  // v + w x (its COM - the mechanism's COM).
  Eigen::Vector3d momentum_W = Eigen::Vector3d::Zero();
  for (const int link : links) {
    const Eigen::Vector3d w = Vector(state.cvel + 6 * link);
    const Eigen::Vector3d v = Vector(state.cvel + 6 * link + 3);
    const Eigen::Vector3d arm = Vector(state.xipos + 3 * link) - observation.p_WC;
    momentum_W += model.body_mass[link] * (v + w.cross(arm));
  }
  observation.v_WC = momentum_W / mass_kg;
  for (int leg = 0; leg < kLegs; ++leg) {
    observation.p_WH[leg] = Vector(state.xpos + 3 * hips[leg]);
    observation.p_WF[leg] = Vector(state.geom_xpos + 3 * feet[leg]);
  }
}

double HiddenRootForce(const mjModel& model, const mjData& state, int root,
                       const Eigen::Vector3d& push_W_n) {
  double largest = 0;
  for (int i = 0; i < kRootDofs; ++i) {
    largest = std::max({largest, std::fabs(state.qfrc_applied[i]), std::fabs(state.qfrc_passive[i]),
                        std::fabs(state.qfrc_actuator[i])});
  }
  for (int body = 0; body < model.nbody; ++body) {
    for (int i = 0; i < 6; ++i) {
      const double expected = body == root && i < 3 ? push_W_n[i] : 0;
      largest = std::max(largest, std::fabs(state.xfrc_applied[6 * body + i] - expected));
    }
  }
  return largest;
}

}  // namespace footing::physics
