#include "daemon/sensor/features/rig_features.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/result/result.h"

namespace footing::features {
namespace {

constexpr std::size_t kMostMembers = 8;

}  // namespace

RigFeatureExtractor::RigFeatureExtractor(std::string rig, const std::vector<Member>& members,
                                         const Config& config)
    : rig_(std::move(rig)), config_(config) {
  FOOTING_CHECK(members.size() <= kMostMembers);
  for (const Member& member : members) {
    FOOTING_CHECK(member.role != stream::DeviceRole::kLeftBoard &&
                  member.role != stream::DeviceRole::kRightBoard);
    devices_.emplace_back(member.device, member.role, config);
  }
  AddPair(stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand);
  AddPair(stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg);
}

void RigFeatureExtractor::AddPair(stream::DeviceRole left, stream::DeviceRole right) {
  const auto with = [this](stream::DeviceRole role) {
    return std::find_if(devices_.begin(), devices_.end(),
                        [role](const auto& device) { return device.role() == role; });
  };
  if (with(left) == devices_.end() || with(right) == devices_.end()) return;
  Pair pair;
  pair.left = static_cast<std::size_t>(with(left) - devices_.begin());
  pair.right = static_cast<std::size_t>(with(right) - devices_.begin());
  pairs_.push_back(pair);
}

void RigFeatureExtractor::AddSample(const stream::MotionSample& sample) {
  for (auto& device : devices_) {
    if (device.device() == sample.device) device.AddSample(sample);
  }
}

double RigFeatureExtractor::CommonPeriod(double known_s, const stream::DeviceFeatures& left,
                                         const stream::DeviceFeatures& right) {
  if (!left.frequency_valid && !right.frequency_valid) return 0;
  if (!left.frequency_valid) return 1 / right.frequency_hz;
  if (!right.frequency_valid) return 1 / left.frequency_hz;
  const double left_s = 1 / left.frequency_hz;
  const double right_s = 1 / right.frequency_hz;
  // A hand whose phase jumps shows a wrong period for a moment; the other one keeps the known one.
  if (known_s > 0 && std::abs(left_s - right_s) > 0.1 * known_s) {
    return std::abs(left_s - known_s) <= std::abs(right_s - known_s) ? left_s : right_s;
  }
  return 0.5 * (left_s + right_s);
}

stream::PairFeatures RigFeatureExtractor::ComputePair(
    Pair& pair, const std::vector<stream::DeviceFeatures>& devices) {
  const auto& left = devices[pair.left];
  const auto& right = devices[pair.right];
  const std::int64_t index = std::min(devices_[pair.left].grid().newest_index(),
                                      devices_[pair.right].grid().newest_index());
  const std::int64_t steps = std::clamp<std::int64_t>(index - pair.computed_index, 0, kGridLength);
  pair.computed_index = index;
  if (!left.moving || !right.moving) {
    pair.phase = {};
    pair.period_s = 0;
  } else {
    const double period_s = CommonPeriod(pair.period_s, left, right);
    const PhaseEstimate estimate =
        period_s > 0 ? FindPhase(devices_[pair.left].grid(), devices_[pair.right].grid(), period_s,
                                 config_.phase)
                     : PhaseEstimate{};
    if (period_s > 0) pair.period_s = period_s;
    pair.phase = Next(pair.phase, estimate, pair.period_s, kGridStepS * static_cast<double>(steps),
                      config_.phase);
  }
  return {left.device, right.device, pair.phase.valid,
          pair.phase.valid ? pair.phase.phase_rad : 0.0};
}

stream::RigFeatures RigFeatureExtractor::Compute(std::int64_t now_ns) {
  stream::RigFeatures features;
  features.rig = rig_;
  features.computed_ns = now_ns;
  std::vector<PeriodEstimate> partners(devices_.size());
  for (auto& device : devices_) device.Observe(now_ns);
  for (const auto& pair : pairs_) {
    partners[pair.left] = devices_[pair.right].estimate();
    partners[pair.right] = devices_[pair.left].estimate();
  }
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    DeviceFeatureExtractor& device = devices_[i];
    features.devices.push_back(device.Compute(partners[i]));
    features.newest_received_ns =
        std::max(features.newest_received_ns, device.newest_received_ns());
  }
  for (auto& pair : pairs_) features.pairs.push_back(ComputePair(pair, features.devices));
  return features;
}

}  // namespace footing::features
