#include "daemon/offline/rehearsal/held_hands.h"

#include <utility>

#include "daemon/offline/rehearsal/stage.h"
#include "daemon/simulation/arms/arm_tracker.h"

namespace footing::rehearsal {

namespace sensors = virtual_sensors;

HeldHands::HeldHands(const sensors::Scene& scene, std::uint64_t seed)
    : courses_{sensors::FollowFist(scene.body, scene.motion, 0),
               sensors::FollowFist(scene.body, scene.motion, 1)},
      step_s_(1 / scene.motion.rate_hz) {
  for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
    sensors::HeldErrorConfig config;
    config.seed = 2 * seed + arm;
    errors_.emplace_back(config);
  }
}

std::array<std::vector<arms::HandReading>, arms::kArms> HeldHands::Until(Eigen::Index column) {
  std::array<std::vector<arms::HandReading>, arms::kArms> readings;
  for (; next_ <= column; ++next_) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      const auto told =
          errors_[arm].Advance(courses_[arm].specific_force_S_mps2.col(next_),
                               courses_[arm].angular_velocity_S_radps.col(next_), step_s_);
      readings[arm].push_back(
          {told.specific_force_S_mps2, told.angular_velocity_S_radps, told.clipped});
    }
  }
  return readings;
}

void TellArms(const arms::ArmModel& model, Rehearsal& rehearsal) {
  arms::ArmTracker tracker(model);
  const auto aligned = static_cast<std::size_t>(kAlignedS * rehearsal.rate_hz);
  for (std::size_t i = 0; i < rehearsal.frames.size(); ++i) {
    Frame& frame = rehearsal.frames[i];
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const arms::HandReading& reading : frame.readings[arm]) {
        tracker.Add(arm, reading, rehearsal.reading_s);
      }
    }
    if (i == aligned) tracker.Align();
    frame.inputs.arms = tracker.Advance(1 / rehearsal.rate_hz);
  }
}

Result<ArmRehearsal> RehearseArms(const motion::Motion& clip, const Settings& settings,
                                  const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  ArmRehearsal rehearsal;
  rehearsal.body = scene->body;
  rehearsal.rate_hz = settings.rate_hz;
  rehearsal.aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  HeldHands hands(*scene, settings.seed);
  rehearsal.reading_s = hands.step_s();
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = ColumnAt(*scene, static_cast<double>(i) / settings.rate_hz);
    rehearsal.frames.push_back({hands.Until(column), scene->motion.q.col(column)});
  }
  return rehearsal;
}

}  // namespace footing::rehearsal
