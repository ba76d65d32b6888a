#pragma once

#include <Eigen/Geometry>
#include <span>

#include "clients/skeleton/tracking/joints.h"
#include "common/base/result.h"

namespace footing::skeleton {

/// Where the camera is in W and where it looks.
struct CameraPlace {
  Eigen::Vector3d p_W_m{2.5, 0, 1};  ///< Of K's origin, above the boards' surface.
  double yaw_rad =
      3.141592653589793;  ///< Of its look about W's z; 0 looks along x, pi at a person.
  double pitch_rad = 0;   ///< Upwards positive.
  double roll_rad = 0;    ///< Its left side up is positive.
};

/// K in W.
Eigen::Isometry3d ToPose(const CameraPlace& place);

/// A place found from a person who stands on the boards.
struct StandingFit {
  CameraPlace place;
  double lean_rad = 0;   ///< Of the trunk against the camera's up: its tilt, or the person's.
  double scatter_m = 0;  ///< Standard deviation of the middle of the feet.
};

inline constexpr double kStandingS = 2;
inline constexpr std::size_t kLeastStandingFrames = 10;  ///< However long they take.
inline constexpr double kMostLeanRad = 0.26;             ///< 15 degrees.
inline constexpr double kMostScatterM = 0.03;
inline constexpr double kAnkleHeightM = 0.08;  ///< Of an ankle's centre above the sole.

/// The place of a camera from frames of a person who stands still on the boards, facing along W's
/// x: left is where shoulders and hips say, the middle of the ankles is above W's origin. Pitch and
/// roll are known from `known`. Failure says what to do: too few whole frames, a person who moves,
/// a trunk that leans by more than 15 degrees. If left and right are swapped, the camera would be
/// on the opposite side, so it is a failure, too, that the toes point back, or that the person does
/// not face a camera where there is one (`by_camera`).
Result<StandingFit> FitStanding(std::span<const Skeleton> frames, const CameraPlace& known,
                                bool by_camera = true);

}  // namespace footing::skeleton
