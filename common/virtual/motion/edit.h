#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/motion.h"

/// Edits of a motion before it is used.
namespace footing::motion {

/// The same pose by the angles nearest to those of `near_q`: of the triples and whole turns that
/// mean the same rotation of a joint. The root's place is that of `q`.
Eigen::VectorXd NearestPose(const body::Skeleton& skeleton, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& near_q);

/// The same rotations with angles that do not jump: of the triples and whole turns that mean the
/// same, each frame takes those nearest to the frame before.
Motion Continuous(Motion motion);

/// Continuous from a first frame whose angles are those nearest to 0: the same movement has the
/// same angles whatever whole turns and triples its file has them with.
Motion Canonical(Motion motion);

/// Smoothed by LowPass. About 8 Hz for daily movement, 14 for jumps. The rotations of
/// joints with three angles are smoothed as quaternions: near the singular pose of three angles a
/// small rotation is large changes of two of them, which smoothed apart mean another pose.
Motion Smoothed(const Motion& motion, double cutoff_hz);

/// At another rate, by a spline; a lower rate is low-passed at 0.4 of it first.
Motion Resampled(const Motion& motion, double rate_hz);

/// A motion with its velocities and accelerations, one column a frame, entry for entry of q.
struct MotionRates {
  Eigen::MatrixXd q_dot;   ///< m/s, rad/s.
  Eigen::MatrixXd q_ddot;  ///< m/s^2, rad/s^2.
};
/// Rates of the spline through the poses, angles made continuous first. Smooth the motion before.
MotionRates Rates(const Motion& motion);

/// The mirror image at the plane y = 0: left and right limbs change places, lengths too. Joints are
/// paired by name. A joint with fewer than three rotations whose axes are not the mirror image of
/// its partner's is met as nearly as it can.
Motion Mirrored(const Motion& motion);

/// Forwards, backwards, forwards, ... until `seconds` are full. Around each turning point the clip
/// slows down and back up over `ease_s` before its end, so that velocities do not jump; with 0 it
/// turns at once.
Motion Looped(const Motion& motion, double seconds, double ease_s = 0.5);

/// Only the joints between the root and the landmarks (landmarks.h): no fingers, no face, no
/// helpers of the rig. A wrist keeps an end point "NAME_end" where its hand goes on. A CMU skeleton
/// becomes one of 56 degrees of freedom, those of StandardPerson.
Result<Motion> WithLandmarksOnly(const Motion& motion);

/// The same movement on a skeleton as programs for avatars want it: at rest (every angle 0) it
/// stands in a T-pose and looks along x, and its joints have the names of the human bones of Unity
/// and VRM ("Hips", "Spine", "LeftUpperLeg", ...). Joints that those do not know keep their names.
/// Every joint that is not an end turns about z, x and y. InvalidData as of FindLandmarks().
Result<Motion> Humanoid(const Motion& motion);
/// Names of the human bones of Unity, one a joint of a person's skeleton under whatever names;
/// empty for a joint that is none of them.
Result<std::vector<std::string>> HumanBones(const body::Skeleton& skeleton);

/// Turned about the vertical and moved over the floor, so that in the middle (median) of the motion
/// the person looks along x with the hips over the origin.
Motion FacingForward(const Motion& motion, const body::Landmarks& landmarks);

/// How high the lowest foot is over where it stands in the T-pose, by ankles and balls: tips of
/// toes point into the ground in much recorded motion. In a quarter of the frames some foot is
/// lower. The motion has frames.
double FloorHeight(const Motion& motion, const body::Landmarks& landmarks);

/// Natural cubic spline through samples at equal steps: continuous to the second derivative.
class Spline {
 public:
  Spline(Eigen::MatrixXd samples, double rate_hz);

  /// At a time from the first sample on, s; outside the samples the end value stays.
  Eigen::VectorXd Value(double t_s) const;
  Eigen::VectorXd FirstDerivative(double t_s) const;
  Eigen::VectorXd SecondDerivative(double t_s) const;

 private:
  struct Place {
    Eigen::Index before;
    double fraction;  ///< From `before` to the next, 0 to 1.
  };
  Place At(double t_s) const;

  Eigen::MatrixXd samples_;
  Eigen::MatrixXd curvatures_;  ///< Second derivatives at the samples.
  double rate_hz_;
};

}  // namespace footing::motion
