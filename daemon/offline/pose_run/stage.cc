#include "daemon/offline/pose_run/stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/virtual/motion/edit.h"

namespace footing::pose_run {

Result<virtual_sensors::Scene> Stage(const motion::Motion& clip, const Settings& settings,
                                     const std::string& origin) {
  auto kept = motion::WithLandmarksOnly(clip);
  if (!kept) return InvalidData(origin + ": " + kept.error().message);
  body::PersonParameters person;
  person.mass_kg = settings.mass_kg;
  person.height_m = settings.height_m;
  virtual_sensors::SceneOptions options;
  options.hold_s = kStandS;
  options.leave_s = kLeaveS;
  options.rest_share = momentum::FootShape{}.rest_share;
  options.loop_s = settings.loop_s;
  return virtual_sensors::MakeScene(std::move(kept).value(), person, options, origin);
}

std::size_t FrameCount(const virtual_sensors::Scene& scene, double rate_hz) {
  return static_cast<std::size_t>(scene.motion.duration_s() * rate_hz);
}

Eigen::Index ColumnAt(const virtual_sensors::Scene& scene, double time_s) {
  return std::min<Eigen::Index>(
      static_cast<Eigen::Index>(std::lround(time_s * scene.motion.rate_hz)),
      scene.motion.frames() - 1);
}

}  // namespace footing::pose_run
