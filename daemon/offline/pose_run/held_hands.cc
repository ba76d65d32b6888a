#include "daemon/offline/pose_run/held_hands.h"

#include <utility>

#include "daemon/offline/pose_run/stage.h"
#include "daemon/simulation/arms/arm_tracker.h"

namespace footing::pose_run {

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
      const auto reading =
          errors_[arm].Advance(courses_[arm].specific_force_S_mps2.col(next_),
                               courses_[arm].angular_velocity_S_radps.col(next_), step_s_);
      readings[arm].push_back(
          {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped});
    }
  }
  return readings;
}

void EstimateArms(const arms::ArmModel& model, PoseRun& run) {
  arms::ArmTracker tracker(model);
  const auto aligned = static_cast<std::size_t>(kAlignedS * run.rate_hz);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    Frame& frame = run.frames[i];
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const arms::HandReading& reading : frame.readings[arm]) {
        tracker.Add(arm, reading, run.reading_s);
      }
    }
    if (i == aligned) tracker.Align();
    frame.inputs.arms = tracker.Advance(1 / run.rate_hz);
  }
}

Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  ArmRun run;
  run.body = scene->body;
  run.rate_hz = settings.rate_hz;
  run.aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  HeldHands hands(*scene, settings.seed);
  run.reading_s = hands.step_s();
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = ColumnAt(*scene, static_cast<double>(i) / settings.rate_hz);
    run.frames.push_back({hands.Until(column), scene->motion.q.col(column)});
  }
  return run;
}

}  // namespace footing::pose_run
