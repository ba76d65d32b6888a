#include "clients/stream/feeds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/body/points.h"
#include "common/body/skeleton_points.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/kinect_skeleton.h"

namespace footing::stream_client {
namespace {

constexpr double kTruthRateHz = 60;
constexpr std::size_t kMostJoints = 64;  // Of a reference frame.
constexpr double kLeastSdM = 0.001;      // Nobody's tracker is exact.
constexpr double kCapM = 0.12;           // A sphere on a cap, above the middle of the head.

/// The body's pose between two frames.
Eigen::VectorXd PoseAt(const Stage& stage, double t_s) {
  const Stage::Instant at = stage.At(t_s);
  const Eigen::MatrixXd& q = stage.scene.motion.q;
  return (1 - at.share) * q.col(at.frame) + at.share * q.col(at.frame + 1);
}

body::Kinematics KinematicsAt(const Stage& stage, double t_s) {
  body::Kinematics at(stage.scene.body.skeleton);
  body::ComputeKinematics(stage.scene.body.skeleton, PoseAt(stage, t_s), at);
  return at;
}

}  // namespace

std::vector<int> ShownJoints(const body::Body& body) {
  const body::Skeleton& skeleton = body.skeleton;
  const auto size = static_cast<std::size_t>(skeleton.size());
  std::vector<bool> shown(size, size <= kMostJoints);
  for (const int landmark : body.landmarks.joint)
    for (int joint = landmark; joint >= 0; joint = skeleton.joint(joint).parent)
      shown[static_cast<std::size_t>(joint)] = true;
  std::vector<int> joints;
  for (std::size_t i = 0; i < size && joints.size() < kMostJoints; ++i)
    if (shown[i]) joints.push_back(static_cast<int>(i));
  return joints;
}

Eigen::Vector3d PlaceAt(const Stage& stage, const body::Point& point, double t_s) {
  return body::Place(point, KinematicsAt(stage, t_s));
}

Eigen::Vector3d FistAt(const Stage& stage, int side, double t_s) {
  return PlaceAt(stage, body::Fist(stage.scene.body, side), t_s);
}

body::Point CapSphere(const Stage& stage) { return body::AboveHead(stage.scene.body, kCapM); }

namespace {

/// Both fists where they are.
stream::HandFrame Fists(const Stage& stage, const char* tracker, double sd_m, double t_s) {
  const body::Kinematics at = KinematicsAt(stage, t_s);
  stream::HandFrame frame;
  frame.tracker = tracker;
  frame.simulated = true;
  for (const int side : {0, 1}) {
    stream::TrackedPoint point;
    point.role = side == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    point.position_m = body::Place(body::Fist(stage.scene.body, side), at);
    point.sd_m.setConstant(sd_m);
    point.confidence = 1;
    frame.points.push_back(point);
  }
  return frame;
}

}  // namespace

Feed HandFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed) {
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.hands = [stage, noise_m, random = noise::Random(seed)](double t_s) mutable {
    stream::HandFrame frame = Fists(*stage, "move", std::max(noise_m, kLeastSdM), t_s);
    for (stream::TrackedPoint& point : frame.points)
      for (double& value : point.position_m) value += noise_m * random.Normal();
    return frame;
  };
  return feed;
}

Feed HeadFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed) {
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.hands = [stage, noise_m, sphere = CapSphere(*stage),
                random = noise::Random(seed)](double t_s) mutable {
    stream::HandFrame frame;
    frame.tracker = "cap";
    frame.simulated = true;
    stream::TrackedPoint& point = frame.points.emplace_back();
    point.joint = stream::BodyJoint::kHead;
    point.position_m = PlaceAt(*stage, sphere, t_s);
    for (double& value : point.position_m) value += noise_m * random.Normal();
    point.sd_m.setConstant(std::max(noise_m, kLeastSdM));
    point.confidence = 1;
    return frame;
  };
  return feed;
}

Feed KinectFeed(std::shared_ptr<const Stage> stage, std::uint64_t seed) {
  using virtual_sensors::KinectErrors;
  using virtual_sensors::KinectSkeleton;
  constexpr double kTracked = 1, kInferred = 0.5;  // As NiTE says it.
  Feed feed;
  feed.rate_hz = 1 / KinectErrors::kPeriodS;
  feed.late_s = KinectErrors::kLateS;
  feed.hands = [stage, kinect = KinectSkeleton(stage->scene.body, seed)](double t_s) mutable {
    stream::HandFrame frame;
    frame.tracker = "kinect";
    frame.simulated = true;
    const auto& seen = kinect.Expose(KinematicsAt(*stage, t_s));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      stream::TrackedPoint& point = frame.points.emplace_back();
      if (i < KinectSkeleton::kHands) {
        point.role = i == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
      } else {
        point.joint = static_cast<stream::BodyJoint>(i - KinectSkeleton::kHands + 1);
      }
      point.position_m = seen[i].p_W_m;
      point.confidence = seen[i].hidden ? kInferred : kTracked;
      point.sd_m.setConstant(std::sqrt(point.confidence) * seen[i].sd_m);
      point.occluded = seen[i].hidden;
    }
    return frame;
  };
  return feed;
}

Feed PoseFeed(std::shared_ptr<const Stage> stage) {
  const std::vector<int> joints = ShownJoints(stage->scene.body);
  std::vector<int> parents;
  for (const int joint : joints) {
    const int parent = stage->scene.body.skeleton.joint(joint).parent;
    const auto found = std::find(joints.begin(), joints.end(), parent);
    parents.push_back(found == joints.end() ? -1 : static_cast<int>(found - joints.begin()));
  }
  Feed feed;
  feed.rate_hz = kTruthRateHz;
  feed.reference = [stage, joints, parents](double t_s) {
    const body::Kinematics at = KinematicsAt(*stage, t_s);
    stream::ReferenceFrame frame;
    frame.parents = parents;
    for (const int joint : joints)
      frame.positions_m.push_back(at.p_WJ[static_cast<std::size_t>(joint)]);
    frame.com_m = body::CentreOfMass(stage->scene.body, at);
    return frame;
  };
  return feed;
}

void AddBodyFeeds(const std::shared_ptr<const Stage>& stage, const std::string& hands,
                  double hand_noise_m, const Common& common, Plan& plan) {
  if (hands == "move") {
    plan.feeds.push_back(HandFeed(stage, hand_noise_m, DeviceSeed(common, 3) + 700));
  } else if (hands == "kinect") {
    plan.feeds.push_back(KinectFeed(stage, DeviceSeed(common, 3) + 700));
  }
  plan.feeds.push_back(PoseFeed(stage));
  plan.duration_s = common.seconds > 0 ? common.seconds : stage->repeats ? 0 : stage->duration_s();
}

}  // namespace footing::stream_client
