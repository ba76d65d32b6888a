#include "daemon/offline/rehearsal/kinect_hands.h"

#include <cmath>

namespace footing::rehearsal {

KinectHands::KinectHands(std::uint64_t seed, double step_s) : random_(seed), step_s_(step_s) {
  for (double& value : offset_m_) value = kOffsetM * random_.Normal();
}

KinectHands::Hands KinectHands::Measure(const Hands& truth) {
  const double kept = std::exp(-kPeriodS / kOffsetChangesS);
  for (double& value : offset_m_) {
    value = kept * value + std::sqrt(1 - kept * kept) * kOffsetM * random_.Normal();
  }
  Hands hands = truth;
  for (reconstruction::HandInput& hand : hands) {
    hand.p_W_m += offset_m_;
    for (double& value : hand.p_W_m) value += kNoiseM * random_.Normal();
    hand.sd_m.setConstant(std::hypot(kNoiseM, kOffsetM));
  }
  return hands;
}

KinectHands::Hands KinectHands::Advance(const Hands& truth) {
  constexpr double kRoundS = 1e-9;
  if (now_s_ >= next_s_ - kRoundS) {
    on_their_way_.push_back({now_s_ + kLateS, Measure(truth)});
    next_s_ += kPeriodS;
  }
  while (!on_their_way_.empty() && on_their_way_.front().arrives_s <= now_s_ + kRoundS) {
    told_ = on_their_way_.front().hands;
    on_their_way_.pop_front();
  }
  now_s_ += step_s_;
  return told_;
}

}  // namespace footing::rehearsal
