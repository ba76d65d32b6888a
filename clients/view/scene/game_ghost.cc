#include "clients/view/scene/game_ghost.h"

#include <cmath>

namespace footing::scene {
namespace {

constexpr double kThickM = 0.08;
/// Above the ground that it begins at, so that both faces do not fight for the same pixels.
constexpr double kOverM = 0.01;

}  // namespace

void AddGhostSegment(const stream::GameState& game, PartList& ghosts) {
  if (!game.ghost) return;
  const stream::TrackSegment& segment = *game.ghost;
  const Eigen::Matrix3d axes = (Eigen::AngleAxisd(segment.heading_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-segment.slope_rad, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  const Eigen::Vector3d middle =
      segment.start_m + 0.5 * segment.length_m * axes.col(0) + (kOverM - kThickM / 2) * axes.col(2);
  const Eigen::Vector3d sides(segment.length_m, segment.width_m, kThickM);
  ghosts.AddBox(middle.cast<float>(), axes.cast<float>(), sides.cast<float>(),
                Rgb(segment.pit ? 0xD83A2E : 0xF7B538));
}

}  // namespace footing::scene
