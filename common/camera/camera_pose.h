#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/stream/hands.h"
#include "common/stream/setup.h"

namespace footing::camera_pose {

/// Where a sphere's centre was seen, in the camera's frame C.
struct SeenPoint {
  Eigen::Vector3d p_C_m{0, 0, 0};
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// Measures of a person that no sensor has: height and half the distance of the shoulders, length
/// of an arm, place over the centre of pressure (x, y), heading, and how high both arms are held
/// ahead and to the sides.
inline constexpr int kBodyMeasures = 8;
/// How far a point of the body moves in W per standard deviation of each measure, m.
using PerMeasure = Eigen::Matrix<double, 3, kBodyMeasures>;

/// A point in W that a sphere is held on.
struct Mark {
  std::string name;                        ///< As a person finds it: "front left, left board".
  Eigen::Vector3d p_W_m{0, 0, 0};          ///< Centre of the sphere.
  PerMeasure per_sd = PerMeasure::Zero();  ///< Zero on a board.
};

/// A mark, and where the camera saw the sphere on it.
struct SeenMark : Mark {
  SeenPoint seen;
};

/// A controller's sphere on a mark, then above the same mark with the controller standing upright.
/// Its accelerometer measures how upright: the line between the two places is gravity's.
struct SeenPlumb {
  SeenPoint low, high;
  double tilt_rad = 0;  ///< Between the controller's long axis and the vertical.
};

/// All that a calibration of the camera's pose takes.
struct Observations {
  std::vector<SeenMark> marks;
  std::vector<SeenPlumb> plumbs;
  double placement_sd_m = 0.001;  ///< Standard deviation of the sphere's place on a mark, per axis.
  bool in_poses = false;          ///< The marks are those of PoseMarks, not of the boards.
};

/// Frames of a sphere at rest that are enough for a mean: half a second of a camera at 60 Hz.
inline constexpr std::size_t kLeastFrames = 30;

/// The mean of a sphere at rest. What of the frames' covariance does not show as scatter is common
/// to all frames (blur and limb of the camera file, the same pixels) and is not averaged away.
/// Refuses fewer than kLeastFrames, and a sphere that moved: its scatter is more than noise and the
/// trembling of a hand explain. A hand against a board trembles by less than a millimetre.
Result<SeenPoint> MeanAtRest(const std::vector<SeenPoint>& frames, double tremble_m = 0.001);

/// Where a camera stands in the boards' world frame W.
using Covariance = Eigen::Matrix<double, 6, 6>;

/// An estimated pose, and how well what was seen fits it.
struct CameraPose {
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  /// Covariance of the turn about W's axes, rad, and of W's origin, m: a point p is off by turn x p
  /// + shift.
  Covariance covariance = Covariance::Zero();
  std::vector<double> residuals_m;  ///< Residual of each mark.
  double residual_rms_m = 0;
  double scale = 1;  ///< True lengths over those that the camera sees.
  double scale_sd = 0;
  double misfit = 0;    ///< Squared residuals over what noise and placement explain; about 1.
  double tilt_rad = 0;  ///< Between gravity by the plumbs and the vertical of the marks.
  /// The person's measures by the fit, in standard deviations from the expected ones.
  Eigen::Matrix<double, kBodyMeasures, 1> body = Eigen::Matrix<double, kBodyMeasures, 1>::Zero();

  /// Covariance of a point of W, as what the pose adds to a measurement.
  Eigen::Matrix3d CovarianceAt(const Eigen::Vector3d& p_W_m) const;
  /// Standard deviation of the turn, of its worst axis.
  double TurnSdRad() const;
};

/// The weighted least squares fit of all marks and plumbs; no check but that there are three marks
/// or more. Depth is what a camera knows worst, so each mark counts by its whole covariance.
CameraPose Fit(const Observations& observations);

/// `Fit`, and refusals, each with what, why and what to do: fewer than three marks, marks in a line
/// (within 0.1 m), a mirrored image, lengths that are off by more than 2 %, a mark in the wrong
/// place, gravity that is off by more than 4 degrees, and a turn that stays uncertain by more than
/// 1 degree (in poses 4).
Result<CameraPose> Calibrate(const Observations& observations);

/// Sight of a tracker in its own frame, from the sample that footingd published of it in W. Nothing
/// where the point was not seen, or the tracker has no frame of its own.
std::optional<SeenPoint> InTrackerFrame(const stream::HandSample& sample);

/// The same sight by another calibration. A sample of a tracker without a frame stays as it is.
stream::HandSample Recalibrated(const stream::HandSample& sample, const Eigen::Isometry3d& X_WC);

/// The paper's calibration (Ha, Bai & Liu 2011, section 5.1, Figure 3: three poses define the
/// origin and the axes of the world) with a sphere in each hand. The person stands on the boards
/// with the arms hanging, straight ahead, and out to the sides; W has z up from the boards'
/// surface, x ahead. The paper does not say which poses its figure shows.
///
/// Places of the left and the right sphere in each pose, in this order, of a person of this height
/// whose centre of pressure is W's origin: add the measured one. The shoulders' place and the arms'
/// length are shares of the height. `fist_to_sphere_m`: how far the sphere is from the middle of
/// the fist, ahead while the arms hang and up otherwise.
std::vector<Mark> PoseMarks(double height_m, double fist_to_sphere_m);

inline constexpr double kPoseSdM = 0.025;       ///< Hand that holds a pose, per axis.
inline constexpr double kPoseTrembleM = 0.008;  ///< Motion of a hand that holds a pose.
inline constexpr double kFistToSphereM = 0.11;  ///< For a PS Move.

/// Four marks on each board, over its load cells, whose places the layout and the board's geometry
/// give; the plates' surface is z = 0 of W, as for the feet on it. Front and left are the person's,
/// also of a board that lies turned. The left board first; of "single" it is the only one.
std::vector<Mark> BoardMarks(const stream::BoardLayout& layout, double radius_m);

}  // namespace footing::camera_pose
