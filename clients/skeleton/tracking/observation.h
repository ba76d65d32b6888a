#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

#include "clients/skeleton/tracking/person_gate.h"
#include "clients/skeleton/tracking/joints.h"
#include "common/stream/hands.h"

namespace footing::skeleton {

/// A joint in W. What is absent has no place.
struct JointObservation {
  bool present = false;
  bool inferred = false;  ///< The camera did not see it and filled it in.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_W_m2 = Eigen::Matrix3d::Identity();
  double confidence = 0;
};

/// One exposure of one person, as it goes to footingd.
struct Observation {
  std::int32_t user = 0;
  std::optional<std::int64_t> sequence;
  std::int64_t exposed_ns = 0, arrived_ns = 0;  ///< Monotonic, of this host.
  std::array<JointObservation, kJoints> joints;
  Eigen::Isometry3d X_WK = Eigen::Isometry3d::Identity();  ///< By which they are in W.
};

/// Standard deviations of a tracked joint: jitter of recorded Kinect v2 joints (2 to 4 mm between
/// frames, 10 to 21 mm of bone length) and the offset against marker systems, which changes slowly
/// (50 to 100 mm for most joints of the Kinect 2: Wang, Kurillo et al. 2015, here 40 mm, since half
/// of it are other definitions of joints). An inferred joint has three times as much.
inline constexpr double kJitterM = 0.015;
inline constexpr double kOffsetM = 0.04;
inline constexpr double kInferredFactor = 3;

/// A frame behind the gate, in W.
Observation Observe(const Skeleton& skeleton, const Eigen::Isometry3d& X_WK);

/// An observation for the device socket: all joints, those that are absent, or too far off, with
/// confidence 0. What counts of a point is its covariance over its confidence, which is the
/// observation's (docs/protocol.md).
stream::HandFrame ToHandFrame(const Observation& observation, std::int64_t now_ns);

}  // namespace footing::skeleton
