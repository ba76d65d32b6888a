#include "daemon/simulation/pose_service/pose_arms.h"

#include <algorithm>
#include <utility>

#include "common/body/held_frame.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

constexpr double kLongestStepS = 0.1;  // Between two ticks.

bool IsOld(std::int64_t seen_ns, std::int64_t now_ns) {
  return NanosecondsToSeconds(now_ns - seen_ns) > PoseArms::kTimeoutS;
}

}  // namespace

PoseArms::PoseArms(std::optional<arms::ArmModel> model)
    : model_(std::move(model)), tracker_(model_) {}

void PoseArms::Bind(std::size_t side, std::optional<std::uint32_t> device, arms::Place place) {
  Device& bound = devices_[side][static_cast<std::size_t>(place)];
  if (bound.device == device) return;
  bound = {};
  bound.device = device;
  tracker_.Lose(side, place);
}

void PoseArms::Take(const v1::MotionSample& sample, std::int64_t now_ns) {
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) Take(sample, now_ns, side, place);
  }
}

void PoseArms::Take(const v1::MotionSample& sample, std::int64_t now_ns, std::size_t side,
                    std::size_t place) {
  Device& device = devices_[side][place];
  if (device.device != sample.device()) return;
  device.seen = true;
  device.seen_ns = now_ns;
  device.simulated = sample.simulated();
  if (!sample.has_angular_velocity_radps()) return;
  const double step_s = NanosecondsToSeconds(sample.sampled_ns() - device.sampled_ns);
  const bool first = !device.turns;
  if (!first && step_s <= 0) return;
  device.turns = true;
  device.turned_ns = now_ns;
  device.sampled_ns = sample.sampled_ns();
  const auto where = static_cast<arms::Place>(place);
  if (first || step_s > kTimeoutS) {
    tracker_.Lose(side, where);
    return;
  }
  const Eigen::Vector3d turn_S = wire::FromProto(sample.angular_velocity_radps()) +
                                 wire::FromProto(sample.gyroscope_bias_radps());
  tracker_.Add(side,
               {body::AsHeld(wire::FromProto(sample.specific_force_mps2())), body::AsHeld(turn_S),
                sample.clipped_axes() != 0},
               step_s, where);
}

void PoseArms::Follow(bool calibrated, double calibration_progress) {
  const bool was_calibrated = std::exchange(calibrated_, calibrated);
  const double before = std::exchange(progress_, calibration_progress);
  if (calibrated && !was_calibrated) {
    tracker_.Align();
  } else if (!calibrated && was_calibrated) {
    tracker_ = arms::ArmTracker(model_);
  } else if (!calibrated && (calibration_progress <= 0 || calibration_progress < before)) {
    tracker_.BeginTPose();
  }
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::size_t place, std::int64_t now_ns) const {
  const Device& device = devices_[side][place];
  if (!device.seen || IsOld(device.seen_ns, now_ns)) return HandTrouble::kSilent;
  if (!device.turns || IsOld(device.turned_ns, now_ns)) return HandTrouble::kNoGyroscope;
  return calibrated_ && !tracker_.hand(side, static_cast<arms::Place>(place)).valid
             ? HandTrouble::kAwaitsTPose
             : HandTrouble::kNone;
}

HandTrouble PoseArms::TroubleOf(std::size_t side, std::int64_t now_ns) const {
  const auto& devices = devices_[side];
  const auto fist = static_cast<std::size_t>(arms::Place::kFist);
  const auto upper = static_cast<std::size_t>(arms::Place::kUpperArm);
  const auto forearm = static_cast<std::size_t>(arms::Place::kForearm);
  HandTrouble trouble = HandTrouble::kNone;
  if (devices[fist].device) {
    trouble = model_ ? TroubleOf(side, fist, now_ns) : HandTrouble::kNoModel;
    if (trouble == HandTrouble::kNone) return trouble;
  }
  if (!devices[upper].device && !devices[forearm].device) return trouble;
  if (!devices[upper].device || !devices[forearm].device) {
    return trouble == HandTrouble::kNone ? HandTrouble::kOneStrap : trouble;
  }
  const HandTrouble of_upper = TroubleOf(side, upper, now_ns);
  return of_upper != HandTrouble::kNone ? of_upper : TroubleOf(side, forearm, now_ns);
}

void PoseArms::Report(std::int64_t now_ns, PoseInputs& inputs) {
  const double step_s = std::clamp(NanosecondsToSeconds(now_ns - reported_ns_), 0.0, kLongestStepS);
  reported_ns_ = now_ns;
  arms::Heard heard;
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      heard[side][place] = devices_[side][place].device.has_value() &&
                           TroubleOf(side, place, now_ns) == HandTrouble::kNone;
    }
  }
  inputs.sensors.arms = tracker_.Advance(step_s, heard);
  for (std::size_t side = 0; side < devices_.size(); ++side) {
    inputs.hand_trouble[side] = TroubleOf(side, now_ns);
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      inputs.simulated |=
          inputs.sensors.arms[side].valid && heard[side][place] && devices_[side][place].simulated;
    }
  }
}

}  // namespace footing::pose_service
