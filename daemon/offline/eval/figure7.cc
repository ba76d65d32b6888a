#include "daemon/offline/eval/figure7.h"

#include <cmath>

#include "common/body/skeleton_points.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::eval {
namespace {

using stream::BodyJoint;

constexpr double kSeenFromDeg = 35;  // From the front to the left, as the crouches of eval pose.

void AddMoment(const std::string& name, const Figure7::Moment& moment,
               std::vector<plot::Panel>& panels) {
  const plot::Sticks truth = SticksOf(moment.truth);
  const std::string hides = name + ", " + std::to_string(moment.hidden) + " joints hidden";
  panels.push_back({hides + ": Kinect alone", truth, SticksOf(moment.alone)});
  panels.push_back(
      {"with the boards, " + text::Fixed(moment.time_s, 1) + " s", truth, SticksOf(moment.fused)});
}

}  // namespace

plot::Sticks SticksOf(const StickPlaces& places) {
  constexpr std::array kBones{std::array{BodyJoint::kHead, BodyJoint::kNeck},
                              std::array{BodyJoint::kNeck, BodyJoint::kTorso},
                              std::array{BodyJoint::kNeck, BodyJoint::kLeftShoulder},
                              std::array{BodyJoint::kNeck, BodyJoint::kRightShoulder},
                              std::array{BodyJoint::kLeftShoulder, BodyJoint::kLeftElbow},
                              std::array{BodyJoint::kRightShoulder, BodyJoint::kRightElbow},
                              std::array{BodyJoint::kTorso, BodyJoint::kLeftHip},
                              std::array{BodyJoint::kTorso, BodyJoint::kRightHip},
                              std::array{BodyJoint::kLeftHip, BodyJoint::kLeftKnee},
                              std::array{BodyJoint::kRightHip, BodyJoint::kRightKnee},
                              std::array{BodyJoint::kLeftKnee, BodyJoint::kLeftFoot},
                              std::array{BodyJoint::kRightKnee, BodyJoint::kRightFoot}};
  const double yaw_rad = DegreesToRadians(kSeenFromDeg);
  const auto across = [&](const Eigen::Vector3d& p) {
    return std::cos(yaw_rad) * p.x() - std::sin(yaw_rad) * p.y();
  };
  plot::Sticks sticks;
  const auto add = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    sticks.push_back({across(from), from.z(), across(to), to.z()});
  };
  for (const auto& bone : kBones) {
    add(places.joints[body::IndexOf(bone[0])], places.joints[body::IndexOf(bone[1])]);
  }
  add(places.joints[body::IndexOf(BodyJoint::kLeftElbow)], places.hands[0]);
  add(places.joints[body::IndexOf(BodyJoint::kRightElbow)], places.hands[1]);
  return sticks;
}

std::string Figure7::Svg() const {
  std::vector<plot::Panel> panels;
  if (squat_) AddMoment("squat", *squat_, panels);
  if (other_) AddMoment("standing", *other_, panels);
  return plot::StickPlot(panels.empty() ? "Nothing is hidden from the camera"
                                        : "Where the camera loses joints; grey: the truth",
                         panels);
}

}  // namespace footing::eval
