#include "clients/view/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/view/scene/text.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kBehindM = 4.5;
constexpr double kAboveM = 1.5;     // Over the subject's position, which is its hips.
constexpr double kSidewaysM = 1.5;  // A little to the side, so that the legs' bend shows.
constexpr double kTargetAboveM = 0.18;
constexpr double kTargetAheadM = 1.2;  // Besides the look-ahead.
constexpr double kLookAheadS = 0.35;
constexpr double kLongestStepS = 0.1;
constexpr double kJumpM = 2.0;
constexpr double kHeadingRadps = 2.5;
constexpr double kPlaceRadps = 9.0;
constexpr double kHeightRadps = 2.5;  // Slow: the picture must not jolt on a step of the track.
constexpr double kTurnRadps = 2;      // A person turns by many short commands.
constexpr double kIntoCurveS = 0.8, kMostIntoCurveRad = 0.5;
constexpr double kHipsM = 0.95;  // Over the ground, while it stands.
constexpr double kLookAheadRadps = 1.5;

constexpr double kDistanceM = 4.1;
constexpr double kDistanceBesideM = 4.7;
constexpr double kSideRad = 0.42;
constexpr double kEyeHeightM = 1.70;
constexpr double kTargetHeightM = 0.75;
constexpr double kFollowS = 1.0;
constexpr double kNearBoardsM = 0.6;  // So far the camera does not move.

constexpr double kDragRad = kPi;  // A drag over the picture's height turns the view so far.
constexpr double kHighestEyeRad = DegreesToRadians(80);
constexpr double kLowestEyeM = 0.6;  // Below the pivot, which is at the hips.
constexpr double kNotch = 1.12;
constexpr double kNearest = 0.25, kFarthest = 6;
constexpr double kMostShift = 1.5;  // In heights of the picture.

}  // namespace

Eigen::Matrix4f Camera::View() const {
  const Eigen::Vector3d backward = (eye_m - target_m).normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(backward).normalized();
  // A camera that rolls to the left turns the picture to the right.
  const Eigen::Vector3d right = Eigen::AngleAxisd(roll_rad, backward) * level;
  const Eigen::Vector3d up = backward.cross(right);
  Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
  X.block<1, 3>(0, 0) = right.transpose();
  X.block<1, 3>(1, 0) = up.transpose();
  X.block<1, 3>(2, 0) = backward.transpose();
  X.topRightCorner<3, 1>() = -X.topLeftCorner<3, 3>() * eye_m;
  return X.cast<float>();
}

Eigen::Matrix4f Camera::Projection(double aspect) const {
  const double scale = 1 / std::tan(vertical_field_rad / 2);
  Eigen::Matrix4d P = Eigen::Matrix4d::Zero();
  P(0, 0) = scale / aspect;
  P(1, 1) = scale;
  P(2, 2) = -(kFarM + kNearM) / (kFarM - kNearM);
  P(2, 3) = -2 * kFarM * kNearM / (kFarM - kNearM);
  P(3, 2) = -1;
  return P.cast<float>();
}

void Spring::Advance(double goal, double frequency_radps, double dt_s) {
  // Critically damped: with e = x - goal, e(t) = (e0 + (v0 + w e0) t) exp(-w t).
  const double error = value - goal;
  const double slope = rate + frequency_radps * error;
  const double decay = std::exp(-frequency_radps * dt_s);
  value = goal + (error + slope * dt_s) * decay;
  rate = (slope - frequency_radps * (error + slope * dt_s)) * decay;
}

void ChaseCamera::Place(const Subject& subject) {
  placed_ = true;
  heading_ = {subject.heading_rad, 0};
  turn_radps_ = {};
  hips_m_ = subject.support_m ? *subject.support_m + kHipsM : subject.position_m.z();
  look_ahead_ = {kLookAheadS * subject.speed_mps, 0};
  height_ = {hips_m_, 0};
  x_ = {subject.position_m.x(), 0};
  y_ = {subject.position_m.y(), 0};
}

void ChaseCamera::Advance(const Subject& subject, double dt_s) {
  const bool jumped = (subject.position_m - subject_.position_m).norm() > kJumpM;
  const Eigen::Vector3d before_m = subject_.position_m;
  subject_ = subject;
  if (!placed_ || jumped) return Place(subject);
  const double step_s = std::clamp(dt_s, 0.0, kLongestStepS);
  if (step_s <= 0) return;
  // The goal is ahead by what a spring lags behind a steady mover (2 v / w), so a steady speed
  // leaves no offset.
  const Eigen::Vector3d lead_m = (subject.position_m - before_m) / step_s * (2 / kPlaceRadps);
  x_.Advance(subject.position_m.x() + lead_m.x(), kPlaceRadps, step_s);
  y_.Advance(subject.position_m.y() + lead_m.y(), kPlaceRadps, step_s);
  // In flight the ground of the take-off counts: the subject rises in a picture that stands still.
  if (subject.support_m) hips_m_ = *subject.support_m + kHipsM;
  height_.Advance(hips_m_, kHeightRadps, step_s);
  turn_radps_.Advance(subject.turn_radps, kTurnRadps, step_s);
  // The heading, too, is led by its spring's lag.
  const double turn_rad = WrapAngle(subject.heading_rad - heading_.value);
  heading_.Advance(heading_.value + turn_rad + turn_radps_.value * (2 / kHeadingRadps),
                   kHeadingRadps, step_s);
  look_ahead_.Advance(kLookAheadS * subject.speed_mps, kLookAheadRadps, step_s);
}

Camera ChaseCamera::Look() const {
  const double into_curve_rad =
      std::clamp(kIntoCurveS * turn_radps_.value, -kMostIntoCurveRad, kMostIntoCurveRad);
  const double yaw_rad = heading_.value + into_curve_rad;
  const Eigen::Vector3d forward(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  const Eigen::Vector3d left(-forward.y(), forward.x(), 0);
  const Eigen::Vector3d at_m(x_.value, y_.value, height_.value);
  Camera camera;
  camera.pivot_m = at_m;
  camera.eye_m = at_m - kBehindM * forward + kSidewaysM * left + Eigen::Vector3d(0, 0, kAboveM);
  // The middle between straight ahead and past the bird: it stays near the picture's middle.
  const Eigen::Vector3d past = (kBehindM * forward - kSidewaysM * left).normalized();
  camera.target_m = at_m + kTargetAheadM * past + look_ahead_.value * (forward + past) / 2 +
                    Eigen::Vector3d(0, 0, kTargetAboveM);
  return camera;
}

void FrontCamera::Advance(const Eigen::Vector2d& body_m, bool beside, double dt_s) {
  const Eigen::Vector2d away_m = body_m.norm() > kNearBoardsM ? body_m : Eigen::Vector2d(0, 0);
  const Eigen::Vector2d goal_m =
      away_m + (beside ? 0.42 * kBesideM.head<2>() : Eigen::Vector2d(0, 0));
  const double goal_distance_m = beside ? kDistanceBesideM : kDistanceM;
  const double share = placed_ ? 1 - std::exp(-std::clamp(dt_s, 0.0, 1.0) / kFollowS) : 1;
  placed_ = true;
  middle_m_ += share * (goal_m - middle_m_);
  distance_m_ += share * (goal_distance_m - distance_m_);
}

Camera FrontCamera::Look() const {
  Camera camera;
  camera.vertical_field_rad = 0.64;
  camera.target_m = {middle_m_.x(), middle_m_.y(), kTargetHeightM};
  camera.eye_m = {middle_m_.x() + distance_m_ * std::cos(kSideRad),
                  middle_m_.y() + distance_m_ * std::sin(kSideRad), kEyeHeightM};
  return camera;
}

Camera Orbited(const Camera& camera, const Orbit& orbit) {
  const Eigen::Vector3d pivot_m = camera.pivot_m.value_or(camera.target_m);
  const Eigen::Vector3d eye_m = camera.eye_m - pivot_m;
  const double distance_m = orbit.distance * eye_m.norm();
  const double level_m = eye_m.head<2>().norm();
  if (level_m < 1e-6 || distance_m < 1e-6) return camera;
  const double before_rad = std::atan2(eye_m.z(), level_m);
  // Where the view itself is lower or higher than a person may turn it, it stays so.
  const double lowest_rad =
      std::min(before_rad, -std::asin(std::min(1.0, kLowestEyeM / distance_m)));
  const double highest_rad = std::max(before_rad, kHighestEyeRad);
  const double after_rad = std::clamp(before_rad + orbit.elevation_rad, lowest_rad, highest_rad);
  // Upwards around the axis that is to the right of the eye's direction, then around the vertical.
  const Eigen::Vector3d right(-eye_m.y() / level_m, eye_m.x() / level_m, 0);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(orbit.azimuth_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(before_rad - after_rad, right));
  Camera turned = camera;
  turned.eye_m = pivot_m + turn * (orbit.distance * eye_m);
  turned.target_m = pivot_m + turn * (orbit.distance * (camera.target_m - pivot_m));
  const Eigen::Matrix3d axes = turned.View().topLeftCorner<3, 3>().cast<double>();
  const double height_m = 2 * distance_m * std::tan(camera.vertical_field_rad / 2);
  // The picture goes to the right when the eye goes to the left.
  Eigen::Vector3d moved_m =
      height_m * (orbit.shift.y() * axes.row(1) - orbit.shift.x() * axes.row(0)).transpose();
  const double lowest_m = std::min(turned.eye_m.z(), pivot_m.z() - kLowestEyeM);
  moved_m.z() = std::max(moved_m.z(), lowest_m - turned.eye_m.z());
  turned.eye_m += moved_m;
  turned.target_m += moved_m;
  return turned;
}

void MouseOrbit::Begin(Drag drag, const Eigen::Vector2d& at) {
  drag_ = drag;
  last_ = at;
}

void MouseOrbit::Move(const Eigen::Vector2d& at) {
  const Eigen::Vector2d by = at - std::exchange(last_, at);
  if (drag_ == Drag::kTurn) Turn(by);
  if (drag_ != Drag::kShift) return;
  orbit_.shift = (orbit_.shift + by).cwiseMax(-kMostShift).cwiseMin(kMostShift);
}

// The world follows the hand: to the right, the eye goes to the left around it.
void MouseOrbit::Turn(const Eigen::Vector2d& by) {
  orbit_.azimuth_rad = WrapAngle(orbit_.azimuth_rad - kDragRad * by.x());
  orbit_.elevation_rad = std::clamp(orbit_.elevation_rad + kDragRad * by.y(), -kPi / 2, kPi / 2);
}

void MouseOrbit::Scroll(double notches) {
  orbit_.distance = std::clamp(orbit_.distance * std::pow(kNotch, -notches), kNearest, kFarthest);
}

namespace {

using preview::Sight;

PreviewLine LineOf(const preview::Sphere& sphere) {
  const std::string role = RoleText(sphere.role);
  switch (sphere.sight) {
    case Sight::kNothing:
      return {role + ": not seen; nothing of its colour is in the picture"};
    case Sight::kOther:
      return {role + ": not seen; the light of its colour is hidden, too small or not round"};
    case Sight::kChecking:
      return {role + ": being checked; its light is switched off and on"};
    case Sight::kSeen:
      break;
  }
  const std::string seen = role + ": " + text::Fixed(sphere.range_m, 2) + " m, confidence " +
                           text::Fixed(sphere.confidence, 2);
  if (sphere.is_saturated) return {seen + "; too bright: lower the exposure"};
  if (sphere.is_occluded) return {seen + "; partly hidden"};
  return {seen, true};
}

}  // namespace

double PreviewAgeS(const CameraPreview& preview, std::int64_t now_ns) {
  if (!preview.picture) return 0;
  return std::max(0.0, NanosecondsToSeconds(now_ns - preview.picture->exposed_ns));
}

std::string PreviewTrouble(const CameraPreview& preview, std::int64_t now_ns) {
  const std::string since =
      preview.picture
          ? " The last picture is " + text::Fixed(PreviewAgeS(preview, now_ns), 1) + " s old."
          : "";
  switch (preview.state) {
    case CameraPreview::State::kNone:
      return "";
    case CameraPreview::State::kAbsent:
      return "footing-camera is not running (" + preview.why +
             "); start it, or name its socket with --camera-address." + since;
    case CameraPreview::State::kWaiting:
      return "footing-camera is running, but has no frame yet." + since;
    case CameraPreview::State::kRefused:
      return "No preview: " + preview.why + "." + since;
    case CameraPreview::State::kShown:
      break;
  }
  if (PreviewAgeS(preview, now_ns) < kPreviewStaleS) return "";
  return "The stream stopped." + since;
}

std::vector<PreviewLine> PreviewLines(const preview::Picture& picture) {
  std::vector<PreviewLine> lines;
  for (const preview::Sphere& sphere : picture.spheres) lines.push_back(LineOf(sphere));
  if (!picture.has_pose)
    lines.push_back({"where the camera stands is not calibrated: hands are not in the world"});
  return lines;
}

namespace {

/// All of it for a terminal.
std::vector<std::string> PreviewScreen(const CameraPreview& preview, std::int64_t now_ns) {
  const std::string trouble = PreviewTrouble(preview, now_ns);
  if (!trouble.empty()) return {trouble};
  std::vector<std::string> lines;
  if (!preview.picture) return lines;
  lines.push_back("frame " + std::to_string(preview.picture->number) + ", " +
                  text::Fixed(1e3 * PreviewAgeS(preview, now_ns), 0) + " ms old" +
                  (preview.picture->simulated ? "   [SIMULATED]" : ""));
  for (const PreviewLine& line : PreviewLines(*preview.picture)) lines.push_back(line.text);
  for (const preview::RefusedLight& light : preview.picture->refused)
    lines.push_back("a light that stays lit was refused for the " + RoleText(light.role) + " at " +
                    text::Fixed(light.circle.u_px, 0) + ", " + text::Fixed(light.circle.v_px, 0) +
                    " px");
  return lines;
}

}  // namespace

void AddPreviewLines(const CameraPreview& preview, std::int64_t now_ns,
                     std::vector<std::string>& lines) {
  if (preview.state == CameraPreview::State::kNone) return;
  lines.push_back("Camera");
  for (const std::string& line : PreviewScreen(preview, now_ns)) lines.push_back("  " + line);
}

std::string PreviewStatus(const CameraPreview& preview, std::int64_t now_ns) {
  std::string status;
  for (const std::string& line : PreviewScreen(preview, now_ns))
    status += (status.empty() ? "" : "   ") + line;
  return status;
}

}  // namespace footing::scene
