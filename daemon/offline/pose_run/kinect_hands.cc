#include "daemon/offline/pose_run/kinect_hands.h"

namespace footing::pose_run {

using virtual_sensors::KinectErrors;

KinectHands::KinectHands(std::uint64_t seed, double step_s) : errors_(seed), step_s_(step_s) {}

KinectHands::Hands KinectHands::Advance(const Hands& truth) {
  constexpr double kRoundS = 1e-9;
  if (now_s_ >= next_s_ - kRoundS) {
    errors_.Expose();
    Sample sample{now_s_, {}};
    for (std::size_t side = 0; side < truth.size(); ++side) {
      sample.p_W_m[side] = errors_.Measure(truth[side].p_W_m);
    }
    on_their_way_.push_back(sample);
    next_s_ += KinectErrors::kPeriodS;
  }
  while (!on_their_way_.empty() &&
         on_their_way_.front().exposed_s + KinectErrors::kLateS <= now_s_ + kRoundS) {
    const Sample& sample = on_their_way_.front();
    for (std::size_t side = 0; side < tracks_.size(); ++side) {
      tracks_[side].Add(sample.exposed_s, sample.p_W_m[side],
                        Eigen::Vector3d::Constant(KinectErrors::SdM()));
    }
    on_their_way_.pop_front();
  }
  Hands hands;
  for (std::size_t side = 0; side < hands.size(); ++side) hands[side] = tracks_[side].At(now_s_);
  now_s_ += step_s_;
  return hands;
}

}  // namespace footing::pose_run
