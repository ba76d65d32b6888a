#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"
#include "clients/view/scene/update.h"

/// A mouse over the picture: the character that it points at, and how it pushes it. Places in a
/// picture are in heights of it, from its upper left corner, y down.
namespace footing::scene {

/// A half line from the eye; W.
struct Ray {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< Its length is 1.
};

/// The ray through a place in a picture of that aspect (width over height).
Ray RayThrough(const Camera& camera, double aspect, const Eigen::Vector2d& at);

/// The nearest valid character that the ray hits: an upright capsule from the feet to the head
/// around its COM. Null where it hits none.
const CharacterPose* CharacterAt(const WorldFrame& frame, const Ray& ray);

/// A push on a character, from a drag.
struct Push {
  std::uint32_t character = 0;
  Eigen::Vector2d impulse_W_ns = Eigen::Vector2d::Zero();  ///< N s, along x and y.
};

/// Impulse of a drag over one metre at the character's distance, N s.
inline constexpr double kPushPerMetreNs = 20;
/// A longer drag pushes no harder, N s.
inline constexpr double kMostPushNs = 80;

/// The push that a drag by that many heights of the picture asks for: to the right is to the
/// camera's right, upwards is away from the camera, both along the ground. Nothing for less than
/// half a newton second: a click.
std::optional<Push> PushOf(const Camera& camera, const CharacterPose& pose,
                           const Eigen::Vector2d& drag);

/// Its arrow from the character's COM, as long as the drag, and the impulse beside it.
void AddPush(const WorldFrame& frame, const Push& push, Picture& picture);

/// Stretch of time that sliding curves show.
struct TimeWindow {
  double span_s = kLongestS;
  double age_s = 0;  ///< Age of its right edge.

  static constexpr double kLongestS = 1e-9 * static_cast<double>(kStripNs);
  static constexpr double kShortestS = 0.2;
};

/// Narrower by notches of the wheel (wider where they are negative); the instant at `share` of the
/// width, from the left, stays where it is as far as the curves reach.
TimeWindow Zoomed(const TimeWindow& window, double notches, double share);
/// Curves dragged to the right by that share of the width show earlier times.
TimeWindow Dragged(const TimeWindow& window, double share);

}  // namespace footing::scene
