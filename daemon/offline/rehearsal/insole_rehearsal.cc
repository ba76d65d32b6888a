#include "daemon/offline/rehearsal/insole_rehearsal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/motion/edit.h"
#include "common/synthetic/random.h"
#include "common/units/units.h"
#include "common/virtual_sensors/insole_cells.h"
#include "common/virtual_sensors/scene.h"

namespace footing::rehearsal {
namespace {

namespace sensors = virtual_sensors;

}  // namespace

Result<InsoleRehearsal> RehearseInsoles(const motion::Motion& clip, const Settings& settings,
                                        const std::string& origin) {
  auto kept = motion::WithLandmarksOnly(clip);
  if (!kept) return InvalidData(origin + ": " + kept.error().message);
  body::PersonParameters person;
  person.mass_kg = settings.mass_kg;
  person.height_m = settings.height_m;
  sensors::SceneOptions stage;
  stage.hold_s = kStandS;
  stage.rest_share = momentum::FootShape{}.rest_share;
  stage.loop_s = settings.loop_s;
  const auto scene = sensors::MakeScene(std::move(kept).value(), person, stage, origin);
  if (!scene) return scene.error();

  InsoleRehearsal rehearsal;
  rehearsal.body = scene->body;
  rehearsal.rate_hz = settings.rate_hz;
  std::array<std::array<Eigen::Vector2d, sensors::kInsoleCells>, sensors::kFeet> places;
  std::array<double, sensors::kFeet> rest_m{};
  for (std::size_t f = 0; f < places.size(); ++f) {
    const double length_m = sensors::PlaceOfSole(scene->course, f, 0).length_m;
    places[f] = sensors::InsolePlaces(length_m);
    rest_m[f] = stage.rest_share * length_m;
  }
  synthetic::Random random(settings.seed);
  const double noise_n = KilogramsToNewtons(settings.errors.noise_kg);
  body::Kinematics at(scene->body.skeleton);
  const auto count = static_cast<std::size_t>(scene->motion.duration_s() * settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i) / settings.rate_hz;
    const auto column = std::min<Eigen::Index>(
        static_cast<Eigen::Index>(std::lround(time_s * scene->motion.rate_hz)),
        scene->motion.frames() - 1);
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
        foot.p_F_m[k] = places[f][k] - Eigen::Vector2d(rest_m[f], 0);
        foot.load_n[k] = loads[k] + noise_n * random.Normal();
      }
    }
    if (settings.hands) {
      body::ComputeKinematics(scene->body.skeleton, frame.q, at);
      MeasureHands(scene->body, at, settings.hand_noise_m, random, frame.inputs.hands);
    }
    rehearsal.frames.push_back(std::move(frame));
  }
  return rehearsal;
}

}  // namespace footing::rehearsal
