#include "daemon/sensor/features/rig_features.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/result.h"

namespace footing::features {
namespace {

constexpr std::size_t kMostMembers = 8;
/// A period that differs by more than this share is another one.
constexpr double kShownShare = 0.25;

/// Whether the newest samples of the controller show about that period, so that it is not merely
/// held.
bool Shows(const DeviceFeatureExtractor& device, double period_s) {
  const PeriodEstimate& estimate = device.estimate();
  return estimate.found && std::abs(estimate.period_s - period_s) <= kShownShare * period_s;
}

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

double RigFeatureExtractor::CommonPeriod(const stream::DeviceFeatures& left,
                                         const stream::DeviceFeatures& right, double elapsed_s,
                                         Pair& pair) const {
  if (!left.frequency_valid || !right.frequency_valid) return 0;
  const double left_s = 1 / left.frequency_hz;
  const double right_s = 1 / right.frequency_hz;
  const double known_s = pair.period_s;
  const bool agree =
      std::abs(left_s - right_s) <= config_.phase.agree_share * std::max(left_s, right_s);
  pair.disagree_s = agree ? 0 : pair.disagree_s + elapsed_s;
  const bool known = known_s > 0;
  if (!agree && (!known || pair.disagree_s > config_.phase.disagree_cycles * known_s)) return 0;
  // A hand whose phase jumps shows a wrong period for a moment; the other one keeps the known one.
  if (known && std::abs(left_s - right_s) > 0.1 * known_s) {
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
  const DeviceFeatureExtractor &one = devices_[pair.left], &other = devices_[pair.right];
  const double elapsed_s = kGridStepS * static_cast<double>(steps);
  const bool rests = !left.moving && !right.moving;
  if (rests || (left.moving && right.moving)) {
    pair.grip =
        Next(pair.grip, one.gravity_mps2(), other.gravity_mps2(), rests, elapsed_s, config_.grip);
  }
  if (!left.moving || !right.moving) {
    pair.phase = {};
    pair.together = {};
    pair.period_s = pair.disagree_s = 0;
  } else {
    const double period_s = CommonPeriod(left, right, elapsed_s, pair);
    const Eigen::Matrix3d from_right = pair.grip.FromRight();
    // While both periods are merely held, the newest cycle is none of theirs.
    const bool shown = period_s > 0 && (Shows(one, period_s) || Shows(other, period_s));
    const PhaseEstimate estimate =
        shown ? FindPhase(one.grid(), other.grid(), period_s, from_right, one.swing_end(),
                          other.swing_end(), config_.phase, config_.cycle)
              : PhaseEstimate{};
    if (period_s > 0) pair.period_s = period_s;
    pair.phase = Next(pair.phase, estimate, pair.period_s, elapsed_s, config_.phase);
    const bool seen = estimate.found && !pair.phase.jumping;
    pair.together = seen || pair.period_s == 0 ? Together{}
                                               : Next(pair.together, one.grid(), other.grid(),
                                                      from_right, elapsed_s, config_.phase);
    if (pair.together.sure) pair.phase = {.valid = true};
  }
  const Phase& phase = pair.phase;
  return {left.device, right.device, phase.valid, phase.valid ? phase.phase_rad : 0.0,
          phase.valid && (phase.lost_s > 0 || phase.jumping)};
}

std::vector<Partner> RigFeatureExtractor::Partners() const {
  std::vector<Partner> partners(devices_.size());
  for (const auto& pair : pairs_) {
    partners[pair.left] = devices_[pair.right].AsPartner();
    partners[pair.right] = devices_[pair.left].AsPartner();
  }
  return partners;
}

stream::RigFeatures RigFeatureExtractor::Compute(std::int64_t now_ns) {
  stream::RigFeatures features;
  features.rig = rig_;
  features.computed_ns = now_ns;
  std::vector<Partner> partners = Partners();
  for (std::size_t i = 0; i < devices_.size(); ++i) devices_[i].Observe(now_ns, partners[i]);
  partners = Partners();
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    DeviceFeatureExtractor& device = devices_[i];
    features.devices.push_back(device.Compute(partners[i]));
    features.newest_received_ns =
        std::max(features.newest_received_ns, device.newest_received_ns());
  }
  for (auto& pair : pairs_) {
    features.pairs.push_back(ComputePair(pair, features.devices));
    if (!pair.together.sure) continue;
    for (const std::size_t i : {pair.left, pair.right}) {  // Only that of the motion before.
      features.devices[i].frequency_valid = false;
      features.devices[i].frequency_hz = 0;
    }
  }
  return features;
}

}  // namespace footing::features
