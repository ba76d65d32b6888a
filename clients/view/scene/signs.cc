#include "clients/view/scene/signs.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "clients/view/scene/stage.h"
#include "clients/view/scene/text.h"
#include "common/stream/hands.h"

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

void AddArrow(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius_m,
              const Colour& colour, PartList& parts) {
  const Eigen::Vector3f along = to - from;
  const float length = along.norm();
  const float head = std::min(5 * radius_m, 0.6f * length);
  if (length < 1e-4f) return;
  const Eigen::Vector3f neck = to - head / length * along;
  parts.AddRod(from, neck, radius_m, radius_m, colour, 0.2f);
  parts.AddRod(neck, to, 2.4f * radius_m, 0.001f, colour, 0.2f);
}

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

namespace {

constexpr double kSmallestN = 5;
constexpr float kLongestM = 3;
constexpr float kHeadM = 0.12f;

}  // namespace

void AddForceArrows(const CharacterPose& pose, PartList& parts) {
  const Colour colour = Rgb(0xff4d6d);
  for (const stream::Contact& contact : pose.contacts) {
    if (!contact.touching || contact.normal_force_n < kSmallestN) continue;
    const float length =
        std::min(static_cast<float>(contact.normal_force_n / kForcePerMetreN), kLongestM);
    const Eigen::Vector3f foot = contact.position_m.cast<float>();
    const Eigen::Vector3f neck = foot + Eigen::Vector3f(0, 0, length);
    parts.AddRod(foot, neck, 0.016f, 0.016f, colour);
    parts.AddRod(neck, neck + Eigen::Vector3f(0, 0, kHeadM), 0.045f, 0.001f, colour);
  }
}

namespace {

constexpr std::int64_t kSilentNs = 500'000'000;
constexpr float kLeastHalfM = 0.008f, kMostHalfM = 0.6f;
constexpr float kLostRadiusM = 0.02f;
const Colour kUnsureColour = Rgb(0x8c939c);

const Colour kMiddleColour = Rgb(0xe8e8e8);

/// Name of a point of the body, and its side.
struct PointName {
  const char* text = nullptr;  ///< Null: no part of a body.
  int side = -1;               ///< 0 left, 1 right, -1 the middle.
};

PointName NameOf(const stream::HandSample& sample) {
  using stream::BodyJoint;
  if (sample.role == stream::DeviceRole::kLeftHand) return {"left hand", 0};
  if (sample.role == stream::DeviceRole::kRightHand) return {"right hand", 1};
  switch (sample.joint) {
    case BodyJoint::kUnspecified:
      return {};
    case BodyJoint::kHead:
      return {"head"};
    case BodyJoint::kNeck:
      return {"neck"};
    case BodyJoint::kTorso:
      return {"torso"};
    case BodyJoint::kLeftShoulder:
      return {"left shoulder", 0};
    case BodyJoint::kRightShoulder:
      return {"right shoulder", 1};
    case BodyJoint::kLeftElbow:
      return {"left elbow", 0};
    case BodyJoint::kRightElbow:
      return {"right elbow", 1};
    case BodyJoint::kLeftHip:
      return {"left hip", 0};
    case BodyJoint::kRightHip:
      return {"right hip", 1};
    case BodyJoint::kLeftKnee:
      return {"left knee", 0};
    case BodyJoint::kRightKnee:
      return {"right knee", 1};
    case BodyJoint::kLeftFoot:
      return {"left foot", 0};
    case BodyJoint::kRightFoot:
      return {"right foot", 1};
  }
  return {};
}

/// Visibility problem of a point that has a place; the rest of a hand may be seen.
std::string TroubleOf(const stream::HandSample& sample) {
  if (!sample.occluded) return " too bright";
  return sample.joint == stream::BodyJoint::kUnspecified ? " partly hidden" : " hidden";
}

}  // namespace

void TakeHand(const stream::HandSample& sample, std::int64_t received_ns,
              std::vector<SeenHand>& hands) {
  auto found = std::find_if(hands.begin(), hands.end(), [&](const SeenHand& hand) {
    return hand.newest.rig == sample.rig && hand.newest.role == sample.role &&
           hand.newest.joint == sample.joint && hand.newest.tracker == sample.tracker;
  });
  if (found == hands.end()) found = hands.insert(hands.end(), SeenHand());
  found->newest = sample;
  found->received_ns = received_ns;
  if (sample.confidence > 0) found->seen = sample;
}

Eigen::Matrix3f HandEllipsoid(const stream::HandSample& sample) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(stream::CovarianceOf(sample));
  const Eigen::Vector3f half = (2 * axes.eigenvalues().cwiseMax(0).cwiseSqrt())
                                   .cast<float>()
                                   .cwiseMax(kLeastHalfM)
                                   .cwiseMin(kMostHalfM);
  return axes.eigenvectors().cast<float>() * half.asDiagonal();
}

void AddHandSigns(const std::vector<SeenHand>& hands, const std::string& rig, std::int64_t now_ns,
                  BodySigns& signs) {
  for (const SeenHand& hand : hands) {
    const stream::HandSample& sample = hand.newest;
    const PointName name = NameOf(sample);
    if (sample.rig != rig || name.text == nullptr || !hand.seen) continue;
    if (now_ns - hand.received_ns > kSilentNs) continue;
    const Eigen::Vector3f at = hand.seen->position_m.cast<float>();
    if (sample.confidence == 0) {
      signs.solid.AddBall(
          Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(kLostRadiusM)),
          kUnsureColour, kUnsureColour, 0);
      signs.labels.push_back({at, std::string(name.text) + " not seen", kUnsureColour});
      continue;
    }
    const Eigen::Matrix3f axes = HandEllipsoid(sample);
    const bool is_unsure = sample.occluded || sample.saturated;
    const Colour own =
        name.side < 0 ? kMiddleColour : SideColour(static_cast<std::size_t>(name.side));
    const Colour colour = is_unsure ? kUnsureColour : own;
    signs.solid.AddBall(
        Ellipsoid(at, axes.colwise().normalized(), axes.colwise().norm().transpose()), colour,
        colour, 0.2f);
    if (!is_unsure) continue;
    signs.labels.push_back({at, name.text + TroubleOf(sample), colour});
  }
}

}  // namespace footing::scene
