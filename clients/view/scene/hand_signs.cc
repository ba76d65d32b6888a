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

bool IsHand(stream::DeviceRole role) {
  return role == stream::DeviceRole::kLeftHand || role == stream::DeviceRole::kRightHand;
}

std::string NameOf(const stream::HandSample& sample) {
  return sample.role == stream::DeviceRole::kLeftHand ? "left hand" : "right hand";
}

}  // namespace

void TakeHand(const stream::HandSample& sample, std::int64_t received_ns,
              std::vector<SeenHand>& hands) {
  auto found = std::find_if(hands.begin(), hands.end(), [&](const SeenHand& hand) {
    return hand.newest.rig == sample.rig && hand.newest.role == sample.role &&
           hand.newest.tracker == sample.tracker;
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
    if (sample.rig != rig || !IsHand(sample.role) || !hand.seen) continue;
    if (now_ns - hand.received_ns > kSilentNs) continue;
    const Eigen::Vector3f at = hand.seen->position_m.cast<float>();
    if (sample.confidence == 0) {
      signs.solid.AddBall(
          Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(kLostRadiusM)),
          kUnsureColour, kUnsureColour, 0);
      signs.labels.push_back({at, NameOf(sample) + " not seen", kUnsureColour});
      continue;
    }
    const Eigen::Matrix3f axes = HandEllipsoid(sample);
    const bool is_unsure = sample.occluded || sample.saturated;
    const std::size_t side = sample.role == stream::DeviceRole::kLeftHand ? 0 : 1;
    const Colour colour = is_unsure ? kUnsureColour : SideColour(side);
    signs.solid.AddBall(
        Ellipsoid(at, axes.colwise().normalized(), axes.colwise().norm().transpose()), colour,
        colour, 0.2f);
    if (!is_unsure) continue;
    signs.labels.push_back(
        {at, NameOf(sample) + (sample.occluded ? " partly hidden" : " too bright"), colour});
  }
}

}  // namespace footing::scene
