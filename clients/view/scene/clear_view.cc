#include "clients/view/scene/clear_view.h"

#include <algorithm>

#include "clients/view/scene/ribbon.h"

namespace footing::scene {
namespace {

constexpr int kSightSteps = 16;
/// Share of the way to the pivot that must be clear: the rest is the figure and its ground.
constexpr double kSightShare = 0.75;
/// Where the way is only looked along, less is enough.
constexpr double kSightOverGroundM = 0.1;

/// How far the eye must rise so that nothing of the ground is before the pivot.
double RiseM(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& pivot_m, double ground_m,
             const stream::Track& track) {
  double rise_m = 0;
  for (int i = 0; i < kSightSteps; ++i) {
    const double share = kSightShare * i / kSightSteps;
    const Eigen::Vector3d p_m = eye_m + share * (pivot_m - eye_m);
    const double floor_m = std::max(ground_m, HeightAt(track, p_m.head<2>(), ground_m));
    const double over_m = i == 0 ? kEyeOverGroundM : kSightOverGroundM;
    // A point of the way rises by its distance from the pivot.
    rise_m = std::max(rise_m, (floor_m + over_m - p_m.z()) / (1 - share));
  }
  return rise_m;
}

/// Out of the upright capsule around a figure, by the shortest way.
Eigen::Vector3d OutOf(const Spot& figure, const Eigen::Vector3d& eye_m) {
  Eigen::Vector3d axis_m = figure.centre_m.cast<double>();
  axis_m.z() = std::clamp(eye_m.z(), axis_m.z(), axis_m.z() + kFigureHeightM - kFigureReachM);
  const Eigen::Vector3d away_m = eye_m - axis_m;
  const double distance_m = away_m.norm();
  if (distance_m >= kFigureReachM || distance_m < 1e-6) return eye_m;
  return axis_m + kFigureReachM / distance_m * away_m;
}

}  // namespace

Camera ClearView(const Picture& picture, const stream::Track& track, const Orbit& orbit) {
  Camera camera = Orbited(picture.camera, orbit);
  for (const Spot& figure : picture.spots) camera.eye_m = OutOf(figure, camera.eye_m);
  const Eigen::Vector3d pivot_m = camera.pivot_m.value_or(camera.target_m);
  camera.eye_m.z() += RiseM(camera.eye_m, pivot_m, static_cast<double>(picture.ground_m), track);
  return camera;
}

}  // namespace footing::scene
