#include "daemon/offline/pose_run/insole_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/insole_cells.h"
#include "daemon/offline/pose_run/stage.h"

namespace footing::pose_run {

namespace sensors = virtual_sensors;

Result<InsoleRun> RunInsoles(const motion::Motion& clip, const Settings& settings,
                             const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();

  InsoleRun run;
  run.body = scene->body;
  run.rate_hz = settings.rate_hz;
  std::array<std::array<Eigen::Vector2d, sensors::kInsoleCells>, sensors::kFeet> places;
  for (std::size_t f = 0; f < places.size(); ++f) {
    const double length_m = sensors::PlaceOfSole(scene->course, f, 0).length_m;
    places[f] = sensors::InsolePlaces(length_m);
  }
  noise::Random random(settings.seed);
  const double noise_n = KilogramsToNewtons(settings.errors.noise_kg);
  body::Kinematics at(scene->body.skeleton);
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i) / settings.rate_hz;
    const Eigen::Index column = ColumnAt(*scene, time_s);
    InsoleFrame frame;
    frame.inputs.time_s = time_s;
    frame.q = scene->motion.q.col(column);
    const auto forces = sensors::ShareBetweenFeet(scene->course, scene->reaction, column);
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto loads =
          sensors::LoadInsole(places[f], sensors::PlaceOfSole(scene->course, f, column), forces[f]);
      frame.load_n[f] = forces[f].load_n;
      reconstruction::InsoleFoot& foot = frame.inputs.feet[f];
      foot.valid = true;
      foot.count = loads.size();
      for (std::size_t k = 0; k < loads.size(); ++k) {
        foot.p_S_m[k] = places[f][k];
        foot.load_n[k] = loads[k] + noise_n * random.Normal();
      }
    }
    if (settings.hands) {
      body::ComputeKinematics(scene->body.skeleton, frame.q, at);
      MeasureHands(scene->body, at, settings.hand_noise_m, random, frame.inputs.hands);
    }
    run.frames.push_back(std::move(frame));
  }
  return run;
}

}  // namespace footing::pose_run
