#include "clients/view/scene/hand_signs.h"

#include <Eigen/Dense>
#include <algorithm>

#include "clients/view/scene/boards.h"
#include "common/stream/hand_covariance.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kSilentNs = 500'000'000;
constexpr float kLeastHalfM = 0.008f, kMostHalfM = 0.6f;
constexpr float kLostRadiusM = 0.02f;
const Colour kUnsureColour = Rgb(0x8c939c);

const Colour kMiddleColour = Rgb(0xe8e8e8);

/// What a point is called, and its side.
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

/// What is wrong with the sight of a point that has a place; a hand's rest may be seen.
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
