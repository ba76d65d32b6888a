#include "daemon/offline/learning/board_loads.h"

#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/ground_reaction.h"
#include "daemon/offline/learning/alignment.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::learning {
namespace {

namespace sensors = virtual_sensors;

/// The point of a sole from its heel's (0) to its ball's (1) middle, a column a frame.
Eigen::Matrix2Xd SolePoint(const std::array<Eigen::Matrix3Xd, sensors::kFootPoints>& sole,
                           double share) {
  return (0.5 * (1 - share) * (sole[0] + sole[1]) + 0.5 * share * (sole[2] + sole[3])).topRows<2>();
}

Eigen::Vector2d Median(const Eigen::Matrix2Xd& points) {
  return {Quantile(points.row(0), 0.5), Quantile(points.row(1), 0.5)};
}

}  // namespace

LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed) {
  if (motion.frames() < 3) return {};
  const sensors::BodyCourse course = sensors::Follow(body, motion);
  const sensors::GroundReaction reaction = sensors::React(course);
  std::array<sensors::BoardPlace, sensors::kFeet> boards = sensors::SideBySide();
  std::vector<sensors::CellErrors> errors;
  Eigen::Matrix2Xd rest = Eigen::Matrix2Xd::Zero(2, course.frames());
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    boards[f].middle_m = Median(SolePoint(course.sole_m[f], 0.5));
    rest += SolePoint(course.sole_m[f], momentum::FootShape{}.rest_share) / sensors::kFeet;
    errors.emplace_back(
        sensors::CellErrorConfig{.noise_kg = settings.noise_kg, .seed = 2 * seed + f});
  }
  const Eigen::Vector2d origin_m = Median(rest);
  const double side = settings.mirrored ? -1 : 1;

  LoadClip clip;
  const double weight_n = KilogramsToNewtons(body.mass_kg);
  const double step_s = 1 / momentum::kNetworkRateHz;
  for (double t_s = 0;; t_s += step_s) {
    const auto at = static_cast<Eigen::Index>(std::lround(t_s * motion.rate_hz));
    if (at >= course.frames()) break;
    const auto feet = sensors::ShareBetweenFeet(course, reaction, at);
    momentum::ContactLoads loads;
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto read_n = errors[f].Advance(
          sensors::LoadBoard(boards[f], feet[f], settings.limited).corners_n, step_s);
      const auto places = sensors::SensorPlaces(boards[f]);
      momentum::FootLoads& foot = loads.feet[settings.mirrored ? 1 - f : f];
      foot.valid = true;
      foot.count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Eigen::Vector2d place = places[k] - origin_m;
        foot.cells[k] = {{place.x(), side * place.y(), 0}, read_n[k]};
      }
    }
    LoadFrame& frame = clip.emplace_back();
    frame.load = momentum::ToNetworkLoads(loads, Eigen::Vector2d::Zero(), weight_n);
    frame.c_W_m = course.com_m.col(at).head<2>() - origin_m;
    frame.c_W_m.y() *= side;
  }
  return clip;
}

}  // namespace footing::learning
