#include "daemon/simulation/pose_service/t_pose_check.h"

#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/points.h"

namespace footing::pose_service {
namespace {

constexpr double kHeightMargin = 0.18;  // Of the T-pose's height of the hands.
constexpr double kLeastSpan = 0.7;      // Of the T-pose's span.
constexpr double kMostSdM = 0.1;

Eigen::Vector3d FistOf(const body::Body& body, const body::Kinematics& at, int side) {
  return body::Place(body::Fist(body, side), at);
}

bool IsJudged(const reconstruction::HandInput& hand) {
  return hand.valid && hand.sd_m.maxCoeff() <= kMostSdM;
}

}  // namespace

TPoseHands TPoseHandsOf(const body::Body& body) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const Eigen::Vector3d left_m = FistOf(body, at, 0), right_m = FistOf(body, at, 1);
  return {0.5 * (left_m.z() + right_m.z()), (left_m - right_m).norm()};
}

std::array<bool, reconstruction::kHands> HandsOffTPose(
    const TPoseHands& expected,
    const std::array<reconstruction::HandInput, reconstruction::kHands>& hands) {
  std::array<bool, reconstruction::kHands> off{};
  for (std::size_t side = 0; side < off.size(); ++side) {
    const double error_m = hands[side].p_W_m.z() - expected.height_m;
    off[side] = IsJudged(hands[side]) && std::abs(error_m) > kHeightMargin * expected.height_m;
  }
  if (off[0] || off[1] || !IsJudged(hands[0]) || !IsJudged(hands[1])) return off;
  const double span_m = (hands[0].p_W_m - hands[1].p_W_m).head<2>().norm();
  if (span_m < kLeastSpan * expected.span_m) off.fill(true);
  return off;
}

}  // namespace footing::pose_service
