#pragma once

#include <Eigen/Core>

/// The centre of mass by the forces of plates alone, without masses of segments.
namespace footing::pose_run {

/// What all plates together measured, a column a frame, W.
struct ForceCourse {
  double rate_hz = 0;
  Eigen::Matrix3Xd force_n;  ///< On the person, with the shear.
  Eigen::Matrix2Xd cop_m;    ///< Counts by the load on it; finite where there is one.
};

/// Path of the COM, m, a column a frame: the force integrated twice. Constants of the integration
/// are fitted over the whole course by least squares. Upwards they are height, velocity and mass,
/// fitted to `height_m`, a path of the COM's height by other means. Level they are place, velocity
/// and a constant force, so that the angular momentum which the COP implies about the COM changes
/// by nothing in the mean: COP = c - z / (g + z'') c'' (Zatsiorsky & King 1998 fix the constants
/// where c'' is 0). A body in place needs to turn to and fro in the course: five seconds of squats
/// will do, a single jump will not.
Eigen::Matrix3Xd ComByForce(const ForceCourse& course, const Eigen::VectorXd& height_m);

}  // namespace footing::pose_run
