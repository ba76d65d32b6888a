#include "clients/view/scene/body_signs.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/arrows.h"
#include "clients/view/scene/boards.h"
#include "clients/view/scene/words.h"

namespace footing::scene {
namespace {

using Eigen::Vector3f;

constexpr double kTrailS = 4;
constexpr double kLeastForceN = 20;
constexpr float kForceRadiusM = 0.010f;
constexpr float kMomentumPerMetre = 60;  // kg m/s.
constexpr double kLeastMomentum = 3;     // kg m/s: less is noise.
constexpr float kRingRadiusM = 0.20f;
constexpr double kFullTurnAt = 12;     // kg m^2/s: a closed ring.
constexpr double kLeastAngular = 0.5;  // kg m^2/s.
constexpr float kGroundM = 0.004f;     // Over the boards: nothing flickers.
constexpr float kLargestEllipseM = 1.2f;

const Colour kComColour = Rgb(0xffffff);
const Colour kMomentumColour = Rgb(0x35d07f);
const Colour kAngularColour = Rgb(0xc77dff);
const Colour kTotalColour = Rgb(0xff5d73);

void AddArrow(const Vector3f& from, const Vector3f& to, float radius_m, const Colour& colour,
              PartList& parts) {
  const Vector3f along = to - from;
  const float length = along.norm();
  const float head = std::min(5 * radius_m, 0.6f * length);
  if (length < 1e-4f) return;
  const Vector3f neck = to - head / length * along;
  parts.AddRod(from, neck, radius_m, radius_m, colour, 0.2f);
  parts.AddRod(neck, to, 2.4f * radius_m, 0.001f, colour, 0.2f);
}

void AddForces(const CharacterPose& pose, BodySigns& signs) {
  Vector3f moment = Vector3f::Zero();
  double total_n = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const BodyFoot& foot = pose.body->feet[side];
    if (!foot.cop_valid || foot.load_n < kLeastForceN) continue;
    const Vector3f cop = foot.cop_m.cast<float>() + Vector3f(0, 0, kGroundM);
    const Vector3f tip = cop + Vector3f(0, 0, static_cast<float>(foot.load_n / kForcePerMetreN));
    const Colour colour = SideColour(side);
    AddArrow(cop, tip, kForceRadiusM, colour, signs.solid);
    signs.clear.AddDisc(cop, {0.028f, 0.028f}, 0, colour);
    signs.labels.push_back({tip, Fixed(foot.load_n, 0) + " N", colour});
    moment += static_cast<float>(foot.load_n) * cop;
    total_n += foot.load_n;
  }
  if (total_n < kLeastForceN) return;
  const Vector3f total = moment / static_cast<float>(total_n);
  signs.solid.AddDisc(total + Vector3f(0, 0, 0.002f), {0.020f, 0.020f}, 0, kTotalColour);
  signs.clear.AddDisc(total, {0.042f, 0.042f}, 0, kTotalColour);
}

void AddCom(const CharacterPose& pose, const ComTrail& trail, BodySigns& signs) {
  const Vector3f com = pose.com_m.cast<float>();
  const Vector3f below(com.x(), com.y(), kGroundM);
  const auto ball = [&](const Vector3f& at, float radius, const Colour& colour) {
    signs.solid.AddBall(Ellipsoid(at, Eigen::Matrix3f::Identity(), Vector3f::Constant(radius)),
                        colour, colour, 0.3f);
  };
  ball(com, 0.032f, kComColour);
  constexpr int kDashes = 12;
  for (int i = 0; i < kDashes; ++i) {
    const auto part = [&](float at) { return below + at / kDashes * (com - below); };
    const auto from = static_cast<float>(i);
    signs.solid.AddRod(part(from + 0.25f), part(from + 0.75f), 0.0035f, 0.0035f, kComColour);
  }
  signs.clear.AddDisc(below, {0.026f, 0.026f}, 0, kComColour);
  for (std::size_t i = 1; i < trail.points.size(); ++i) {
    const float age = static_cast<float>(i) / static_cast<float>(trail.points.size());
    signs.solid.AddRod(trail.points[i - 1].at_m, trail.points[i].at_m, 0.004f * age + 0.001f,
                       0.004f * age + 0.001f, kComColour);
  }
  const Eigen::Vector2d sd = pose.body->com_variance_m2.head<2>().cwiseMax(0).cwiseSqrt();
  signs.clear.AddDisc(below, (2 * sd).cast<float>().cwiseMax(0.005f).cwiseMin(kLargestEllipseM), 0,
                      kComColour);
}

void AddMomentum(const CharacterPose& pose, BodySigns& signs) {
  const BodyState& body = *pose.body;
  const Vector3f com = pose.com_m.cast<float>();
  const Eigen::Vector3d linear = body.mass_kg * pose.com_velocity_mps;
  if (linear.norm() > kLeastMomentum) {
    const Vector3f tip = com + (linear / kMomentumPerMetre).cast<float>();
    AddArrow(com, tip, 0.011f, kMomentumColour, signs.solid);
    signs.labels.push_back({tip, Fixed(linear.norm(), 0) + " kg m/s", kMomentumColour});
  }
  const double angular = body.angular_momentum_kgm2ps.norm();
  if (angular < kLeastAngular) return;
  const Vector3f axis = (body.angular_momentum_kgm2ps / angular).cast<float>();
  const Vector3f x = axis.unitOrthogonal(), y = axis.cross(x);
  const auto on_ring = [&](float angle) {
    return com + kRingRadiusM * (std::cos(angle) * x + std::sin(angle) * y);
  };
  const auto sweep = static_cast<float>(6.0 * std::min(1.0, angular / kFullTurnAt));
  const int pieces = std::max(3, static_cast<int>(sweep / 0.2f));
  const float step = sweep / static_cast<float>(pieces);
  for (int i = 0; i < pieces; ++i) {
    signs.solid.AddLimb(on_ring(step * static_cast<float>(i)),
                        on_ring(step * static_cast<float>(i + 1)), 0.008f, 0.008f, kAngularColour);
  }
  const Vector3f end = on_ring(sweep);
  const Vector3f ahead = on_ring(sweep + 0.02f) - end;
  signs.solid.AddRod(end, end + 0.06f * ahead.normalized(), 0.022f, 0.001f, kAngularColour);
}

void AddEllipses(const BodyState& body, BodySigns& signs) {
  for (std::size_t side = 0; side < body.feet.size(); ++side) {
    const BodyFoot& foot = body.feet[side];
    if (!foot.valid) continue;
    const Vector3f at(static_cast<float>(foot.position_m.x()),
                      static_cast<float>(foot.position_m.y()), kGroundM);
    signs.clear.AddDisc(at, FootEllipse(foot), 0, SideColour(side));
  }
}

}  // namespace

void ComTrail::Add(double time_s, const Eigen::Vector3d& com_m) {
  if (!points.empty() && time_s < points.back().time_s) points.clear();
  const Vector3f at(static_cast<float>(com_m.x()), static_cast<float>(com_m.y()), kGroundM);
  if (points.empty() || time_s - points.back().time_s > 0.03) points.push_back({time_s, at});
  while (points.front().time_s < time_s - kTrailS) points.pop_front();
}

Eigen::Vector2f FootEllipse(const BodyFoot& foot) {
  const Eigen::Vector2d sd = foot.variance_m2.head<2>().cwiseMax(0).cwiseSqrt();
  return (2 * sd).cast<float>().cwiseMin(kLargestEllipseM).cwiseMax(0.005f);
}

void AddBodySigns(const CharacterPose& pose, const ComTrail& trail, BodySigns& signs) {
  if (!pose.body) return;
  AddForces(pose, signs);
  if (!pose.body->momentum_valid) return;
  AddCom(pose, trail, signs);
  AddMomentum(pose, signs);
  AddEllipses(*pose.body, signs);
}

}  // namespace footing::scene
