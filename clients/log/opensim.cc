#include "clients/log/opensim.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/rotation/rotation.h"
#include "common/units/units.h"

namespace footing::log_client {
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

/// Of the angles of a limb: the left one is the mirror image of the right one.
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

}  // namespace

Result<motion::Table> JointAngles(const motion::Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return landmarks.error();
  Segments segments = SegmentsOf(motion.skeleton, *landmarks);
  for (const int side : {0, 1}) AlignElbow(motion, side, segments);
  const std::vector<Coordinates> all = AllCoordinates();
  motion::Table table;
  table.in_degrees = true;
  table.columns = ColumnsOf(all);
  table.values.setZero(motion.frames(), static_cast<Eigen::Index>(table.columns.size()));
  const body::Joint joint = OpenSimJoint();
  // What stands there from the frame before keeps angles on the same turn.
  std::vector<Eigen::VectorXd> angles(all.size(), Eigen::VectorXd::Zero(3));
  body::Kinematics at(motion.skeleton);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    Eigen::Index column = 0;
    const auto put = [&](double value) { table.values(frame, column++) = Rounded(value); };
    put(static_cast<double>(frame) / motion.rate_hz);
    for (std::size_t i = 0; i < all.size(); ++i) {
      body::SetJointRotation(joint, Between(at, segments, all[i].parent, all[i].child), angles[i]);
      if (all[i].parent != kGround) WithinATurn(angles[i]);
      const Vector3d opensim(-angles[i](0), angles[i](1), angles[i](2));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        if (!all[i].names[axis].empty()) {
          put(RadiansToDegrees(all[i].signs(row) * opensim(row)));
        }
      }
      if (all[i].parent != kGround) continue;
      const Vector3d p_W =
          0.5 * (at.p_WJ[static_cast<std::size_t>((*landmarks)[body::Landmark::kLeftHip])] +
                 at.p_WJ[static_cast<std::size_t>((*landmarks)[body::Landmark::kRightHip])]);
      put(p_W.x());
      put(p_W.z());
      put(-p_W.y());
    }
  }
  return table;
}

motion::Table ForceTable(const std::vector<FootForces>& forces, double rate_hz) {
  motion::Table table;
  table.columns = {"time"};
  for (const char* side : {"r", "l"}) {
    const std::string force = std::string("ground_force_") + side + "_";
    for (const char* part : {"vx", "vy", "vz", "px", "py", "pz"}) {
      table.columns.push_back(force + part);
    }
    for (const char* part : {"x", "y", "z"}) {
      table.columns.push_back(std::string("ground_torque_") + side + "_" + part);
    }
  }
  table.values.setZero(static_cast<Eigen::Index>(forces.size()),
                       static_cast<Eigen::Index>(table.columns.size()));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    auto row = table.values.row(static_cast<Eigen::Index>(i));
    row(0) = Rounded(static_cast<double>(i) / rate_hz);
    for (const int side : {1, 0}) {
      const FootForce& foot = forces[i][static_cast<std::size_t>(side)];
      const Eigen::Index first = side == 1 ? 1 : 10;
      row(first + 1) = foot.load_n;
      row(first + 3) = foot.cop_W.x();
      row(first + 4) = foot.cop_W.z();
      row(first + 5) = -foot.cop_W.y();
    }
  }
  return table;
}

}  // namespace footing::log_client
