#include "daemon/simulation/arms/arm_tracker.h"

namespace footing::arms {

ArmTracker::ArmTracker(const ArmModel& model) : model_(model) {
  const Directions sd = model.covariance.diagonal().cwiseSqrt();
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    ArmEstimate& estimate = estimates_[arm];
    estimate.upper_sd = sd.segment<3>(0);
    estimate.hinge_sd = sd.segment<3>(3);
    estimate.forearm_sd = sd.segment<3>(6);
    if (arm == 1) estimate.directions = Mirrored(estimate.directions);
  }
}

void ArmTracker::Add(std::size_t arm, const HandReading& reading, double step_s) {
  hands_[arm].Advance(reading, step_s);
}

void ArmTracker::BeginTPose() {
  for (HandAttitude& hand : hands_) hand.BeginTPose();
}

void ArmTracker::Lose(std::size_t arm) { hands_[arm] = {}; }

void ArmTracker::Align() {
  for (HandAttitude& hand : hands_) hand.Align();
  features_ = {};
}

const std::array<ArmEstimate, kArms>& ArmTracker::Advance(double step_s) {
  const bool any = hands_[0].state().valid || hands_[1].state().valid;
  if (any) features_.Advance({hands_[0].state(), hands_[1].state()}, step_s);
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    estimates_[arm].valid = hands_[arm].state().valid;
    if (!estimates_[arm].valid) continue;
    features_.Compute(arm, values_);
    const ArmDirections predicted = Of(model_.Predict(values_, hands_[1 - arm].state().valid));
    estimates_[arm].directions = arm == 1 ? Mirrored(predicted) : predicted;
  }
  return estimates_;
}

}  // namespace footing::arms
