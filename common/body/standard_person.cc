#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/y_up.h"
#include "common/base/rotation.h"
#include "common/base/units.h"

namespace footing::body {
namespace {

/// One rotation about an axis of the joint (as in the file frame, y up), with its limits.
struct Turn {
  Axis axis;
  double lower_deg, upper_deg;
};

/// One bone as the CMU skeletons have it: it turns at its near end, about axes that are themselves
/// turned by Rz Ry Rx (`axes_deg`) from those of the file.
struct Bone {
  std::string name, parent;
  Eigen::Vector3d along;  ///< From its near to its far end, over the standing height; y up.
  Eigen::Vector3d axes_deg;
  std::vector<Turn> turns;  ///< In the order of the file: x, y, z.
};

constexpr Axis kX = Axis::kX, kY = Axis::kY, kZ = Axis::kZ;

// Places of joints over the standing height where the table of segments has none: read off the
// proportions of the CMU skeletons, which agree with each other to some 0.005.
constexpr double kRootOverHips = 0.058, kRootBehindHips = 0.020, kHalfHips = 0.047;
constexpr double kBackBone = 0.0665, kNeckBone = 0.057;
constexpr double kHalfShoulders = 0.105;
constexpr double kAnkleHeight = 0.040, kBallHeight = 0.015, kAnkleToBall = 0.075, kToes = 0.038;
constexpr double kSplayDeg = 20;  ///< Of the legs at rest.

std::vector<Bone> Bones(Sex sex) {
  const auto length = [sex](Segment segment) { return Parameters(segment, sex).length_of_stature; };
  const double head = 1 - (kAnkleHeight + length(Segment::kShank) + length(Segment::kThigh) +
                           kRootOverHips + 3 * kBackBone + 2 * kNeckBone);
  const double clavicle_up = TrunkOfStature(sex) - kRootOverHips - 3 * kBackBone;
  const std::vector<Turn> back = {{kX, -20, 45}, {kY, -30, 30}, {kZ, -30, 30}};
  std::vector<Bone> bones;
  const auto mirrored = [](std::vector<Turn> turns, double side) {
    for (Turn& turn : turns) {  // A mirror at the sagittal plane keeps the angles about x.
      if (side < 0 && turn.axis != kX) turn = {turn.axis, -turn.upper_deg, -turn.lower_deg};
    }
    return turns;
  };
  for (const double side : {1.0, -1.0}) {
    const std::string l = side > 0 ? "l" : "r";
    const double splay = DegreesToRadians(kSplayDeg);
    const Eigen::Vector3d down(side * std::sin(splay), -std::cos(splay), 0);
    const Eigen::Vector3d leg(0, 0, side * kSplayDeg), foot(-90, 0, side * kSplayDeg);
    bones.push_back({l + "hipjoint",
                     "root",
                     {side * kHalfHips, -kRootOverHips, kRootBehindHips},
                     {0, 0, 0},
                     {}});
    bones.push_back({l + "femur", l + "hipjoint", length(Segment::kThigh) * down, leg,
                     mirrored({{kX, -160, 20}, {kY, -70, 70}, {kZ, -60, 70}}, side)});
    bones.push_back(
        {l + "tibia", l + "femur", length(Segment::kShank) * down, leg, {{kX, -10, 170}}});
    bones.push_back({l + "foot", l + "tibia",
                     Eigen::Vector3d(0, 0, kAnkleToBall) + (kAnkleHeight - kBallHeight) * down,
                     foot, mirrored({{kX, -45, 90}, {kZ, -70, 20}}, side)});
    bones.push_back({l + "toes", l + "foot", {0, 0, kToes}, foot, {{kX, -90, 20}}});
  }
  bones.push_back({"lowerback", "root", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"upperback", "lowerback", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"thorax", "upperback", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"lowerneck", "thorax", {0, kNeckBone, 0}, {0, 0, 0}, back});
  bones.push_back({"upperneck", "lowerneck", {0, kNeckBone, 0}, {0, 0, 0}, back});
  bones.push_back({"head", "upperneck", {0, head, 0}, {0, 0, 0}, back});
  for (const double side : {1.0, -1.0}) {
    const std::string l = side > 0 ? "l" : "r";
    const Eigen::Vector3d out(side, 0, 0);
    const Eigen::Vector3d arm(180, -30 * side, -90 * side), hand(0, 90 * side, 90 * side);
    bones.push_back({l + "clavicle",
                     "thorax",
                     {side * kHalfShoulders, clavicle_up, 0},
                     {0, 0, 0},
                     mirrored({{kY, -20, 10}, {kZ, 0, 20}}, side)});
    // The mirror of these axes turns the sense of x.
    const Turn lift = side > 0 ? Turn{kX, -60, 90} : Turn{kX, -90, 60};
    bones.push_back({l + "humerus",
                     l + "clavicle",
                     length(Segment::kUpperArm) * out,
                     arm,
                     {lift, {kY, -90, 90}, {kZ, -90, 90}}});
    bones.push_back({l + "radius",
                     l + "humerus",
                     length(Segment::kForearm) * 2 / 3 * out,
                     arm,
                     {{kX, -10, 170}}});
    bones.push_back(
        {l + "wrist", l + "radius", length(Segment::kForearm) / 3 * out, hand, {{kY, -180, 0}}});
    bones.push_back({l + "hand",
                     l + "wrist",
                     length(Segment::kHand) * out,
                     hand,
                     {{kX, -90, 90}, {kZ, -45, 45}}});
  }
  return bones;
}

}  // namespace

Skeleton StandardPerson(double height_m, Sex sex) {
  const std::vector<Bone> bones = Bones(sex);
  std::vector<Joint> joints(1);
  joints[0].name = "root";
  // Heading first: locked only when the pelvis lies on its side.
  joints[0].rotations = {{Axis::kZ, -kUnlimited, kUnlimited},
                         {Axis::kX, -kUnlimited, kUnlimited},
                         {Axis::kY, -kUnlimited, kUnlimited}};
  const auto index = [&joints](const std::string& name) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].name == name) return static_cast<int>(i);
    }
    return -1;
  };
  const auto far_end = [&](const std::string& name) -> Eigen::Vector3d {
    for (const Bone& bone : bones) {
      if (bone.name == name) return height_m * FromYUp(bone.along);
    }
    return Eigen::Vector3d::Zero();  // The root is a point.
  };
  for (const Bone& bone : bones) {
    Joint joint;
    joint.name = bone.name;
    joint.parent = index(bone.parent);
    joint.offset_m = far_end(bone.parent);
    if (!bone.axes_deg.isZero()) joint.axes = FromYUpXyz(bone.axes_deg * (kPi / 180));
    for (auto turn = bone.turns.rbegin(); turn != bone.turns.rend(); ++turn) {
      joint.rotations.push_back({FromYUp(turn->axis), DegreesToRadians(turn->lower_deg),
                                 DegreesToRadians(turn->upper_deg)});
    }
    joints.push_back(std::move(joint));
    const bool last = std::none_of(bones.begin(), bones.end(),
                                   [&](const Bone& other) { return other.parent == bone.name; });
    if (!last) continue;
    Joint end;
    end.name = bone.name + "_end";
    end.parent = static_cast<int>(joints.size()) - 1;
    end.offset_m = height_m * FromYUp(bone.along);
    joints.push_back(std::move(end));
  }
  return MakeSkeleton(std::move(joints));
}

Eigen::VectorXd TPose(const Skeleton& skeleton, const Landmarks& landmarks) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(skeleton.dof);
  Kinematics at(skeleton);
  const auto place = [&](Landmark l) { return at.p_WJ[static_cast<std::size_t>(landmarks[l])]; };
  // Turns a joint so that the line to the next one points along `to_W`.
  const auto point = [&](Landmark from, Landmark next, const Eigen::Vector3d& to_W) {
    ComputeKinematics(skeleton, q, at);
    const int index = landmarks[from];
    const Joint& joint = skeleton.joint(index);
    const Eigen::Quaterniond turn = LeastTurn(place(next) - place(from), to_W);
    const Eigen::Matrix3d& R_WP = at.R_WJ[static_cast<std::size_t>(joint.parent)];
    SetJointRotation(
        joint,
        R_WP.transpose() * turn.toRotationMatrix() * at.R_WJ[static_cast<std::size_t>(index)], q);
  };
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY(), down = -Eigen::Vector3d::UnitZ();
  point(Landmark::kLeftHip, Landmark::kLeftKnee, down);
  point(Landmark::kRightHip, Landmark::kRightKnee, down);
  point(Landmark::kLeftShoulder, Landmark::kLeftElbow, left);
  point(Landmark::kRightShoulder, Landmark::kRightElbow, -left);
  ComputeKinematics(skeleton, q, at);
  double lowest_m = 0;
  for (const Eigen::Vector3d& p_W : at.p_WJ) lowest_m = std::min(lowest_m, p_W.z());
  q(2) = -lowest_m;
  return q;
}

}  // namespace footing::body
