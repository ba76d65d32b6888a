#include "daemon/simulation/gait/leg_room.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/gait/attitude.h"
#include "daemon/simulation/gait/frames.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// The gap is asked for in full from this bank on.
constexpr double kFullBankRad = 0.1;
/// It is given up between this tilt of the body, which runs in curves do not reach, and twice that.
constexpr double kPushedRad = 0.15;
/// The same where the run goes straight ahead.
constexpr double kPushedStraightRad = 0.06;
/// In a curve the idle leg begins to turn outwards this much before the legs pass each other, at
/// about twice the run's speed: its servo follows late, and at 6 m/s they come from 14 cm to 7 cm
/// in 6 ms. Straight ahead, 4 of 384 runs of 6 m/s fell with that by pushes of 26 N s.
constexpr double kPassingLeadS = 0.015;
/// A leg that is less steep reaches no other.
constexpr double kSteepEnoughM = -0.2;

/// Where the line from a hip along `r_HF_m` is at a height.
Vector3d AtHeight(const Vector3d& hip_m, const Vector3d& r_HF_m, double height_m) {
  return hip_m + (height_m - hip_m.z()) / r_HF_m.z() * r_HF_m;
}

/// From 0 to 1: how much of a curve it is.
double InCurve(const Context& context, const GaitMemory& memory) {
  return std::min(1.0, std::fabs(BankAngle(memory, context.gains.attitude)) / kFullBankRad);
}

/// From 0 to 1: how much of the gap is asked for.
double Asked(const Context& context, const GaitMemory& memory) {
  const double tilt_rad = std::fabs(TiltAside(context.body, memory, context.gains.attitude));
  const auto upright = [tilt_rad](double pushed_rad) {
    return std::clamp(2 - tilt_rad / pushed_rad, 0.0, 1.0);
  };
  return std::max(InCurve(context, memory) * upright(kPushedRad), upright(kPushedStraightRad));
}

}  // namespace

double SideStep(double outward_m, double gap_m) {
  return std::max(outward_m, gap_m + 2 * std::min(0.0, outward_m));
}

void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets) {
  const double gap_m = context.gains.curve.leg_gap_m;
  const int leg = 1 - memory.support_leg;
  LegTarget& target = targets.legs[leg];
  if (gap_m <= 0 || memory.gait != stream::Gait::kRun || target.task != LegTask::kPlace) return;
  const double asked = Asked(context, memory);
  const biped::LegState &own = context.body.legs[leg], &other = context.body.legs[1 - leg];
  const Vector3d r_other_m = other.p_WF - other.p_WH;
  if (asked <= 0 || target.r_HF_W_m.z() > kSteepEnoughM || r_other_m.z() > kSteepEnoughM) return;

  // Both at the height of the upper foot; side by side they are nearest there.
  const double height_m = std::max(own.p_WH.z() + target.r_HF_W_m.z(), other.p_WF.z());
  const Vector3d feet_H =
      ToHeading(memory.heading_rad, AtHeight(own.p_WH, target.r_HF_W_m, height_m) -
                                        AtHeight(other.p_WH, r_other_m, height_m));
  const Vector3d hips_H = ToHeading(memory.heading_rad, own.p_WH - other.p_WH);
  const double side = biped::Side(leg);
  const double outward_m = side * feet_H.y(), hips_m = side * hips_H.y();
  if (outward_m >= gap_m) return;
  // Where they cross, how far are they apart fore and aft?
  const double way = outward_m < 0 && hips_m > 0 ? hips_m / (hips_m - outward_m) : 1;
  const double ahead_m = std::fabs(std::lerp(hips_H.x(), feet_H.x(), way));
  const double lead_s = kPassingLeadS * InCurve(context, memory);
  const double near_m = gap_m + lead_s * 2 * std::fabs(memory.speed.desired_mps);
  const double share = asked * std::clamp(2 - ahead_m / near_m, 0.0, 1.0);
  const double reach = target.r_HF_W_m.z() / (height_m - own.p_WH.z());
  const double length_m = target.r_HF_W_m.norm();
  target.r_HF_W_m +=
      ToWorld(memory.heading_rad, {0, side * share * reach * (gap_m - outward_m), 0});
  target.r_HF_W_m *= length_m / target.r_HF_W_m.norm();
}

}  // namespace footing::gait
