#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/hand_frames.h"

namespace footing::stream {

inline constexpr std::size_t kBodyJoints = 13;

/// Limits of a hand frame, which footingd checks (hands::Problem) and trackers keep.
inline constexpr std::size_t kMostTrackedPoints = 16;
inline constexpr double kFarthestPointM = 10;  ///< From W's origin.
inline constexpr double kLargestPointSdM = 1;
inline constexpr std::int64_t kOldestPointNs = 1'000'000'000;

/// From a device simulator: the true pose behind its simulated reports.
struct ReferenceFrame {
  std::string rig;
  std::int64_t age_ns = 0;
  std::vector<int> parents;                  ///< Parent of each joint; -1 for the root.
  std::vector<Eigen::Vector3d> positions_m;  ///< Place of each joint, in W.
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  std::int64_t sent_ns = 0;  ///< As a HandFrame's.
};

/// Covariance of the sample's position, m^2, in W.
inline Eigen::Matrix3d CovarianceOf(const HandSample& sample) {
  Eigen::Matrix3d covariance = sample.sd_m.cwiseAbs2().asDiagonal();
  covariance(0, 1) = covariance(1, 0) = sample.covariance_m2.x();
  covariance(0, 2) = covariance(2, 0) = sample.covariance_m2.y();
  covariance(1, 2) = covariance(2, 1) = sample.covariance_m2.z();
  return covariance;
}

}  // namespace footing::stream
