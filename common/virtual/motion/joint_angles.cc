#include "common/virtual/motion/joint_angles.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/rotation.h"
#include "common/base/text.h"
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

/// Takes the one of the two triples of a rotation whose second angle is within a quarter turn: no
/// thigh is spread further. In a deep squat with wide knees the nearest one to the frame before
/// may be the other one, and stays it when the person stands up again.
void WithinAQuarter(Eigen::VectorXd& angles_rad) {
  if (std::abs(angles_rad(1)) <= kPi / 2) return;
  angles_rad(1) = std::copysign(kPi, angles_rad(1)) - angles_rad(1);
  for (const Eigen::Index i : {0, 2}) angles_rad(i) -= std::copysign(kPi, angles_rad(i));
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
      if (near != nullptr) continue;
      if (all_[i].child < kUpperArm) WithinAQuarter(angles_rad_[i]);
      if (all_[i].parent != kGround) WithinATurn(angles_rad_[i]);
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

namespace {

constexpr double kStillS = 0.3;
constexpr double kUprightDeg = 40, kStillDeg = 4;

/// Columns of the coordinates of pelvis, trunk and legs in a table; -1 for those not written.
struct LegColumns {
  std::vector<Coordinates> joints;
  std::vector<std::array<int, 3>> columns;  ///< One for each joint.
  double to_rad = 1;

  static Result<LegColumns> Of(const motion::Table& table) {
    LegColumns found;
    found.to_rad = table.in_degrees ? kPi / 180 : 1;
    for (Coordinates& joint : AllCoordinates()) {
      if (joint.child >= kUpperArm) continue;
      std::array<int, 3> columns{-1, -1, -1};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (joint.names[axis].empty()) continue;
        columns[axis] = motion::FindColumn(table, joint.names[axis]);
        if (columns[axis] < 0) return InvalidData("no column " + joint.names[axis]);
      }
      found.joints.push_back(std::move(joint));
      found.columns.push_back(columns);
    }
    return found;
  }

  /// Orientations of the segments in the ground's frame.
  void Orient(const motion::Table& table, Eigen::Index row,
              std::array<Matrix3d, kUpperArm>& R_GA) const {
    const body::Joint opensim = OpenSimJoint();
    for (std::size_t i = 0; i < joints.size(); ++i) {
      Eigen::VectorXd angles = Eigen::VectorXd::Zero(3);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        if (columns[i][axis] < 0) continue;
        angles(at) = joints[i].signs(at) * to_rad * table.values(row, columns[i][axis]);
      }
      angles(0) *= -1;  // OpenSim's z is W's -y.
      const Matrix3d R = body::JointRotation(opensim, angles);
      const int parent = joints[i].parent;
      R_GA[static_cast<std::size_t>(joints[i].child)] =
          parent == kGround ? R : Matrix3d(R_GA[static_cast<std::size_t>(parent)] * R);
    }
  }
};

/// The rotation nearest to a sum of rotations.
Matrix3d MeanRotation(const Matrix3d& sum) {
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace

std::vector<Eigen::Index> FindStanding(const motion::Table& angles, Eigen::Index from) {
  std::vector<int> bends, others;
  for (const char* name : {"hip_flexion_l", "hip_flexion_r", "knee_angle_l", "knee_angle_r"}) {
    bends.push_back(motion::FindColumn(angles, name));
  }
  others = bends;
  for (const char* name : {"time", "pelvis_tilt", "lumbar_extension"}) {
    others.push_back(motion::FindColumn(angles, name));
  }
  const Eigen::Index rows = angles.values.rows();
  if (std::find(others.begin(), others.end(), -1) != others.end() || rows < 2) return {};
  const int time = others[bends.size()];
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(bends.size()));
  const double to_deg = angles.in_degrees ? 1 : 180 / kPi;
  const double step_s =
      (angles.values(rows - 1, time) - angles.values(0, time)) / static_cast<double>(rows - 1);
  const Eigen::Index least =
      std::max<Eigen::Index>(1, std::lround(kStillS / std::max(step_s, 1e-6)));
  const auto still = [&](Eigen::Index first) {  // For kStillS from there on.
    for (const int column : others) {
      const auto part = to_deg * angles.values.col(column).segment(first, least).array();
      if (part.maxCoeff() - part.minCoeff() > kStillDeg) return false;
      const bool bent = std::find(bends.begin(), bends.end(), column) != bends.end();
      if (bent && part.abs().maxCoeff() > kUprightDeg) return false;
    }
    return true;
  };
  std::vector<Eigen::Index> standing;
  for (Eigen::Index first = from; first + least <= rows; ++first) {
    if (!still(first)) continue;
    const Eigen::Index next = standing.empty() ? first : std::max(first, standing.back() + 1);
    for (Eigen::Index row = next; row < first + least; ++row) standing.push_back(row);
  }
  return standing;
}

Result<motion::Table> SinceStanding(const motion::Table& angles,
                                    const std::vector<Eigen::Index>& standing) {
  FOOTING_CHECK(!standing.empty());
  const auto from = LegColumns::Of(angles);
  if (!from) return from.error();
  std::array<Matrix3d, kUpperArm> R_GA, upright;
  upright.fill(Matrix3d::Zero());
  for (const Eigen::Index row : standing) {
    from->Orient(angles, row, R_GA);
    for (std::size_t part = 0; part < R_GA.size(); ++part) upright[part] += R_GA[part];
  }
  const Vector3d ahead = MeanRotation(upright[kPelvis]).col(0);
  const Matrix3d heading = body::AxisRotation(body::Axis::kZ, std::atan2(ahead.y(), ahead.x()));
  for (Matrix3d& R : upright) R = MeanRotation(R).transpose() * heading;
  motion::Table out;
  out.in_degrees = true;
  out.columns = {"time"};
  for (const Coordinates& joint : from->joints) {
    for (const std::string& name : joint.names) {
      if (!name.empty()) out.columns.push_back(name);
    }
  }
  out.values.setZero(angles.values.rows(), static_cast<Eigen::Index>(out.columns.size()));
  const body::Joint opensim = OpenSimJoint();
  std::vector<Eigen::VectorXd> angles_rad(from->joints.size(), Eigen::VectorXd::Zero(3));
  for (Eigen::Index row = 0; row < angles.values.rows(); ++row) {
    from->Orient(angles, row, R_GA);
    for (std::size_t part = 0; part < R_GA.size(); ++part) R_GA[part] *= upright[part];
    Eigen::Index column = 0;
    out.values(row, column++) = angles.values(row, 0);
    for (std::size_t i = 0; i < from->joints.size(); ++i) {
      const Coordinates& joint = from->joints[i];
      const Matrix3d& parent =
          joint.parent == kGround ? heading : R_GA[static_cast<std::size_t>(joint.parent)];
      body::SetJointRotation(
          opensim, parent.transpose() * R_GA[static_cast<std::size_t>(joint.child)], angles_rad[i]);
      WithinAQuarter(angles_rad[i]);
      const Vector3d opensim_rad(-angles_rad[i](0), angles_rad[i](1), angles_rad[i](2));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (joint.names[axis].empty()) continue;
        const auto at = static_cast<Eigen::Index>(axis);
        out.values(row, column++) = Rounded(RadiansToDegrees(joint.signs(at) * opensim_rad(at)));
      }
    }
  }
  return out;
}

bool IsKnown(const motion::Table& angles, const std::string& column, Eigen::Index row) {
  if (column.rfind("hip_rotation", 0) != 0) return true;
  const int knee = motion::FindColumn(angles, "knee_angle" + column.substr(column.size() - 2));
  const double to_deg = angles.in_degrees ? 1 : 180 / kPi;
  return knee >= 0 && to_deg * angles.values(row, knee) >= kStraightKneeDeg;
}

namespace {

/// W's axes in OpenSim's: x ahead, y up, z right.
const Matrix3d& OpenSimOfW() {
  static const Matrix3d axes = (Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
  return axes;
}

std::string Numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ' ';
    text += text::Fixed(std::abs(value) < 5e-9 ? 0 : value, 8);
  }
  return text;
}

std::string Numbers(const Vector3d& v) { return Numbers({v.x(), v.y(), v.z()}); }

std::string Tag(const std::string& name, const std::string& text) {
  return "<" + name + ">" + text + "</" + name + ">\n";
}

/// A set of a model, with what is in it.
std::string Set(const std::string& type, const std::string& name, const std::string& objects) {
  return "<" + type + " name=\"" + name + "\">\n<objects>\n" + objects +
         "</objects>\n<groups />\n</" + type + ">\n";
}

/// A body of the model, and the joint that carries it.
struct ModelBody {
  std::string name, joint;
  Vector3d origin = Vector3d::Zero();  ///< At rest, from the root, in W's axes.
  double mass_kg = 0;
  Vector3d first_moment = Vector3d::Zero();  ///< kg m, in the body's axes.
  Matrix3d inertia = Matrix3d::Zero();       ///< About its origin, kg m^2.
};

/// The person of a motion at rest, cut into the parts of the model.
class ModelWriter {
 public:
  ModelWriter(const motion::Motion& motion, const body::Body& body)
      : skeleton_(motion.skeleton), segments_(SegmentsOf(skeleton_, body.landmarks)) {
    for (const int side : {0, 1}) AlignElbow(motion, side, segments_);
    const auto joints = static_cast<std::size_t>(skeleton_.size());
    rest_.assign(joints, Vector3d::Zero());
    for (std::size_t i = 1; i < joints; ++i) {
      const body::Joint& joint = skeleton_.joints[i];
      rest_[i] = rest_[static_cast<std::size_t>(joint.parent)] + joint.offset_m;
    }
    FindParts(body.landmarks);
    NameBodies(body.landmarks);
    for (std::size_t i = 0; i < joints; ++i) AddMass(i, body.masses[i]);
  }

  std::string Write(const std::string& name) const {
    std::string bodies, joints, markers;
    for (const ModelBody& one : bodies_) {
      const Vector3d centre =
          one.mass_kg > 0 ? Vector3d(one.first_moment / one.mass_kg) : Vector3d(Vector3d::Zero());
      const Matrix3d about =
          one.inertia -
          one.mass_kg * (centre.squaredNorm() * Matrix3d::Identity() - centre * centre.transpose());
      bodies += "<Body name=\"" + one.name + "\">\n" + Tag("mass", Numbers({one.mass_kg})) +
                Tag("mass_center", Numbers(centre)) +
                Tag("inertia", Numbers({about(0, 0), about(1, 1), about(2, 2), about(0, 1),
                                        about(0, 2), about(1, 2)})) +
                "</Body>\n";
    }
    for (const Coordinates& joint : AllCoordinates()) joints += JointOf(joint);
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const auto part = static_cast<std::size_t>(parts_[i]);
      markers += "<Marker name=\"" + skeleton_.joints[i].name + "\">\n" +
                 Tag("socket_parent_frame", "/bodyset/" + bodies_[part].name) +
                 Tag("location", Numbers(InBody(part, rest_[i]))) + Tag("fixed", "false") +
                 "</Marker>\n";
    }
    return "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<OpenSimDocument Version=\"40000\">\n"
           "<Model name=\"" +
           name + "\">\n" + Tag("credits", "Footing; segment masses: de Leva 1996") +
           Tag("length_units", "meters") + Tag("force_units", "N") +
           Tag("gravity", Numbers({0, -kStandardGravityMps2, 0})) +
           Set("BodySet", "bodyset", bodies) + Set("JointSet", "jointset", joints) +
           Set("MarkerSet", "markerset", markers) + Set("ForceSet", "forceset", "") +
           "</Model>\n</OpenSimDocument>\n";
  }

 private:
  /// Each joint belongs to the part whose joint it hangs on; the back, to the torso.
  void FindParts(const body::Landmarks& landmarks) {
    parts_.assign(rest_.size(), kPelvis);
    std::vector<bool> back(rest_.size(), false);
    lumbar_ = landmarks[Landmark::kNeck];
    for (int joint = lumbar_; joint > landmarks[Landmark::kHips];
         joint = skeleton_.joint(joint).parent) {
      back[static_cast<std::size_t>(joint)] = true;
      lumbar_ = joint;
    }
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      parts_[i] = back[i] ? static_cast<int>(kTorso)
                          : parts_[static_cast<std::size_t>(skeleton_.joints[i].parent)];
      for (int part = kThigh; part < kParts; ++part) {
        if (segments_[static_cast<std::size_t>(part)].joint == static_cast<int>(i))
          parts_[i] = part;
      }
    }
  }

  void NameBodies(const body::Landmarks& landmarks) {
    const auto at = [&](int joint) { return rest_[static_cast<std::size_t>(joint)]; };
    const auto set = [&](int part, const std::string& name, const std::string& joint,
                         const Vector3d& origin) {
      ModelBody& body = bodies_[static_cast<std::size_t>(part)];
      body.name = name;
      body.joint = joint;
      body.origin = origin;
    };
    set(kPelvis, "pelvis", "ground_pelvis",
        (at(landmarks[Landmark::kLeftHip]) + at(landmarks[Landmark::kRightHip])) / 2);
    set(kTorso, "torso", "back", at(lumbar_));
    for (const int side : {0, 1}) {
      const std::string of = side == 0 ? "_l" : "_r";
      constexpr std::tuple<Part, const char*, const char*> kLimbs[] = {
          {kThigh, "femur", "hip"},
          {kShank, "tibia", "knee"},
          {kFoot, "calcn", "ankle"},
          {kUpperArm, "humerus", "acromial"},
          {kForearm, "radius", "elbow"}};
      for (const auto& [part, name, joint] : kLimbs) {
        const int own = part + side;
        set(own, name + of, joint + of, at(segments_[static_cast<std::size_t>(own)].joint));
      }
    }
  }

  /// A direction at rest in a body's axes.
  Matrix3d IntoBody(std::size_t part) const {
    return OpenSimOfW() * segments_[part].R_JA.transpose();
  }
  Vector3d InBody(std::size_t part, const Vector3d& at_rest) const {
    return IntoBody(part) * (at_rest - bodies_[part].origin);
  }

  void AddMass(std::size_t joint, const body::JointMass& mass) {
    const auto part = static_cast<std::size_t>(parts_[joint]);
    ModelBody& body = bodies_[part];
    const Vector3d centre = InBody(part, rest_[joint] + mass.com_J);
    body.mass_kg += mass.mass_kg;
    body.first_moment += mass.mass_kg * centre;
    body.inertia +=
        IntoBody(part) * mass.inertia_J * IntoBody(part).transpose() +
        mass.mass_kg * (centre.squaredNorm() * Matrix3d::Identity() - centre * centre.transpose());
  }

  std::string JointOf(const Coordinates& of) const {
    const auto child = static_cast<std::size_t>(of.child);
    const bool is_root = of.parent == kGround;
    const std::string parent =
        is_root ? "ground" : bodies_[static_cast<std::size_t>(of.parent)].name;
    const Vector3d place = is_root
                               ? Vector3d(Vector3d::Zero())
                               : InBody(static_cast<std::size_t>(of.parent), bodies_[child].origin);
    std::string coordinates, axes;
    const auto add = [&](const std::string& kind, int number, const std::string& name,
                         const Vector3d& axis) {
      axes += "<TransformAxis name=\"" + kind + std::to_string(number) + "\">\n" +
              Tag("coordinates", name) + Tag("axis", Numbers(axis)) +
              (name.empty() ? "<Constant name=\"function\">\n" + Tag("value", "0") + "</Constant>\n"
                            : "<LinearFunction name=\"function\">\n" + Tag("coefficients", "1 0") +
                                  "</LinearFunction>\n") +
              "</TransformAxis>\n";
      if (name.empty()) return;
      coordinates += "<Coordinate name=\"" + name + "\">\n" + Tag("default_value", "0") +
                     Tag("default_speed_value", "0") +
                     Tag("range", kind == "rotation" ? "-6.28318531 6.28318531" : "-100 100") +
                     Tag("clamped", "false") + Tag("locked", "false") + Tag("prescribed", "false") +
                     "</Coordinate>\n";
    };
    const Vector3d about[3] = {Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
    for (int i = 0; i < 3; ++i) {
      add("rotation", i + 1, of.names[static_cast<std::size_t>(i)], of.signs(i) * about[i]);
    }
    constexpr const char* kPlaces[] = {"pelvis_tx", "pelvis_ty", "pelvis_tz"};
    for (int i = 0; i < 3; ++i) {
      add("translation", i + 1, is_root ? kPlaces[i] : "", Vector3d::Unit(i));
    }
    const auto frame = [](const std::string& name, const std::string& on, const Vector3d& at) {
      return "<PhysicalOffsetFrame name=\"" + name + "\">\n" + Tag("socket_parent", on) +
             Tag("translation", Numbers(at)) + Tag("orientation", "0 0 0") +
             "</PhysicalOffsetFrame>\n";
    };
    const ModelBody& body = bodies_[child];
    return "<CustomJoint name=\"" + body.joint + "\">\n" +
           Tag("socket_parent_frame", parent + "_offset") +
           Tag("socket_child_frame", body.name + "_offset") + "<coordinates>\n" + coordinates +
           "</coordinates>\n<frames>\n" +
           frame(parent + "_offset", is_root ? "/ground" : "/bodyset/" + parent, place) +
           frame(body.name + "_offset", "/bodyset/" + body.name, Vector3d::Zero()) +
           "</frames>\n<SpatialTransform>\n" + axes + "</SpatialTransform>\n</CustomJoint>\n";
  }

  const body::Skeleton& skeleton_;
  Segments segments_;
  std::vector<Vector3d> rest_;  ///< Places of the joints from the root.
  std::vector<int> parts_;      ///< Part of each joint.
  int lumbar_ = 0;              ///< The lowest joint of the back.
  std::array<ModelBody, kParts> bodies_;
};

}  // namespace

Result<std::string> OpenSimModel(const motion::Motion& motion, const body::PersonParameters& person,
                                 const std::string& name) {
  const auto body = body::MakeBody(motion.skeleton, person);
  if (!body) return body.error();
  return ModelWriter(motion, *body).Write(name);
}

}  // namespace footing::joint_angles
