#include "clients/log/biped_person.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

using body::Landmark;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Radius of the biped's feet, which are balls.
constexpr double kFootRadiusM = 0.02;
/// Hanging arms do not touch the thighs.
constexpr double kArmsDownDeg = 80;

int FindLink(const v1::Skeleton& skeleton, const std::string& name) {
  for (int i = 0; i < skeleton.links_size(); ++i) {
    if (skeleton.links(i).name() == name) return i;
  }
  return -1;
}

/// The middle of the ball at the lower end of a leg's link.
Vector3d FootOf(const v1::Character& character, int link, double below_m) {
  return PlaceOf(character, link) - below_m * TurnOf(character, link).col(2);
}

/// Columns: a frame with z against `along` and y as near to `left` as that allows.
Matrix3d FrameAgainst(const Vector3d& along, const Vector3d& left) {
  Matrix3d frame;
  frame.col(2) = -along.normalized();
  frame.col(0) = left.cross(frame.col(2)).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// The forces at the feet of a biped, as the pose engine reports those of a person.
v1::BodyState BodyOf(const v1::Character& biped) {
  v1::BodyState body;
  body.set_calibrated(true);
  for (const v1::Contact& contact : biped.contacts()) {
    v1::BodyFoot& foot = *body.add_feet();
    foot.set_load_n(contact.touching() ? contact.normal_force_n() : 0);
    foot.set_cop_valid(contact.touching());
    *foot.mutable_cop_m() = contact.position_m();
  }
  return body;
}

}  // namespace

Vector3d PlaceOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).position_m());
}

Matrix3d TurnOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).orientation()).normalized().toRotationMatrix();
}

bool BipedPerson::IsBiped(const v1::Skeleton& skeleton) {
  return skeleton.links_size() == 5 && FindLink(skeleton, "left_knee") > 0 &&
         FindLink(skeleton, "right_knee") > 0 && FindLink(skeleton, "left_hip") > 0 &&
         FindLink(skeleton, "right_hip") > 0;
}

double BipedPerson::LongestLegM(const v1::Skeleton& biped, const v1::Character& character) {
  double longest_m = 0;
  if (character.links_size() != biped.links_size()) return longest_m;
  for (const std::string side : {"left", "right"}) {
    const int knee = FindLink(biped, side + "_knee");
    const Vector3d foot = FootOf(character, knee, biped.links(knee).size_m().z() / 2);
    const Vector3d hip = PlaceOf(character, FindLink(biped, side + "_hip"));
    longest_m = std::max(longest_m, (foot - hip).norm());
  }
  return longest_m;
}

std::optional<BipedPerson> BipedPerson::Of(const v1::Skeleton& biped, double longest_leg_m) {
  if (!IsBiped(biped) || !(longest_leg_m > 0.1)) return std::nullopt;
  const auto leg_of = [](const body::Skeleton& skeleton, const body::Landmarks& landmarks) {
    return skeleton.joint(landmarks[Landmark::kLeftKnee]).offset_m.norm() +
           skeleton.joint(landmarks[Landmark::kLeftAnkle]).offset_m.norm();
  };
  const body::Skeleton unit = body::StandardPerson(1);
  const body::Landmarks landmarks = body::FindLandmarks(unit).value();
  BipedPerson person;
  person.skeleton_ = body::StandardPerson(longest_leg_m / leg_of(unit, landmarks));
  person.foot_below_link_m_ = biped.links(FindLink(biped, "left_knee")).size_m().z() / 2;
  body::Kinematics rest(person.skeleton_);
  body::ComputeKinematics(person.skeleton_, body::TPose(person.skeleton_, landmarks), rest);
  const auto at = [&](Landmark landmark) -> const Vector3d& {
    return rest.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
  };
  person.ankle_over_foot_m_ = at(Landmark::kLeftAnkle).z() - kFootRadiusM;
  for (const int side : {0, 1}) {
    const auto joint = [&](Landmark left) { return landmarks[body::OfSide(left, side)]; };
    const std::string name = side == 0 ? "left" : "right";
    person.legs_[static_cast<std::size_t>(side)] = {
        joint(Landmark::kLeftHip), joint(Landmark::kLeftKnee), joint(Landmark::kLeftAnkle),
        FindLink(biped, name + "_hip"), FindLink(biped, name + "_knee")};
    person.level_[static_cast<std::size_t>(side)] =
        rest.R_WJ[static_cast<std::size_t>(joint(Landmark::kLeftAnkle))];
    person.shoulders_[static_cast<std::size_t>(side)] = joint(Landmark::kLeftShoulder);
  }
  return person;
}

v1::Skeleton BipedPerson::Skeleton() const {
  v1::Skeleton skeleton;
  skeleton.set_name("person");
  for (const body::Joint& joint : skeleton_.joints) {
    v1::Link& link = *skeleton.add_links();
    link.set_name(joint.name);
    link.set_parent(joint.parent);
  }
  return skeleton;
}

v1::CharacterFrame BipedPerson::Frame(const v1::CharacterFrame& frame) const {
  v1::CharacterFrame out = frame;
  if (out.characters_size() == 0 || out.characters(0).links_size() != 5) return out;
  v1::Character& character = *out.mutable_characters(0);
  const v1::Character biped = character;
  const Matrix3d R_WB = TurnOf(biped, 0);
  const double heading_rad = std::atan2(R_WB(1, 0), R_WB(0, 0));
  const auto joints = static_cast<std::size_t>(skeleton_.size());
  std::vector<Vector3d> p_WJ(joints);
  std::vector<Matrix3d> R_WJ(joints);
  // Joints whose rotation is not that of their parent.
  std::vector<std::optional<Matrix3d>> own(joints);
  std::vector<std::optional<Vector3d>> placed(joints);
  own[0] = R_WB;
  placed[0] = PlaceOf(biped, 0);
  for (std::size_t side = 0; side < 2; ++side) {
    const double down_rad = DegreesToRadians(side == 0 ? -kArmsDownDeg : kArmsDownDeg);
    own[static_cast<std::size_t>(shoulders_[side])] =
        R_WB * body::AxisRotation(body::Axis::kX, down_rad);
    const Leg& leg = legs_[side];
    const Vector3d hip = PlaceOf(biped, leg.hip_link);
    const Vector3d ankle =
        FootOf(biped, leg.foot_link, foot_below_link_m_) + ankle_over_foot_m_ * Vector3d::UnitZ();
    const Vector3d thigh = skeleton_.joint(leg.knee).offset_m;
    const Vector3d shank = skeleton_.joint(leg.ankle).offset_m;
    const double most_m = thigh.norm() + shank.norm() - 1e-6;
    const double distance_m = std::clamp((ankle - hip).norm(), 0.01, most_m);
    const Vector3d down = (ankle - hip).normalized();
    const Vector3d left = (-down).cross(R_WB.col(0)).normalized();
    const Vector3d ahead = left.cross(-down);
    const double along_m =
        (thigh.squaredNorm() - shank.squaredNorm() + distance_m * distance_m) / (2 * distance_m);
    const double bent_m = std::sqrt(std::max(0.0, thigh.squaredNorm() - along_m * along_m));
    const Vector3d knee = hip + along_m * down + bent_m * ahead;
    const Vector3d end = hip + distance_m * down;
    const auto turned = [&](const Vector3d& at_rest, const Vector3d& now) -> Matrix3d {
      return FrameAgainst(now, left) * FrameAgainst(at_rest, Vector3d::UnitY()).transpose();
    };
    placed[static_cast<std::size_t>(leg.hip)] = hip;
    own[static_cast<std::size_t>(leg.hip)] = turned(thigh, knee - hip);
    own[static_cast<std::size_t>(leg.knee)] = turned(shank, end - knee);
    own[static_cast<std::size_t>(leg.ankle)] =
        body::AxisRotation(body::Axis::kZ, heading_rad) * level_[side];
  }
  character.clear_links();
  for (std::size_t i = 0; i < joints; ++i) {
    const body::Joint& joint = skeleton_.joints[i];
    const auto parent = static_cast<std::size_t>(std::max(0, joint.parent));
    R_WJ[i] = own[i] ? *own[i] : R_WJ[parent];
    p_WJ[i] = placed[i] ? *placed[i] : Vector3d(p_WJ[parent] + R_WJ[parent] * joint.offset_m);
    *character.add_links() = wire::ToProto(stream::LinkPose{p_WJ[i], Eigen::Quaterniond(R_WJ[i])});
  }
  *character.mutable_body() = BodyOf(biped);
  return out;
}

}  // namespace footing::log_client
