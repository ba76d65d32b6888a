#include "daemon/offline/pose_run/kinect_body.h"

#include <algorithm>

namespace footing::pose_run {

using virtual_sensors::KinectErrors;
using virtual_sensors::KinectSkeleton;

KinectBody::KinectBody(const body::Body& body, std::uint64_t seed, double step_s,
                       const virtual_sensors::KinectOptions& options)
    : skeleton_(body, seed, options), step_s_(step_s) {
  const auto joints = reconstruction::JointTracks();
  std::copy(joints.begin(), joints.end(), tracks_.begin() + KinectSkeleton::kHands);
}

void KinectBody::Advance(const body::Kinematics& at, bool with_joints,
                         reconstruction::Inputs& inputs) {
  constexpr double kRoundS = 1e-9;
  if (now_s_ >= next_s_ - kRoundS) {
    exposed_ = skeleton_.Expose(at);
    on_their_way_.push_back({now_s_, exposed_});
    next_s_ += KinectErrors::kPeriodS;
  }
  while (!on_their_way_.empty() &&
         on_their_way_.front().exposed_s + KinectErrors::kLateS <= now_s_ + kRoundS) {
    const Sample& sample = on_their_way_.front();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].Add(sample.exposed_s, sample.points[i].p_W_m,
                     Eigen::Vector3d::Constant(sample.points[i].sd_m));
    }
    on_their_way_.pop_front();
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const reconstruction::PointInput point = tracks_[i].At(now_s_);
    if (i < KinectSkeleton::kHands) {
      inputs.hands[i] = point;
      inputs.hands[i].of_skeleton = with_joints;
    } else if (with_joints) {
      inputs.joints[i - KinectSkeleton::kHands] = point;
    }
  }
  now_s_ += step_s_;
}

}  // namespace footing::pose_run
