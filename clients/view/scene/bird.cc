#include "clients/view/scene/bird.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "clients/view/scene/leg_pose.h"

namespace footing::scene {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

// Sizes in metres: chosen by eye for a body whose hips are 1 m over the ground.
const Vector3f kTrunkHalfAxes(0.34f, 0.215f, 0.225f);
const Vector3f kTrunkCentre(0.0f, 0.0f, 0.07f);
const Vector3f kRumpHalfAxes(0.27f, 0.175f, 0.165f);
const Vector3f kRumpCentre(-0.16f, 0.0f, 0.10f);
constexpr float kToeM = 0.17f;
constexpr float kBackToeM = 0.09f;

Matrix3f TurnAbout(const Vector3f& axis, float angle_rad) {
  return Eigen::AngleAxisf(angle_rad, axis.normalized()).toRotationMatrix();
}

void AddTrunk(const Matrix4f& X_WB, const Plumage& plumage, PartList& parts) {
  const Matrix3f pitch_up = TurnAbout(Vector3f::UnitY(), -0.10f);
  parts.AddBall(X_WB * Ellipsoid(kTrunkCentre, pitch_up, kTrunkHalfAxes), plumage.back,
                plumage.belly, 0.15f);
  parts.AddBall(X_WB * Ellipsoid(kRumpCentre, pitch_up, kRumpHalfAxes), plumage.back, plumage.belly,
                0.15f);
  for (int feather = -2; feather <= 2; ++feather) {
    const auto side = static_cast<float>(feather);
    const Matrix3f turn =
        TurnAbout(Vector3f::UnitZ(), -0.24f * side) * TurnAbout(Vector3f::UnitY(), 0.5f);
    const Vector3f centre =
        kRumpCentre + Vector3f(-0.19f, 0, 0.05f) + turn * Vector3f(-0.16f, 0, 0);
    parts.AddBall(X_WB * Ellipsoid(centre, turn, {0.19f, 0.055f, 0.022f}), plumage.tail,
                  plumage.wing, 0.1f);
  }
}

/// Folded, a wing is a drop along the flank; spread, it opens outwards and shows its rows.
void AddWings(const Matrix4f& X_WB, double spread, const Plumage& plumage, PartList& parts) {
  const auto open = static_cast<float>(spread);
  for (const float side : {1.0f, -1.0f}) {
    const Vector3f shoulder(0.13f, side * 0.178f, 0.19f);
    for (int row = 0; row < 3; ++row) {
      const auto low = static_cast<float>(row);
      const Matrix3f turn =
          TurnAbout(Vector3f::UnitX(), side * (-0.16f + (1.55f - 0.12f * low) * open)) *
          TurnAbout(Vector3f::UnitZ(), side * (0.16f - 0.05f * low)) *
          TurnAbout(Vector3f::UnitY(), -0.20f + 0.10f * low);
      const Vector3f half(0.25f - 0.045f * low, 0.032f - 0.005f * low, 0.10f + 0.05f * open);
      const Vector3f centre =
          shoulder + turn * Vector3f(-0.17f - 0.02f * low, side * (0.030f - 0.006f * low),
                                     -0.055f - (0.045f + 0.075f * open) * low);
      const Colour colour = row == 1 ? plumage.tail : plumage.wing;
      parts.AddBall(X_WB * Ellipsoid(centre, turn, half), colour, colour, 0.2f);
    }
  }
}

/// Toes lie on the ground and spread while the foot touches; they fold and hang in flight, as far
/// as the floor lets them.
void AddToes(const Vector3f& foot, const Vector3f& forward, double spread, float floor_m,
             const Colour& skin, PartList& parts) {
  const auto open = static_cast<float>(spread);
  const Vector3f level = Vector3f(forward.x(), forward.y(), 0).normalized();
  const auto on_floor = [floor_m](Vector3f p, float radius) {
    p.z() = std::max(p.z(), floor_m + radius);
    return p;
  };
  for (int toe = -1; toe <= 1; ++toe) {
    const float angle = static_cast<float>(toe) * (0.14f + 0.42f * open);
    const Vector3f ahead = TurnAbout(Vector3f::UnitZ(), angle) * level;
    const Vector3f bent(0, 0, 0.12f - 0.55f * (1 - open)), hung(0, 0, -0.14f - 1.1f * (1 - open));
    const Vector3f knuckle = on_floor(foot + 0.5f * kToeM * (ahead + bent), 0.017f);
    const Vector3f tip = on_floor(knuckle + 0.5f * kToeM * (ahead + hung), 0.008f);
    parts.AddLimb(foot, knuckle, 0.021f, 0.017f, skin);
    parts.AddLimb(knuckle, tip, 0.017f, 0.008f, skin);
  }
  const Vector3f back = -level + Vector3f(0, 0, -0.05f - 0.8f * (1 - open));
  parts.AddLimb(foot, on_floor(foot + kBackToeM * back, 0.008f), 0.017f, 0.008f, skin);
}

void AddLeg(const CharacterPose& pose, int hip_link, int foot_contact, double toe_spread,
            float floor_m, const Plumage& plumage, PartList& parts) {
  const stream::LinkPose& hip = pose.links[static_cast<std::size_t>(hip_link)];
  const Eigen::Vector3d& foot_m = pose.contacts[static_cast<std::size_t>(foot_contact)].position_m;
  const Eigen::Vector3d forward = hip.orientation * Eigen::Vector3d::UnitX();
  const LegPose leg = SolveLeg(hip.position_m, foot_m, forward);
  const Vector3f a = leg.hip_m.cast<float>(), b = leg.ankle_m.cast<float>(),
                 c = leg.foot_m.cast<float>();
  // The drumstick ends in feathers; below them is bare skin.
  const Vector3f hock = a + 0.72f * (b - a);
  const Vector3f calf = a + 0.30f * (b - a);
  parts.AddLimb(a, calf, 0.118f, 0.098f, plumage.tail, 0.12f);
  parts.AddLimb(calf, hock, 0.098f, 0.040f, plumage.tail, 0.12f);
  parts.AddLimb(hock, b, 0.034f, 0.036f, plumage.skin, 0.25f);
  parts.AddLimb(b, c, 0.034f, 0.024f, plumage.skin, 0.25f);
  AddToes(c, forward.cast<float>(), toe_spread, floor_m, plumage.skin, parts);
}

}  // namespace

Plumage PlumageOf(std::uint32_t character) {
  static const std::array<Plumage, 3> kPlumages{{
      {Rgb(0x2f7f9e), Rgb(0xf4ead6), Rgb(0x1d5470), Rgb(0x2a6c8c), Rgb(0xf06449), Rgb(0xf0a04b),
       Rgb(0xf7b538)},
      {Rgb(0x8d5a97), Rgb(0xf3e6ee), Rgb(0x5a3a68), Rgb(0x6f4880), Rgb(0x3aa69b), Rgb(0xd9a066),
       Rgb(0xf2c14e)},
      {Rgb(0x6a994e), Rgb(0xf2eecb), Rgb(0x386641), Rgb(0x4d7c43), Rgb(0xbc4749), Rgb(0xe0a458),
       Rgb(0xf4a259)},
  }};
  // Characters count from 1.
  return kPlumages[(character + kPlumages.size() - 1) % kPlumages.size()];
}

void AddBird(const BirdSkeleton& skeleton, const CharacterPose& pose, const BirdMotion& motion,
             double floor_m, PartList& parts) {
  const auto links = static_cast<int>(pose.links.size());
  const auto contacts = static_cast<int>(pose.contacts.size());
  for (std::size_t leg = 0; leg < 2; ++leg) {
    if (skeleton.hips[leg] >= links || skeleton.feet[leg] >= contacts) return;
  }
  if (skeleton.body >= links) return;
  const stream::LinkPose& body = pose.links[static_cast<std::size_t>(skeleton.body)];
  Matrix4f X_WB = Matrix4f::Identity();
  X_WB.topLeftCorner<3, 3>() = body.orientation.toRotationMatrix().cast<float>();
  X_WB.topRightCorner<3, 1>() = body.position_m.cast<float>();

  const Plumage plumage = PlumageOf(pose.character);
  AddTrunk(X_WB, plumage, parts);
  AddWings(X_WB, motion.wing_spread, plumage, parts);
  AddHead(X_WB, motion, plumage, parts);
  for (std::size_t leg = 0; leg < 2; ++leg) {
    AddLeg(pose, skeleton.hips[leg], skeleton.feet[leg], motion.toe_spread[leg],
           static_cast<float>(floor_m), plumage, parts);
  }
}

}  // namespace footing::scene
