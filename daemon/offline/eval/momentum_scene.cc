#include "daemon/offline/eval/momentum_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/virtual/options/load.h"
#include "common/virtual/devices/scene.h"

namespace footing::eval {
namespace {

namespace sensors = virtual_sensors;

double YawOf(const sensors::BodyCourse& course, std::size_t foot) {
  const Eigen::Vector3d ahead = course.sole_m[foot][2].col(0) + course.sole_m[foot][3].col(0) -
                                course.sole_m[foot][0].col(0) - course.sole_m[foot][1].col(0);
  return std::atan2(ahead.y(), ahead.x());
}

/// The clip after the person has stood still.
Result<sensors::Scene> Load(const MomentumOptions& options) {
  auto read = motion_files::LoadMotion(
      options.motion, {.skeleton = options.skeleton, .bvh_unit_m = options.bvh_unit_m});
  if (!read) return read.error();
  body::PersonParameters person;
  person.mass_kg = options.mass_kg;
  person.height_m = read->height_m;
  sensors::SceneOptions clip;
  clip.hold_s = kCalibrationS;
  clip.rest_share = momentum::FootShape{}.rest_share;
  clip.loop_s = 60 * options.loop_minutes;
  return sensors::MakeScene(std::move(read->motion), person, clip, options.motion);
}

}  // namespace

Result<MomentumScene> MakeMomentumScene(const MomentumOptions& options) {
  const auto made = Load(options);
  if (!made) return made.error();
  const motion::Motion& motion = made->motion;
  const sensors::BodyCourse& course = made->course;

  MomentumScene scene;
  scene.rate_hz = options.rate_hz;
  scene.subject.com_height_m = course.com_m(2, 0);
  std::array<sensors::BoardPlace, sensors::kFeet> boards = sensors::SideBySide();
  std::vector<sensors::CellErrors> cells;
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    scene.subject.feet[f].yaw_rad = YawOf(course, f);
    // Each foot begins in its board's middle.
    boards[f].middle_m = sensors::SoleMiddle(course, f, 0).head<2>();
    sensors::CellErrorConfig errors = options.errors;
    errors.seed = 2 * options.errors.seed + f;
    cells.emplace_back(errors);
  }
  const double step_s = 1 / options.rate_hz;
  const auto frames = static_cast<std::size_t>(motion.duration_s() * options.rate_hz);
  std::size_t loaded = 0, outside = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto at = std::min<Eigen::Index>(
        static_cast<Eigen::Index>(std::lround(static_cast<double>(i) * step_s * motion.rate_hz)),
        motion.frames() - 1);
    const auto feet = sensors::ShareBetweenFeet(course, made->reaction, at);
    MomentumFrame frame;
    frame.loads.time_s = static_cast<double>(i) * step_s;
    frame.com_m = course.com_m.col(at);
    frame.angular_momentum = course.angular_momentum.col(at);
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto load = sensors::LoadBoard(boards[f], feet[f], !options.unlimited);
      const auto read_n = cells[f].Advance(load.corners_n, step_s);
      const auto places = sensors::SensorPlaces(boards[f]);
      momentum::FootLoads& foot = frame.loads.feet[f];
      foot.valid = true;
      foot.count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k)
        foot.cells[k] = {{places[k].x(), places[k].y(), 0}, read_n[k]};
      frame.feet[f].load_n = feet[f].load_n;
      frame.feet[f].middle_m = sensors::SoleMiddle(course, f, at);
      if (feet[f].load_n > 20) {
        ++loaded;
        outside += load.outside ? 1 : 0;
      }
    }
    scene.frames.push_back(frame);
  }
  scene.outside_share = loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
  return scene;
}

}  // namespace footing::eval
