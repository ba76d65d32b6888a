#include "common/virtual/devices/stance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"

namespace footing::virtual_sensors {
namespace {

using body::Landmark;

constexpr double kLeastFootM = 0.02;  // From ankle to toe over the ground; shorter is on end.
constexpr double kMostTurnRad = 0.8;
// Further apart nobody stands upright for five seconds; closer, one foot is on the other.
constexpr double kMostAheadM = 0.5, kLeastApartM = 0.06, kMostApartM = 0.8;
constexpr double kMostThighTurnRad = 0.5;  // Clips of standing people begin with up to 0.56.
constexpr double kFirstBendRad = 0.2;      // A straight knee could be bent either way.
constexpr double kStretchedShare = 0.999;  // Of a leg's length: a straight one cannot be bent.

/// The way from the right ankle to the left one as near to this as a person can stand.
Eigen::Vector2d AsOneStands(const Eigen::Vector2d& apart_m) {
  return {std::clamp(apart_m.x(), -kMostAheadM, kMostAheadM),
          std::clamp(apart_m.y(), kLeastApartM, kMostApartM)};
}

/// How far the foot is turned over the ground from where it points in the T-pose, rad. 0 for one
/// that is on end, or turned further than anybody stands: it is in the air.
double TurnOf(const body::Body& body, const body::Kinematics& standing, const body::Kinematics& at,
              int foot) {
  const auto ahead_m = [&](const body::Kinematics& pose) -> Eigen::Vector2d {
    const auto place = [&](Landmark left) -> Eigen::Vector2d {
      const int joint = body.landmarks[body::OfSide(left, foot)];
      return pose.p_WJ[static_cast<std::size_t>(joint)].head<2>();
    };
    return place(Landmark::kLeftToe) - place(Landmark::kLeftAnkle);
  };
  if (body.landmarks[body::OfSide(Landmark::kLeftToe, foot)] < 0) return 0;
  const Eigen::Vector2d straight = ahead_m(standing), turned = ahead_m(at);
  if (straight.norm() < kLeastFootM || turned.norm() < kLeastFootM) return 0;
  const double cross = straight.x() * turned.y() - straight.y() * turned.x();
  const double turn_rad = std::atan2(cross, straight.dot(turned));
  return std::abs(turn_rad) > kMostTurnRad ? 0 : turn_rad;
}

}  // namespace

Stance::Stance(const body::Body& body, const Eigen::VectorXd& t_pose,
               const Eigen::VectorXd& first_q)
    : body_(body),
      legs_{motion::LegSolver(body, true, motion::LegAim::kWhole),
            motion::LegSolver(body, false, motion::LegAim::kWhole)},
      stance_(Places(t_pose)),
      first_(Places(first_q)) {
  const Eigen::Vector2d middle_m = (first_[0].p_WA + first_[1].p_WA).head<2>() / 2;
  const Eigen::Vector2d apart_m = AsOneStands((first_[0].p_WA - first_[1].p_WA).head<2>());
  stance_[0].p_WA.head<2>() = middle_m + apart_m / 2;
  stance_[1].p_WA.head<2>() = middle_m - apart_m / 2;
  body::Kinematics standing(body.skeleton), beginning(body.skeleton);
  body::ComputeKinematics(body.skeleton, t_pose, standing);
  body::ComputeKinematics(body.skeleton, first_q, beginning);
  for (int foot = 0; foot < kFeet; ++foot) {
    motion::FootPlace& place = stance_[static_cast<std::size_t>(foot)];
    const double turn_rad = TurnOf(body, standing, beginning, foot);
    place.R_WA = body::AxisRotation(body::Axis::kZ, turn_rad) * place.R_WA;
    place.thigh_turn_rad = std::clamp(first_[static_cast<std::size_t>(foot)].thigh_turn_rad,
                                      -kMostThighTurnRad, kMostThighTurnRad);
  }
}

FeetPlaces Stance::Places(const Eigen::VectorXd& q) const {
  body::Kinematics at(body_.skeleton);
  body::ComputeKinematics(body_.skeleton, q, at);
  FeetPlaces places;
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const auto ankle = static_cast<std::size_t>(legs_[foot].ankle());
    places[foot] = {at.p_WJ[ankle], at.R_WJ[ankle], legs_[foot].ThighTurn(at)};
  }
  return places;
}

void Stance::StandOver(Eigen::VectorXd& q) {
  const FeetPlaces now = Places(q);
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    q.head<2>() += (stance_[foot].p_WA - now[foot].p_WA).head<2>() / kFeet;
  }
  body::Kinematics at(body_.skeleton);
  body::ComputeKinematics(body_.skeleton, q, at);
  double too_high_m = 0;
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const motion::LegSolver& leg = legs_[foot];
    const Eigen::Vector3d up_m = at.p_WJ[static_cast<std::size_t>(leg.hip())] - stance_[foot].p_WA;
    const double reach_m = kStretchedShare * (leg.thigh_m() + leg.shank_m());
    const double below_m =
        std::sqrt(std::max(0.0, reach_m * reach_m - up_m.head<2>().squaredNorm()));
    too_high_m = std::max(too_high_m, up_m.z() - below_m);
  }
  q(2) -= too_high_m;
  for (motion::LegSolver& leg : legs_) leg.BendKnee(kFirstBendRad, q);
  KeepFeet(0, q);
}

void Stance::KeepFeet(double share, Eigen::VectorXd& q) {
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const motion::FootPlace &from = stance_[foot], &to = first_[foot];
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(from.R_WA).slerp(share, Eigen::Quaterniond(to.R_WA));
    const double thigh_turn_rad =
        from.thigh_turn_rad + share * (to.thigh_turn_rad - from.thigh_turn_rad);
    legs_[foot].Solve(
        {from.p_WA + share * (to.p_WA - from.p_WA), turn.toRotationMatrix(), thigh_turn_rad}, q);
  }
}

}  // namespace footing::virtual_sensors
