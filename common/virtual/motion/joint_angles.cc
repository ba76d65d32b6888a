#include "common/virtual/motion/joint_angles.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "common/base/rotation.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/landmarks.h"

namespace footing::joint_angles {
namespace {

using body::Landmark;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// An elbow that never bends further than this does not show its axis.
constexpr double kBentRad = 0.35;

/// A part of the body. A is its anatomical frame: the axes of W in the upright body, arms hanging.
struct Segment {
  int joint = 0;
  Matrix3d R_JA = Matrix3d::Identity();
};

enum Part { kPelvis, kTorso, kThigh, kShank = 4, kFoot = 6, kUpperArm = 8, kForearm = 10 };
constexpr int kParts = 12;
constexpr int kGround = -1;

using Segments = std::array<Segment, kParts>;

/// From one joint to another one below it, at rest, where the axes of all joints are those of W.
Vector3d RestVector(const body::Skeleton& skeleton, int from, int to) {
  Vector3d sum = Vector3d::Zero();
  for (int joint = to; joint > from; joint = skeleton.joint(joint).parent) {
    sum += skeleton.joint(joint).offset_m;
  }
  return sum;
}

/// A segment that hangs down in the upright body, whatever way it points at rest.
Segment Hanging(const body::Skeleton& skeleton, int joint, int end) {
  const Vector3d down = -Vector3d::UnitZ();
  return {joint, LeastTurn(down, RestVector(skeleton, joint, end)).toRotationMatrix()};
}

Segments SegmentsOf(const body::Skeleton& skeleton, const body::Landmarks& of) {
  Segments segments;
  segments[kPelvis].joint = of[Landmark::kHips];
  segments[kTorso].joint =
      of[Landmark::kChest] >= 0 ? of[Landmark::kChest] : skeleton.joint(of[Landmark::kNeck]).parent;
  for (const int side : {0, 1}) {
    const auto at = [&](Landmark left) { return of[body::OfSide(left, side)]; };
    const auto set = [&](Part part, Landmark from, Landmark to) {
      segments[static_cast<std::size_t>(part + side)] = Hanging(skeleton, at(from), at(to));
    };
    set(kThigh, Landmark::kLeftHip, Landmark::kLeftKnee);
    set(kShank, Landmark::kLeftKnee, Landmark::kLeftAnkle);
    set(kUpperArm, Landmark::kLeftShoulder, Landmark::kLeftElbow);
    set(kForearm, Landmark::kLeftElbow, Landmark::kLeftWrist);
    // A foot stands flat below an upright shank.
    segments[static_cast<std::size_t>(kFoot + side)] = {
        at(Landmark::kLeftAnkle), segments[static_cast<std::size_t>(kShank + side)].R_JA};
  }
  return segments;
}

Matrix3d Between(const body::Kinematics& at, const Segments& segments, int parent, int child) {
  const auto R_WA = [&](int part) -> Matrix3d {
    const Segment& segment = segments[static_cast<std::size_t>(part)];
    return at.R_WJ[static_cast<std::size_t>(segment.joint)] * segment.R_JA;
  };
  if (parent == kGround) return R_WA(child);
  return R_WA(parent).transpose() * R_WA(child);
}

/// Turns both frames of an arm about its length until the elbow bends about OpenSim's z, which is
/// W's -y.
void AlignElbow(const motion::Motion& motion, int side, Segments& segments) {
  body::Kinematics at(motion.skeleton);
  Eigen::AngleAxisd most(0, -Vector3d::UnitY());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    const Eigen::AngleAxisd bend(Between(at, segments, kUpperArm + side, kForearm + side));
    if (bend.angle() > most.angle()) most = bend;
  }
  if (most.angle() < kBentRad) return;
  const double turn_rad = std::atan2(most.axis().x(), -most.axis().y());
  const Matrix3d turn = body::AxisRotation(body::Axis::kZ, turn_rad);
  for (const Part part : {kUpperArm, kForearm}) {
    Matrix3d& R_JA = segments[static_cast<std::size_t>(part + side)].R_JA;
    R_JA = R_JA * turn;
  }
}

/// Signs of the angles of a limb: the left one is the mirror image of the right one.
Vector3d SignsOf(int side) { return side == 1 ? Vector3d(1, 1, 1) : Vector3d(1, -1, -1); }

/// The coordinates of one joint: angles about z, x and y of OpenSim.
struct Coordinates {
  int parent;
  int child;
  std::array<std::string, 3> names;  ///< Empty: not written.
  Vector3d signs{1, 1, 1};
};

/// In the order of the columns; the root's position stands behind the pelvis.
std::vector<Coordinates> AllCoordinates() {
  std::vector<Coordinates> all{
      {kGround, kPelvis, {"pelvis_tilt", "pelvis_list", "pelvis_rotation"}}};
  for (const int side : {1, 0}) {
    const std::string of = side == 1 ? "_r" : "_l";
    all.push_back({kPelvis,
                   kThigh + side,
                   {"hip_flexion" + of, "hip_adduction" + of, "hip_rotation" + of},
                   SignsOf(side)});
    all.push_back({kThigh + side, kShank + side, {"knee_angle" + of}, Vector3d(-1, 1, 1)});
    all.push_back({kShank + side, kFoot + side, {"ankle_angle" + of}});
  }
  all.push_back({kPelvis, kTorso, {"lumbar_extension", "lumbar_bending", "lumbar_rotation"}});
  for (const int side : {1, 0}) {
    const std::string of = side == 1 ? "_r" : "_l";
    all.push_back({kTorso,
                   kUpperArm + side,
                   {"arm_flex" + of, "arm_add" + of, "arm_rot" + of},
                   SignsOf(side)});
    all.push_back({kUpperArm + side, kForearm + side, {"elbow_flex" + of}});
  }
  return all;
}

std::vector<std::string> ColumnsOf(const std::vector<Coordinates>& all) {
  std::vector<std::string> columns{"time"};
  for (const Coordinates& joint : all) {
    for (const std::string& name : joint.names) {
      if (!name.empty()) columns.push_back(name);
    }
    if (joint.parent != kGround) continue;
    for (const char* name : {"pelvis_tx", "pelvis_ty", "pelvis_tz"}) columns.emplace_back(name);
  }
  return columns;
}

/// No joint of a body turns further than this; what does has gone round through the singularity of
/// the arms in the T-pose.
constexpr double kFurthestRad = 1.5 * kPi;

void WithinATurn(Eigen::VectorXd& angles_rad) {
  for (const Eigen::Index i : {0, 2}) {
    if (std::abs(angles_rad(i)) > kFurthestRad) {
      angles_rad(i) -= std::copysign(2 * kPi, angles_rad(i));
    }
  }
}

/// A millionth of a degree or metre.
double Rounded(double value) { return std::round(value * 1e6) / 1e6; }

/// A joint that turns about z, then x, then y of OpenSim: -y, x, z of W.
body::Joint OpenSimJoint() {
  body::Joint joint;
  joint.rotations = {{body::Axis::kY}, {body::Axis::kX}, {body::Axis::kZ}};
  return joint;
}

/// The angles of all joints of one motion, frame after frame.
class AngleReader {
 public:
  AngleReader(const motion::Motion& motion, const body::Landmarks& landmarks)
      : motion_(motion),
        segments_(SegmentsOf(motion.skeleton, landmarks)),
        all_(AllCoordinates()),
        at_(motion.skeleton),
        angles_rad_(all_.size(), Eigen::VectorXd::Zero(3)) {
    for (const int side : {0, 1}) AlignElbow(motion, side, segments_);
  }

  /// Takes, of equivalent angles, those nearest to `near`, or without it those nearest to the frame
  /// that was read before.
  void Read(Eigen::Index frame, const AngleReader* near) {
    body::ComputeKinematics(motion_.skeleton, motion_.q.col(frame), at_);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (near != nullptr) angles_rad_[i] = near->angles_rad_[i];
      body::SetJointRotation(joint_, Between(at_, segments_, all_[i].parent, all_[i].child),
                             angles_rad_[i]);
      if (near == nullptr && all_[i].parent != kGround) WithinATurn(angles_rad_[i]);
    }
  }

  const std::vector<Coordinates>& all() const { return all_; }
  const body::Kinematics& at() const { return at_; }
  /// About z, x and y of OpenSim.
  Vector3d OpenSimRad(std::size_t joint) const {
    const Eigen::VectorXd& angles = angles_rad_[joint];
    return {-angles(0), angles(1), angles(2)};
  }

 private:
  const motion::Motion& motion_;
  Segments segments_;
  std::vector<Coordinates> all_;
  body::Kinematics at_;
  std::vector<Eigen::VectorXd> angles_rad_;  ///< As SetJointRotation wants them.
  const body::Joint joint_ = OpenSimJoint();
};

}  // namespace

Result<motion::Table> JointAngles(const motion::Motion& motion, const motion::Motion* near) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return landmarks.error();
  AngleReader reader(motion, *landmarks);
  std::optional<AngleReader> near_reader;
  if (near != nullptr) {
    const auto near_landmarks = body::FindLandmarks(near->skeleton);
    if (!near_landmarks) return near_landmarks.error();
    FOOTING_CHECK(near->frames() == motion.frames());
    near_reader.emplace(*near, *near_landmarks);
  }
  motion::Table table;
  table.in_degrees = true;
  table.columns = ColumnsOf(reader.all());
  table.values.setZero(motion.frames(), static_cast<Eigen::Index>(table.columns.size()));
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    if (near_reader) near_reader->Read(frame, nullptr);
    reader.Read(frame, near_reader ? &*near_reader : nullptr);
    Eigen::Index column = 0;
    const auto put = [&](double value) { table.values(frame, column++) = Rounded(value); };
    put(static_cast<double>(frame) / motion.rate_hz);
    for (std::size_t i = 0; i < reader.all().size(); ++i) {
      const Coordinates& joint = reader.all()[i];
      const Vector3d opensim_rad = reader.OpenSimRad(i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        if (!joint.names[axis].empty()) put(RadiansToDegrees(joint.signs(row) * opensim_rad(row)));
      }
      if (joint.parent != kGround) continue;
      const auto hip = [&](Landmark landmark) {
        return reader.at().p_WJ[static_cast<std::size_t>((*landmarks)[landmark])];
      };
      const Vector3d p_W = 0.5 * (hip(Landmark::kLeftHip) + hip(Landmark::kRightHip));
      put(p_W.x());
      put(p_W.z());
      put(-p_W.y());
    }
  }
  return table;
}

}  // namespace footing::joint_angles
