#include "daemon/offline/pose_run/held_hands.h"

#include <utility>

#include "daemon/offline/pose_run/stage.h"
#include "daemon/simulation/pose/arm_tracker.h"

namespace footing::pose_run {

namespace sensors = virtual_sensors;

namespace {

/// Of a Wiimote in a fist, or strapped.
sensors::HeldErrorConfig ErrorsOf(arms::Place place, const Settings& settings) {
  sensors::HeldErrorConfig config;
  if (settings.perfect_devices) config = sensors::HeldErrors::None();
  config.rolled = !settings.perfect_devices && place != arms::Place::kFist;
  return config;
}

sensors::HeldCourse CourseOf(const sensors::Scene& scene, std::size_t arm, arms::Place place) {
  const int side = static_cast<int>(arm);
  if (place == arms::Place::kFist) return sensors::FollowFist(scene.body, scene.motion, side);
  return sensors::FollowSegment(scene.body, scene.motion, side,
                                place == arms::Place::kUpperArm ? sensors::ArmSegment::kUpperArm
                                                                : sensors::ArmSegment::kForearm);
}

}  // namespace

HeldHands::HeldHands(const sensors::Scene& scene, const Places& places, const Settings& settings)
    : step_s_(1 / scene.motion.rate_hz) {
  for (std::size_t place = 0; place < arms::kPlaces; ++place) {
    for (std::size_t arm = 0; places[place] && arm < arms::kArms; ++arm) {
      const auto where = static_cast<arms::Place>(place);
      sensors::HeldErrorConfig config = ErrorsOf(where, settings);
      config.seed = 2 * settings.seed + arm + 7919 * place;
      devices_.push_back({arm, place, CourseOf(scene, arm, where), sensors::HeldErrors(config)});
    }
  }
}

ArmReadings HeldHands::Until(Eigen::Index column) {
  ArmReadings readings;
  for (; next_ <= column; ++next_) {
    for (Device& device : devices_) {
      const auto reading =
          device.errors.Advance(device.course.specific_force_S_mps2.col(next_),
                                device.course.angular_velocity_S_radps.col(next_), step_s_);
      readings[device.arm][device.place].push_back(
          {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped});
    }
  }
  return readings;
}

void Feed(const ArmReadings& readings, double reading_s, arms::ArmTracker& tracker) {
  for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      for (const arms::HandReading& reading : readings[arm][place]) {
        tracker.Add(arm, reading, reading_s, static_cast<arms::Place>(place));
      }
    }
  }
}

void EstimateArms(const std::optional<arms::ArmModel>& model, PoseRun& run) {
  arms::ArmTracker tracker(model);
  const auto aligned = static_cast<std::size_t>(kAlignedS * run.rate_hz);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    Frame& frame = run.frames[i];
    Feed(frame.readings, run.reading_s, tracker);
    if (i == aligned) tracker.Align();
    frame.inputs.arms = tracker.Advance(1 / run.rate_hz);
  }
}

Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin, const Places& places) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  ArmRun run;
  run.body = scene->body;
  run.rate_hz = settings.rate_hz;
  run.aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  HeldHands hands(*scene, places, settings);
  run.reading_s = hands.step_s();
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = ColumnAt(*scene, static_cast<double>(i) / settings.rate_hz);
    run.frames.push_back({hands.Until(column), scene->motion.q.col(column)});
  }
  return run;
}

}  // namespace footing::pose_run
