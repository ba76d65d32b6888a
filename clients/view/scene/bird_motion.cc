#include "clients/view/scene/bird_motion.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kHeadS = 0.2;
constexpr double kToesS = 0.05;
constexpr double kWingsOpenS = 0.18;
constexpr double kWingsCloseS = 0.25;
constexpr double kMaxLiftM = 0.10;

/// The share of the way to its goal that a first-order filter goes in dt_s.
double Share(double dt_s, double time_constant_s) { return 1 - std::exp(-dt_s / time_constant_s); }

int IndexOf(const std::vector<stream::Link>& links, const char* name, int otherwise) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == name) return static_cast<int>(i);
  }
  return otherwise;
}

int IndexOf(const std::vector<std::string>& points, const char* name, int otherwise) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] == name) return static_cast<int>(i);
  }
  return otherwise;
}

bool Touches(const CharacterPose& pose, int contact) {
  return contact < static_cast<int>(pose.contacts.size()) &&
         pose.contacts[static_cast<std::size_t>(contact)].touching;
}

}  // namespace

BirdSkeleton FindParts(const stream::Skeleton& skeleton) {
  BirdSkeleton found;
  found.body = IndexOf(skeleton.links, "body", found.body);
  found.hips = {IndexOf(skeleton.links, "left_hip", found.hips[0]),
                IndexOf(skeleton.links, "right_hip", found.hips[1])};
  found.feet = {IndexOf(skeleton.contact_points, "left_foot", found.feet[0]),
                IndexOf(skeleton.contact_points, "right_foot", found.feet[1])};
  return found;
}

BirdMotion Advance(const BirdMotion& motion, const BirdSkeleton& skeleton,
                   const CharacterPose& pose, double dt_s) {
  if (skeleton.body >= static_cast<int>(pose.links.size())) return motion;
  const stream::LinkPose& body = pose.links[static_cast<std::size_t>(skeleton.body)];
  const Eigen::Vector3d forward = body.orientation * Eigen::Vector3d::UnitX();
  const double yaw_rad = std::atan2(forward.y(), forward.x());
  const double pitch_rad = std::asin(std::clamp(forward.z(), -1.0, 1.0));
  const double height_m = body.position_m.z();

  BirdMotion next = motion;
  if (!motion.placed) {
    next.placed = true;
    next.head_yaw_rad = yaw_rad;
    next.head_pitch_rad = pitch_rad;
    next.body_height_m = height_m;
  }
  const double head = Share(dt_s, kHeadS);
  next.head_yaw_rad = WrapAngle(next.head_yaw_rad + head * WrapAngle(yaw_rad - next.head_yaw_rad));
  next.head_pitch_rad += head * (pitch_rad - next.head_pitch_rad);
  next.body_height_m += head * (height_m - next.body_height_m);
  next.head_lift_m = std::clamp(next.body_height_m - height_m, -kMaxLiftM, kMaxLiftM);
  bool airborne = true;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const bool touching = Touches(pose, skeleton.feet[leg]);
    airborne = airborne && !touching;
    next.toe_spread[leg] += Share(dt_s, kToesS) * ((touching ? 1 : 0) - next.toe_spread[leg]);
  }
  next.wing_spread +=
      Share(dt_s, airborne ? kWingsOpenS : kWingsCloseS) * ((airborne ? 1 : 0) - next.wing_spread);
  return next;
}

}  // namespace footing::scene
