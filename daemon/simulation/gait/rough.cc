#include "daemon/simulation/gait/rough.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "daemon/simulation/gait/foothold.h"

namespace footing::gait {

using Eigen::Vector3d;

bool IsSlippery(const Context& context) {
  return context.biped.sliding_friction < context.gains.grip.friction;
}

namespace {

/// How far ahead of the COM a foot may touch down; infinite on ordinary ground without a tow.
double ReachAhead(const Context& context, const GaitMemory& memory, bool hops) {
  const Gains& gains = context.gains;
  double ahead_m = std::numeric_limits<double>::infinity();
  if (!memory.tow.offset_W.isZero(0)) {
    const double height_m =
        hops ? memory.pit.last_hop.touchdown_height_m : gains.walking.hip_height_m;
    ahead_m = std::max(0.0, gains.tow.reach_m - TowOffset(memory, height_m).norm());
  }
  if (!IsSlippery(context)) return ahead_m;
  const double friction = context.biped.sliding_friction;
  if (hops) {
    return std::min(ahead_m, gains.grip.run_share * friction * gains.hopping.touchdown_length_m);
  }
  const double slant_m = gains.grip.walk_share * friction * gains.walking.hip_height_m;
  const double aside_m = gains.walking.step_width_m / 2;
  return std::min(ahead_m, std::sqrt(std::max(0.0, slant_m * slant_m - aside_m * aside_m)));
}

}  // namespace

double SlantSpeed(const Context& context, const GaitMemory& memory) {
  const bool hops = IsHopping(memory.gait) || memory.transition.thrusting;
  const double time_s = hops ? memory.hop.support_time_s : StepTime(context, memory);
  return 2 * ReachAhead(context, memory, hops) / time_s;
}

double GripPace(const Context& context) {
  return std::min(1.0, context.biped.sliding_friction / context.gains.grip.friction);
}

namespace {

using Eigen::Vector2d;

/// Interval of which each force is the mean, s.
constexpr double kFeltEveryS = 0.01;

/// The middle one of the last forces, axis by axis.
Vector2d Median(const TowMemory& tow) {
  Vector2d median;
  for (int axis = 0; axis < 2; ++axis) {
    std::array<double, kTowForces> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = tow.forces_W_n[i][axis];
    std::nth_element(values.begin(), values.begin() + kTowForces / 2, values.end());
    median[axis] = values[kTowForces / 2];
  }
  return median;
}

}  // namespace

void FeelTow(const Context& context, GaitMemory& memory) {
  TowMemory& tow = memory.tow;
  const double mass_kg = context.biped.mass_kg();
  const Vector2d momentum_W_ns = mass_kg * context.body.v_WC.head<2>();
  tow.contact_W_ns += context.step_s * context.body.contact_force_W_n.head<2>();
  if (tow.steps > 0 && tow.steps * context.step_s < kFeltEveryS - context.step_s / 2) {
    ++tow.steps;
    return;
  }
  if (tow.steps > 0) {
    tow.forces_W_n[tow.next] =
        (momentum_W_ns - tow.momentum_W_ns - tow.contact_W_ns) / (tow.steps * context.step_s);
    tow.next = (tow.next + 1) % kTowForces;
  }
  tow.steps = 1;
  tow.momentum_W_ns = momentum_W_ns;
  tow.contact_W_ns.setZero();
  const Vector2d felt_W_n = Median(tow);
  const double slack_n = context.gains.tow.slack_n;
  const double counts = std::clamp(felt_W_n.norm() / slack_n - 1, 0.0, 1.0);
  tow.offset_W << counts / (mass_kg * kStandardGravityMps2) * felt_W_n, 0;
  const Vector3d ahead_W = ToWorld(memory.heading_rad, {1, 0, 0});
  tow.offset_W -=
      std::max(0.0, tow.offset_W.dot(ahead_W) - context.gains.tow.ahead_share) * ahead_W;
}

Vector3d TowOffset(const GaitMemory& memory, double height_m) {
  return height_m * memory.tow.offset_W;
}

double TowCrouch(const Context& context, const GaitMemory& memory) {
  return context.gains.tow.crouch_m * memory.tow.offset_W.norm();
}

}  // namespace footing::gait
