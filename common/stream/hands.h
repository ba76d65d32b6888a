#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"

namespace footing::stream {

/// Joints of a tracked skeleton beside the hands; a foot is the ankle.
enum class BodyJoint {
  kUnspecified = 0,
  kHead = 1,
  kNeck = 2,
  kLeftShoulder = 3,
  kRightShoulder = 4,
  kLeftElbow = 5,
  kRightElbow = 6,
  kTorso = 7,
  kLeftHip = 8,
  kRightHip = 9,
  kLeftKnee = 10,
  kRightKnee = 11,
  kLeftFoot = 12,
  kRightFoot = 13,
};
inline constexpr std::size_t kBodyJoints = 13;

/// Limits of a hand frame, which footingd checks (hands::Problem) and trackers keep.
inline constexpr std::size_t kMostTrackedPoints = 16;
inline constexpr double kFarthestPointM = 10;  ///< From W's origin.
inline constexpr double kLargestPointSdM = 1;
inline constexpr std::int64_t kOldestPointNs = 1'000'000'000;

/// A point of a body as a tracker sees it, in W: a hand, by its role, or another joint.
struct TrackedPoint {
  DeviceRole role = DeviceRole::kUnspecified;  ///< kLeftHand: the middle of the left fist.
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Zero();  ///< Along W's axes.
  double confidence = 0;  ///< 0 to 1; 0: looked for and not seen, nothing else of it counts.
  /// Of x and y, x and z, y and z; with sd_m the whole matrix. Zero: none are known.
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
  bool saturated = false;                     ///< Its light is at the sensor's limit.
  bool occluded = false;                      ///< It, or part of it, is hidden or beyond the image.
  BodyJoint joint = BodyJoint::kUnspecified;  ///< Where there is no role.
};

/// A tracker's own frame T in W.
struct TrackerPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// What a tracker sends: all points of one exposure.
struct HandFrame {
  std::string tracker;
  std::string rig;
  std::int64_t age_ns = 0;   ///< Since the exposure, when it was sent.
  std::int64_t sent_ns = 0;  ///< By the monotonic clock of footingd's host; 0: not known.
  std::vector<TrackedPoint> points;
  bool simulated = false;
  /// By which the points are in W; nothing: the tracker has no frame of its own. The identity: it
  /// is not calibrated.
  std::optional<TrackerPose> tracker_pose;
};

/// From a device simulator: the true pose behind its simulated reports.
struct ReferenceFrame {
  std::string rig;
  std::int64_t age_ns = 0;
  std::vector<int> parents;                  ///< Of each joint; -1 for the root.
  std::vector<Eigen::Vector3d> positions_m;  ///< Of each joint, in W.
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  std::int64_t sent_ns = 0;  ///< As a HandFrame's.
};

/// A tracked point as footingd publishes it.
struct HandSample {
  std::string rig;
  DeviceRole role = DeviceRole::kUnspecified;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;  ///< Of the exposure.
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Zero();
  double confidence = 0;
  bool simulated = false;
  std::string tracker;
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();  ///< As a TrackedPoint's.
  bool saturated = false;
  bool occluded = false;
  std::optional<TrackerPose> tracker_pose;    ///< As a HandFrame's.
  BodyJoint joint = BodyJoint::kUnspecified;  ///< Where there is no role.
};

/// A simulated body's true pose as footingd publishes it; never estimated from.
struct ReferencePose {
  std::string rig;
  std::int64_t sampled_ns = 0;
  std::vector<int> parents;
  std::vector<Eigen::Vector3d> positions_m;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
};

}  // namespace footing::stream
