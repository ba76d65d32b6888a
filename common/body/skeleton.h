#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

/// The human body as a tree of joints with masses: kinematics, centre of mass and momentum.
///
/// Frames: W is the world (x forward, y left, z up, metres). J is the frame of a joint; at rest
/// (every angle zero) the axes of all J are those of W, whatever the posture that this gives.
namespace footing::body {

/// An axis of a frame, as an index into a vector.
enum class Axis { kX = 0, kY = 1, kZ = 2 };

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// One rotation of a joint. Its coordinate is an angle in rad.
struct Rotation {
  Axis axis = Axis::kX;
  double lower_rad = -kUnlimited;
  double upper_rad = kUnlimited;
};

/// A joint: where it sits on its parent and how it turns. A joint that nothing hangs on and that
/// does not turn is an end point (finger tip, toe tip, vertex).
///   R_PJ = C R(axis_0, q_0) R(axis_1, q_1) R(axis_2, q_2) C^T,   C = `axes`
/// so the rotations stand in the order of the product, which is the channel order of BVH and the
/// reverse of the order in an ASF file.
struct Joint {
  std::string name;
  int parent = -1;                                     ///< Index of an earlier joint; -1: the root.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< p_PJ, origin of the joint in its parent.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< C: the rotation axes, in J at rest.
  bool plain_axes = true;                              ///< C is the identity.
  std::vector<Rotation> rotations;                     ///< At most three.
  int first_dof = 0;                                   ///< Where its angles stand in a pose.
};

/// Joints in an order in which parents come first; joint 0 is the root. A pose is a vector of
/// generalised coordinates q: the position of the root in W (m), then the angles of the joints in
/// their order (rad).
struct Skeleton {
  std::vector<Joint> joints;
  int dof = 0;

  int size() const { return static_cast<int>(joints.size()); }
  const Joint& joint(int index) const { return joints[static_cast<std::size_t>(index)]; }
};

/// A pose, or any vector of one number a degree of freedom.
using PoseRef = Eigen::Ref<const Eigen::VectorXd>;

/// Sets `first_dof`, `plain_axes` and `dof`. To be called once the joints are complete; a parent
/// that does not come before its child, or more than three rotations, is a bug.
Skeleton MakeSkeleton(std::vector<Joint> joints);

/// Index of the joint of that name, or -1.
int FindJoint(const Skeleton& skeleton, std::string_view name);

/// Whether the joint is an end point.
bool IsEnd(const Skeleton& skeleton, int joint);

/// "root.x_m", "lfemur.x_rad", ...: a name for each degree of freedom.
std::vector<std::string> DofNames(const Skeleton& skeleton);

/// Lower and upper limits of q; infinite where there is none, and for the root's position.
Eigen::VectorXd LowerLimits(const Skeleton& skeleton);
Eigen::VectorXd UpperLimits(const Skeleton& skeleton);

/// Rotation by `angle_rad` about an axis of the frame.
Eigen::Matrix3d AxisRotation(Axis axis, double angle_rad);

/// R_PJ of a joint in pose q.
Eigen::Matrix3d JointRotation(const Joint& joint, PoseRef q);

/// The inverse: the angles whose R_PJ is nearest to `R_PJ`, written into `q`. With three different
/// axes the rotation is met exactly, and of the two triples that do the one nearest to what stands
/// in `q` is taken, whole turns included, so that a sequence stays continuous. With fewer axes the
/// remaining angle is the best one about each axis in turn.
void SetJointRotation(const Joint& joint, const Eigen::Matrix3d& R_PJ,
                      Eigen::Ref<Eigen::VectorXd> q);

/// Motion files of animation have y up, z ahead and x to the left; W has x ahead, y left, z up. The
/// one turns into the other by a cyclic change of names, so rotations keep their angles.
inline Eigen::Vector3d FromYUp(const Eigen::Vector3d& file) { return {file(2), file(0), file(1)}; }
inline Eigen::Vector3d ToYUp(const Eigen::Vector3d& world) {
  return {world(1), world(2), world(0)};
}
inline Axis FromYUp(Axis file) { return static_cast<Axis>((static_cast<int>(file) + 1) % 3); }
inline Axis ToYUp(Axis world) { return static_cast<Axis>((static_cast<int>(world) + 2) % 3); }

/// Rz Ry Rx of three angles about the file's axes (ASF "axis a b c XYZ"), in W.
inline Eigen::Matrix3d FromYUpXyz(const Eigen::Vector3d& angles_rad) {
  return AxisRotation(FromYUp(Axis::kZ), angles_rad(2)) *
         AxisRotation(FromYUp(Axis::kY), angles_rad(1)) *
         AxisRotation(FromYUp(Axis::kX), angles_rad(0));
}

/// A vector in a Wiimote's own frame (x left, y front, z down) in the held frame of a fist, and
/// back: x where the device points, y left, z up while its buttons face up. With the arms of a
/// T-pose the axes of the held frame are W's.
inline Eigen::Vector3d AsHeld(const Eigen::Vector3d& v) { return {v.y(), v.x(), -v.z()}; }

}  // namespace footing::body
