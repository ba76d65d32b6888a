#include "daemon/simulation/pose/arm_tracker.h"

#include <numbers>

namespace footing::arms {
namespace {

/// Before any reading. A strapped device points along the arm, which a T-pose has to its side.
HandAttitude Unaligned(std::size_t arm, Place place) {
  if (place == Place::kFist) return HandAttitude();
  return HandAttitude((arm == 0 ? 0.5 : -0.5) * std::numbers::pi);
}

}  // namespace

ArmTracker::ArmTracker(const std::optional<ArmModel>& model) : model_(model) {
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    for (const Place place : {Place::kFist, Place::kUpperArm, Place::kForearm}) Lose(arm, place);
  }
  estimates_[1].directions = Mirrored(estimates_[1].directions);
}

void ArmTracker::Add(std::size_t arm, const HandReading& reading, double step_s, Place place) {
  devices_[arm][static_cast<std::size_t>(place)].Advance(reading, step_s);
}

void ArmTracker::BeginTPose() {
  for (auto& devices : devices_) {
    for (HandAttitude& device : devices) device.BeginTPose();
  }
}

void ArmTracker::Lose(std::size_t arm, Place place) {
  devices_[arm][static_cast<std::size_t>(place)] = Unaligned(arm, place);
}

void ArmTracker::Align() {
  for (auto& devices : devices_) {
    for (HandAttitude& device : devices) device.Align();
  }
  features_ = {};
}

HandState ArmTracker::StateOf(std::size_t arm, Place place, const Heard& heard) const {
  HandState state = hand(arm, place);
  state.valid = state.valid && heard[arm][static_cast<std::size_t>(place)];
  return state;
}

ArmEstimate ArmTracker::Estimate(std::size_t arm, const Heard& heard) {
  const SegmentStates segments{StateOf(arm, Place::kUpperArm, heard),
                               StateOf(arm, Place::kForearm, heard)};
  const HandState fist = StateOf(arm, Place::kFist, heard);
  ArmEstimate estimate = estimates_[arm];
  estimate.valid = true;
  if (model_ && fist.valid) {
    features_.Compute(arm, values_);
    const bool other_known = StateOf(1 - arm, Place::kFist, heard).valid;
    ArmBelief belief = RegressedArm(arm, *model_, model_->Predict(values_, other_known), fist);
    Measure(arm, segments, belief);
    estimate = ToEstimate(belief);
    estimate.valid = true;
  } else if (segments[0].valid && segments[1].valid) {
    estimate = ToEstimate(StrappedArm(arm, segments));
    estimate.valid = true;
  } else {
    estimate.valid = false;
  }
  return estimate;
}

const std::array<ArmEstimate, kArms>& ArmTracker::Advance(double step_s, const Heard& heard) {
  const bool any = hand(0).valid || hand(1).valid;
  if (any) features_.Advance({hand(0), hand(1)}, step_s);
  for (std::size_t arm = 0; arm < kArms; ++arm) estimates_[arm] = Estimate(arm, heard);
  return estimates_;
}

}  // namespace footing::arms
