#include "daemon/simulation/pose_service/pose_arms.h"

#include <algorithm>
#include <utility>

#include "common/body/held_frame.h"
#include "common/units/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

constexpr double kLongestStepS = 0.1;  // Between two ticks.

bool IsOld(std::int64_t seen_ns, std::int64_t now_ns) {
  return NanosecondsToSeconds(now_ns - seen_ns) > PoseArms::kTimeoutS;
}

}  // namespace

PoseArms::PoseArms(std::optional<arms::ArmModel> model) : model_(std::move(model)) {
  if (model_) tracker_.emplace(*model_);
}

void PoseArms::Bind(std::size_t side, std::optional<std::uint32_t> device) {
  Hand& hand = hands_[side];
  if (hand.device == device) return;
  hand = {};
  hand.device = device;
  if (tracker_) tracker_->Lose(side);
}

void PoseArms::Take(const v1::MotionSample& sample, std::int64_t now_ns) {
  for (std::size_t side = 0; side < hands_.size(); ++side) {
    Hand& hand = hands_[side];
    if (hand.device != sample.device()) continue;
    hand.seen = true;
    hand.seen_ns = now_ns;
    hand.simulated = sample.simulated();
    if (!tracker_ || !sample.has_angular_velocity_radps()) continue;
    const double step_s = NanosecondsToSeconds(sample.sampled_ns() - hand.sampled_ns);
    const bool first = !hand.turns;
    if (!first && step_s <= 0) continue;
    hand.turns = true;
    hand.turned_ns = now_ns;
    hand.sampled_ns = sample.sampled_ns();
    if (first || step_s > kTimeoutS) {
      tracker_->Lose(side);
      continue;
    }
    const Eigen::Vector3d turn_S = wire::FromProto(sample.angular_velocity_radps()) +
                                   wire::FromProto(sample.gyroscope_bias_radps());
    tracker_->Add(side,
                  {body::AsHeld(wire::FromProto(sample.specific_force_mps2())),
                   body::AsHeld(turn_S), sample.clipped_axes() != 0},
                  step_s);
  }
}

void PoseArms::Follow(bool calibrated, double calibration_progress) {
  const bool was_calibrated = std::exchange(calibrated_, calibrated);
  const double before = std::exchange(progress_, calibration_progress);
  if (!tracker_) return;
  if (calibrated && !was_calibrated) {
    tracker_->Align();
  } else if (!calibrated && was_calibrated) {
    tracker_.emplace(*model_);
  } else if (!calibrated && (calibration_progress <= 0 || calibration_progress < before)) {
    tracker_->BeginTPose();
  }
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::int64_t now_ns) const {
  const Hand& hand = hands_[side];
  if (!hand.device) return HandTrouble::kNone;
  if (!tracker_) return HandTrouble::kNoModel;
  if (!hand.seen || IsOld(hand.seen_ns, now_ns)) return HandTrouble::kSilent;
  if (!hand.turns || IsOld(hand.turned_ns, now_ns)) return HandTrouble::kNoGyroscope;
  return calibrated_ && !tracker_->hand(side).valid ? HandTrouble::kAwaitsTPose
                                                    : HandTrouble::kNone;
}

void PoseArms::Report(std::int64_t now_ns, PoseInputs& inputs) {
  const double step_s = std::clamp(NanosecondsToSeconds(now_ns - reported_ns_), 0.0, kLongestStepS);
  reported_ns_ = now_ns;
  if (tracker_) inputs.sensors.arms = tracker_->Advance(step_s);
  for (std::size_t side = 0; side < hands_.size(); ++side) {
    const HandTrouble trouble = TroubleOf(side, now_ns);
    inputs.hand_trouble[side] = trouble;
    bool& valid = inputs.sensors.arms[side].valid;
    valid = valid && hands_[side].device && trouble == HandTrouble::kNone;
    inputs.simulated |= valid && hands_[side].simulated;
  }
}

}  // namespace footing::pose_service
