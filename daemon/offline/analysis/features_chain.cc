#include "daemon/offline/analysis/features_chain.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::eval {
namespace {

std::vector<features::Member> Members(bool with_right) {
  std::vector<features::Member> members = {{kLeftDevice, stream::DeviceRole::kLeftHand}};
  if (with_right) members.push_back({kRightDevice, stream::DeviceRole::kRightHand});
  return members;
}

}  // namespace

Chain::Chain(const std::vector<features::Member>& members, const features::Config& config)
    : rig_("eval", members, config) {
  for (const features::Member& member : members) last_.emplace_back().device = member.device;
}

Chain::Chain(bool with_right, const features::Config& config)
    : Chain(Members(with_right), config) {}

void Chain::Add(std::uint32_t device, std::int64_t sampled_ns,
                const Eigen::Vector3d& specific_force_mps2, std::uint32_t clipped_axes) {
  Last& last = *std::find_if(last_.begin(), last_.end(),
                             [=](const Last& known) { return known.device == device; });
  stream::MotionSample sample;
  sample.device = device;
  sample.sampled_ns = sample.received_ns = sampled_ns;
  sample.specific_force_mps2 = specific_force_mps2;
  sample.filtered_mps2 = last.filter.Advance(sampled_ns, specific_force_mps2);
  sample.clipped_axes = clipped_axes;
  sample.repeated = last.any && last.specific_force_mps2 == specific_force_mps2;
  last.any = true;
  last.specific_force_mps2 = specific_force_mps2;
  rig_.AddSample(sample);
}

std::vector<Tick> Run(const std::vector<wrists::TimedReading>& readings,
                      const features::Config& config) {
  Chain chain(true, config);
  std::vector<Tick> ticks;
  ticks.reserve(readings.size());
  for (const auto& reading : readings) {
    chain.Add(kLeftDevice, reading.sampled_ns, reading.left.specific_force_mps2,
              reading.left.clipped_axes);
    chain.Add(kRightDevice, reading.sampled_ns, reading.right.specific_force_mps2,
              reading.right.clipped_axes);
    ticks.push_back({NanosecondsToSeconds(reading.sampled_ns), chain.Compute(reading.sampled_ns)});
  }
  return ticks;
}

}  // namespace footing::eval
