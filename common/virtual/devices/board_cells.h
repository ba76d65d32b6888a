#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "common/board/geometry.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/ground_reaction.h"

namespace footing::virtual_sensors {

/// Where a board lies: its middle in W, and how far its front (away from the power button) is
/// turned to the left from W's x axis.
struct BoardPlace {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
};

/// Two boards, one under each foot, with their long sides ahead, edge to edge.
std::array<BoardPlace, kFeet> SideBySide();

/// The layout one_foot_each: their long sides ahead, `gap_m` between them, the origin in the
/// middle of the gap, their front edges facing each other.
std::array<BoardPlace, kFeet> OneFootEach(double gap_m);

/// N on the four corners.
using Corners = board::Corners;

/// Place of each corner's sensor in W.
std::array<Eigen::Vector2d, board::kCorners> SensorPlaces(const BoardPlace& board);

/// The corners under a foot. A cell only pushes, so a COP outside the sensors' rectangle is one
/// the board cannot have without tipping: it is moved to the nearest edge.
struct BoardLoad {
  Corners corners_n{};
  bool outside = false;  ///< The COP was outside the rectangle.
};
/// Not `limited`: cells that pull, too, as if the plate had no edge.
BoardLoad LoadBoard(const BoardPlace& board, const FootForce& foot, bool limited = true);

/// Whether the COP is beyond the board's plate: the foot stands on the floor beside it.
bool IsBeside(const BoardPlace& board, const FootForce& foot);

/// Errors of a board's cells (Bartlett, Ting & Bingham 2014: absolute within 9.1 N, repeatable
/// within 4.5 N).
struct CellErrorConfig {
  double gain_spread = 0;   ///< Standard deviation of each cell's gain.
  double hysteresis_n = 0;  ///< Half the width of each cell's play.
  double slow_force_n = 0;  ///< Standard deviation of the slow error of a loaded board.
  double slow_time_s = 3;   ///< Its correlation time.
  double noise_kg = 0;      ///< White, of each cell and sample.
  std::uint64_t seed = 1;
};

/// One board's cells with errors. A plain value; times go forward.
class CellErrors {
 public:
  explicit CellErrors(const CellErrorConfig& config);

  /// What the cells read under these forces, `step_s` after the sample before.
  Corners Advance(const Corners& true_n, double step_s);

  const std::array<double, 4>& gains() const { return gains_; }

 private:
  CellErrorConfig config_;
  noise::Random random_;
  std::array<double, 4> gains_{};
  bool started_ = false;
  Corners play_n_{};
  double slow_n_ = 0;
};

}  // namespace footing::virtual_sensors
