#include "clients/view/scene/calibration.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/boards.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"
#include "common/board/geometry.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

using guide::MarkState;

constexpr float kPadRadiusM = 0.03f, kBallRadiusM = 0.0225f;
constexpr float kUprightM =
    0.16f;  // From the mark to the sphere of a controller that stands on it.
constexpr double kPulseHz = 1;
constexpr double kFrustumM = 0.25;

Colour ColourOfMark(MarkState::Stage stage) {
  switch (stage) {
    case MarkState::Stage::kToCome:
      return Rgb(0x8c939c);
    case MarkState::Stage::kNext:
      return Rgb(0xf2a33c);
    case MarkState::Stage::kTaken:
      return Rgb(0x3fbf6f);
  }
  return Rgb(0x8c939c);
}

/// The sphere as it should be held; it swells and shrinks, so that it is seen at once.
void AddNext(const MarkState& mark, bool upright, std::int64_t now_ns, Picture& picture) {
  const double phase = 2 * kPi * kPulseHz * NanosecondsToSeconds(now_ns);
  const float radius = kBallRadiusM * static_cast<float>(1.15 + 0.25 * std::sin(phase));
  const Colour colour = ColourOfMark(mark.stage);
  Eigen::Vector3f at = mark.p_W_m.cast<float>();
  if (upright) {
    const Eigen::Vector3f foot(at.x(), at.y(), 0);
    at.z() += kUprightM;
    picture.figures.AddRod(foot, at, 0.02f, 0.016f, Rgb(0x20242a), 0.3f);
  }
  picture.signs.AddBall(
      Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(radius)), colour, colour,
      0.3f);
  picture.labels.push_back(
      {at, upright ? "stand the controller here" : "hold the sphere here", colour});
}

void AddMark(const MarkState& mark, Picture& picture) {
  const Colour colour = ColourOfMark(mark.stage);
  const Eigen::Vector3f at = mark.p_W_m.cast<float>();
  picture.clear.AddDisc({at.x(), at.y(), 0.002f}, {kPadRadiusM, kPadRadiusM}, 0, colour);
  if (mark.stage != MarkState::Stage::kTaken) return;
  picture.figures.AddBall(
      Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(kBallRadiusM)), colour,
      colour, 0.2f);
  if (mark.residual_m)
    picture.labels.push_back({at, text::Fixed(1e3 * *mark.residual_m, 1) + " mm", colour});
}

/// A body and what it looks at.
void AddCamera(const Eigen::Isometry3d& X_WC, Picture& picture) {
  const Eigen::Vector3f eye = X_WC.translation().cast<float>();
  const Colour colour = Rgb(0x62bfee);
  picture.figures.AddBox(eye, X_WC.linear().cast<float>(), {0.09f, 0.05f, 0.05f}, Rgb(0x20242a));
  Eigen::Vector3f corners[4];
  for (int i = 0; i < 4; ++i) {
    const double right = (i == 0 || i == 3 ? -0.6 : 0.6) * kFrustumM;
    const double down = (i < 2 ? -0.45 : 0.45) * kFrustumM;
    corners[i] = (X_WC * Eigen::Vector3d(right, down, kFrustumM)).cast<float>();
  }
  for (int i = 0; i < 4; ++i) {
    picture.figures.AddRod(eye, corners[i], 0.004f, 0.004f, colour);
    picture.figures.AddRod(corners[i], corners[(i + 1) % 4], 0.004f, 0.004f, colour);
  }
  picture.labels.push_back({eye, "camera", colour});
}

}  // namespace

void AddCalibration(const Model& model, std::int64_t now_ns, Picture& picture) {
  const Calibration& calibration = *model.observed.calibration;
  picture.studio = true;
  picture.ground_m = picture.floor_m = static_cast<float>(-board::kPlateHeightM);
  picture.camera.eye_m = {-1.15, 0, 1.15};
  picture.camera.target_m = {0.1, 0, -0.1};
  picture.camera.vertical_field_rad = 0.64;
  AddPlates(BoardsOf(model, calibration.rig, now_ns), picture.figures);
  picture.spots.push_back({Eigen::Vector3f(0, 0, picture.floor_m), {0, 0}});
  if (!calibration.marks) return;
  for (const MarkState& mark : calibration.marks->marks) {
    AddMark(mark, picture);
    if (mark.stage == MarkState::Stage::kNext && !calibration.result)
      AddNext(mark, calibration.marks->upright, now_ns, picture);
  }
  if (!calibration.marks->X_WC) return;
  AddCamera(*calibration.marks->X_WC, picture);
  // From the side, so that the boards and the camera are in the picture, above the panel.
  const Eigen::Vector3d camera_m = calibration.marks->X_WC->translation();
  const Eigen::Vector3d middle_m = camera_m / 2 - Eigen::Vector3d(0, 0, 0.3);
  picture.camera.target_m = middle_m;
  picture.camera.eye_m =
      middle_m + (1.2 + 1.1 * camera_m.norm()) * Eigen::Vector3d(-0.45, -0.75, 0.5).normalized();
}

std::string CalibrationTitle(const Calibration& calibration) {
  if (calibration.result)
    return calibration.result->passed ? "The camera's pose is measured." : "Refused.";
  return calibration.prompt.empty() ? "Waiting for footingd." : calibration.prompt;
}

std::string CalibrationDetail(const Calibration& calibration) {
  if (calibration.result) return calibration.result->note;
  return calibration.feedback;
}

std::string CalibrationProgress(const Calibration& calibration) {
  std::string text = "Where the camera stands";
  if (calibration.result || !calibration.marks || calibration.marks->all == 0) return text;
  const std::size_t number = std::min(calibration.marks->done + 1, calibration.marks->all);
  return text + ", " + std::to_string(number) + " of " + std::to_string(calibration.marks->all);
}

}  // namespace footing::scene
