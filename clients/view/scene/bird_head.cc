#include <cmath>

#include "clients/view/scene/bird.h"

namespace footing::scene {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

// Metres, chosen by eye.
const Vector3f kNeckBase(0.20f, 0, 0.13f);
constexpr float kHeadAheadM = 0.40f;
constexpr float kHeadAboveM = 0.60f;
constexpr float kHeadRadiusM = 0.098f;
constexpr int kNeckPieces = 12;

/// Yaw about z, then pitch; positive pitch looks up.
Matrix3f HeadAxes(const BirdMotion& motion) {
  const auto yaw = static_cast<float>(motion.head_yaw_rad);
  const auto pitch = static_cast<float>(motion.head_pitch_rad);
  return (Eigen::AngleAxisf(yaw, Vector3f::UnitZ()) *
          Eigen::AngleAxisf(-0.6f * pitch, Vector3f::UnitY()))
      .toRotationMatrix();
}

/// An S-shaped neck: a cubic from the trunk forwards and up into the head.
void AddNeck(const Vector3f& base, const Vector3f& base_forward, const Vector3f& head,
             const Matrix3f& axes, const Plumage& plumage, PartList& parts) {
  const Vector3f bend = base + 0.22f * base_forward + Vector3f(0, 0, 0.04f);
  const Vector3f nape = head - axes * Vector3f(0.07f, 0, 0.24f);
  Vector3f before = base;
  float radius_before = 0.14f;
  for (int piece = 1; piece <= kNeckPieces; ++piece) {
    const float t = static_cast<float>(piece) / kNeckPieces, s = 1 - t;
    const Vector3f at =
        s * s * s * base + 3 * s * s * t * bend + 3 * s * t * t * nape + t * t * t * head;
    const float radius = 0.056f + 0.084f * s * s;
    parts.AddLimb(before, at, radius_before, radius, plumage.back, 0.12f);
    before = at;
    radius_before = radius;
  }
}

void AddEye(const Matrix4f& X_WH, float side, PartList& parts) {
  const Matrix3f axes = Matrix3f::Identity();
  const Colour white = Rgb(0xffffff), dark = Rgb(0x16130f);
  const auto ball = [&](const Vector3f& centre, float radius) {
    return Matrix4f(X_WH * Ellipsoid(centre, axes, Vector3f::Constant(radius)));
  };
  parts.AddBall(ball({0.044f, side * 0.064f, 0.034f}, 0.038f), white, white, 0.6f);
  parts.AddBall(ball({0.056f, side * 0.081f, 0.037f}, 0.024f), dark, dark, 0.9f);
  parts.AddBall(ball({0.068f, side * 0.096f, 0.049f}, 0.0075f), white, white, 0);
}

void AddBeakAndCrest(const Vector3f& head, const Matrix3f& axes, const Plumage& plumage,
                     PartList& parts) {
  const auto at = [&](float x, float y, float z) -> Vector3f {
    return head + axes * Vector3f(x, y, z);
  };
  parts.AddRod(at(0.070f, 0, 0.004f), at(0.225f, 0, -0.022f), 0.044f, 0.005f, plumage.beak, 0.5f);
  parts.AddRod(at(0.066f, 0, -0.024f), at(0.185f, 0, -0.036f), 0.030f, 0.004f, plumage.skin, 0.3f);
  for (int plume = 0; plume < 3; ++plume) {
    const auto back = static_cast<float>(plume);
    const Vector3f root = at(0.01f - 0.035f * back, 0, 0.085f - 0.008f * back);
    const Vector3f middle = at(-0.02f - 0.065f * back, 0, 0.15f - 0.02f * back);
    const Vector3f tip = at(-0.075f - 0.085f * back, 0, 0.185f - 0.035f * back);
    parts.AddLimb(root, middle, 0.022f, 0.017f, plumage.crest, 0.2f);
    parts.AddLimb(middle, tip, 0.017f, 0.010f, plumage.crest, 0.2f);
  }
}

}  // namespace

void AddHead(const Matrix4f& X_WB, const BirdMotion& motion, const Plumage& plumage,
             PartList& parts) {
  const Matrix3f axes = HeadAxes(motion);
  const Vector3f level_forward(axes(0, 0), axes(1, 0), 0);
  const Vector3f place = X_WB.topRightCorner<3, 1>();
  const Vector3f base = place + X_WB.topLeftCorner<3, 3>() * kNeckBase;
  const Vector3f head = place + kHeadAheadM * level_forward.normalized() +
                        Vector3f(0, 0, kHeadAboveM + static_cast<float>(motion.head_lift_m));
  AddNeck(base, X_WB.block<3, 1>(0, 0), head, axes, plumage, parts);

  const Matrix4f X_WH = Ellipsoid(head, axes, Vector3f::Ones());
  parts.AddBall(Ellipsoid(head, axes, {kHeadRadiusM * 1.12f, kHeadRadiusM, kHeadRadiusM}),
                plumage.back, plumage.belly, 0.2f);
  for (const float side : {1.0f, -1.0f}) AddEye(X_WH, side, parts);
  AddBeakAndCrest(head, axes, plumage, parts);
}

}  // namespace footing::scene
