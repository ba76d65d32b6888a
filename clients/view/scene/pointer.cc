#include "clients/view/scene/pointer.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/signs.h"
#include "clients/view/scene/text.h"

namespace footing::scene {
namespace {

// A capsule around the COM, as wide as the bird's trunk and the person's shoulders.
constexpr double kReachM = 0.35;
constexpr double kBelowComM = 0.65, kAboveComM = 0.65;

constexpr double kLeastPushNs = 0.5;
constexpr double kZoomNotch = 1.25;

/// Where along the ray it passes the upright line through `com_m` within kReachM; nothing where it
/// does not.
std::optional<double> HitM(const Ray& ray, const Eigen::Vector3d& com_m) {
  // Closest points of p + s d and q + t z: with z upright only d's level part decides on s.
  const Eigen::Vector3d to_com_m = com_m - ray.from_m;
  const double level = ray.direction.head<2>().squaredNorm();
  if (level < 1e-12) return std::nullopt;
  double along_m = to_com_m.head<2>().dot(ray.direction.head<2>()) / level;
  const double up_m = ray.direction.z() * along_m - to_com_m.z();
  // Beside an end of the line, the end itself is the closest point.
  const double clamped_m = std::clamp(up_m, -kBelowComM, kAboveComM);
  if (up_m != clamped_m) {
    along_m = (to_com_m + Eigen::Vector3d(0, 0, clamped_m)).dot(ray.direction);
  }
  if (along_m <= 0) return std::nullopt;
  const Eigen::Vector3d away_m =
      along_m * ray.direction - to_com_m - Eigen::Vector3d(0, 0, clamped_m);
  return away_m.norm() <= kReachM ? std::optional(along_m) : std::nullopt;
}

double HeightAtM(const Camera& camera, const Eigen::Vector3d& p_m) {
  return 2 * (p_m - camera.eye_m).norm() * std::tan(camera.vertical_field_rad / 2);
}

}  // namespace

Ray RayThrough(const Camera& camera, double aspect, const Eigen::Vector2d& at) {
  const double half = std::tan(camera.vertical_field_rad / 2);
  const Eigen::Vector3d in_camera(half * (2 * at.x() - aspect), half * (1 - 2 * at.y()), -1);
  const Eigen::Matrix3d axes = camera.View().topLeftCorner<3, 3>().cast<double>();
  return {camera.eye_m, (axes.transpose() * in_camera).normalized()};
}

const CharacterPose* CharacterAt(const WorldFrame& frame, const Ray& ray) {
  const CharacterPose* nearest = nullptr;
  double nearest_m = kFarM;
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.valid) continue;
    const auto hit_m = HitM(ray, pose.com_m);
    if (!hit_m || *hit_m >= nearest_m) continue;
    nearest = &pose;
    nearest_m = *hit_m;
  }
  return nearest;
}

std::optional<Push> PushOf(const Camera& camera, const CharacterPose& pose,
                           const Eigen::Vector2d& drag) {
  const Eigen::Vector2d ahead = (camera.target_m - camera.eye_m).head<2>().normalized();
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  Eigen::Vector2d impulse_ns =
      kPushPerMetreNs * HeightAtM(camera, pose.com_m) * (drag.x() * right - drag.y() * ahead);
  const double size_ns = impulse_ns.norm();
  if (!(size_ns >= kLeastPushNs)) return std::nullopt;
  if (size_ns > kMostPushNs) impulse_ns *= kMostPushNs / size_ns;
  return Push{pose.character, impulse_ns};
}

void AddPush(const WorldFrame& frame, const Push& push, Picture& picture) {
  const auto pose = std::find_if(
      frame.characters.begin(), frame.characters.end(),
      [&push](const CharacterPose& one) { return one.character == push.character && one.valid; });
  if (pose == frame.characters.end()) return;
  const Eigen::Vector3f com = pose->com_m.cast<float>();
  const Eigen::Vector2f level = (push.impulse_W_ns / kPushPerMetreNs).cast<float>();
  const Eigen::Vector3f tip = com + Eigen::Vector3f(level.x(), level.y(), 0);
  const Colour colour = Rgb(0xffd23f);
  AddArrow(com, tip, 0.022f, colour, picture.signs);
  picture.labels.push_back({tip, Fixed(push.impulse_W_ns.norm(), 0) + " N s", colour});
}

TimeWindow Zoomed(const TimeWindow& window, double notches, double share) {
  TimeWindow zoomed;
  zoomed.span_s = std::clamp(window.span_s * std::pow(kZoomNotch, -notches), TimeWindow::kShortestS,
                             TimeWindow::kLongestS);
  const double left = 1 - std::clamp(share, 0.0, 1.0);
  zoomed.age_s = window.age_s + left * (window.span_s - zoomed.span_s);
  return Dragged(zoomed, 0);
}

TimeWindow Dragged(const TimeWindow& window, double share) {
  TimeWindow moved = window;
  moved.age_s =
      std::clamp(window.age_s + share * window.span_s, 0.0, TimeWindow::kLongestS - window.span_s);
  return moved;
}

}  // namespace footing::scene
