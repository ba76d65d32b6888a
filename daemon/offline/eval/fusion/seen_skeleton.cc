#include "daemon/offline/eval/fusion/seen_skeleton.h"

namespace footing::eval {
namespace {

using body::Landmark;
using virtual_sensors::KinectErrors;

constexpr double kInferredFactor = 3;  // docs/skeleton.md.
constexpr Landmark kSeen[] = {
    Landmark::kHead,      Landmark::kNeck,       Landmark::kLeftShoulder, Landmark::kRightShoulder,
    Landmark::kLeftElbow, Landmark::kRightElbow, Landmark::kLeftWrist,    Landmark::kRightWrist,
    Landmark::kLeftHip,   Landmark::kRightHip,   Landmark::kLeftKnee,     Landmark::kRightKnee};

bool IsOfALeg(Landmark landmark) {
  return landmark == Landmark::kLeftHip || landmark == Landmark::kRightHip ||
         landmark == Landmark::kLeftKnee || landmark == Landmark::kRightKnee;
}

}  // namespace

SeenSkeleton::SeenSkeleton(const body::Body& body, std::uint64_t seed, double step_s)
    : errors_(seed), step_s_(step_s) {
  for (const Landmark landmark : kSeen) {
    SeenJoint seen;
    seen.landmark = landmark;
    seen.joint = body.landmarks[landmark];
    if (seen.joint >= 0) joints_.push_back(seen);
  }
}

const std::vector<SeenJoint>& SeenSkeleton::Advance(const body::Kinematics& truth,
                                                    bool legs_hidden) {
  constexpr double kRoundS = 1e-9;
  const double now_s = now_s_;
  now_s_ += step_s_;
  if (now_s < next_s_ - kRoundS) return joints_;
  next_s_ += KinectErrors::kPeriodS;
  errors_.Expose();
  for (SeenJoint& seen : joints_) {
    const Eigen::Vector3d& p_W_m = truth.p_WJ[static_cast<std::size_t>(seen.joint)];
    const double factor = legs_hidden && IsOfALeg(seen.landmark) ? kInferredFactor : 1;
    seen.p_W_m = p_W_m + factor * (errors_.Measure(p_W_m) - p_W_m);
    seen.sd_m.setConstant(factor * KinectErrors::SdM());
  }
  return joints_;
}

void AddSkeletonTargets(const std::vector<SeenJoint>& joints, pose::PoseTargets& targets) {
  for (const SeenJoint& seen : joints)
    targets.Add({seen.joint, Eigen::Vector3d::Zero(), seen.p_W_m, seen.sd_m});
}

}  // namespace footing::eval
