#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

/// From the vertical loads under two feet to the motion of the centre of mass, the angular momentum
/// and the places of the feet (Ha, Bai & Liu 2011, sections 4 and 6; docs/momentum.md).
namespace footing::momentum {

inline constexpr std::size_t kFeet = 2;  ///< 0 is the left one.
inline constexpr std::size_t kMaxCells = 16;

/// One load cell, in W (x forward, y left, z up; m).
struct Cell {
  Eigen::Vector3d p_WS_m = Eigen::Vector3d::Zero();
  double load_n = 0;  ///< Vertical force of the foot on the cell, downwards positive.
};

/// What is under one foot: a board of four cells, an insole of more. `valid` is false when the
/// source says nothing at this time (a lost link), which is not the same as no load.
struct FootLoads {
  bool valid = false;
  std::size_t count = 0;
  std::array<Cell, kMaxCells> cells{};
};

/// All cells at one time. An insole's cells move with the foot; a board's stay.
struct ContactLoads {
  double time_s = 0;
  std::array<FootLoads, kFeet> feet{};
};

/// Centre of pressure and total of a set of cells.
struct Pressure {
  double total_n = 0;
  bool cop_valid = false;  ///< The total is over the limit that was asked for.
  Eigen::Vector3d p_WP_m = Eigen::Vector3d::Zero();
};

/// Of one foot; the centre of pressure counts from `least_n` (> 0) on. An invalid source and cells
/// that are not finite give 0 and no centre.
Pressure PressureOf(const FootLoads& foot, double least_n);
/// Of both feet together.
Pressure PressureOf(const ContactLoads& loads, double least_n);

/// Whether the COP has reached the edge of a board, by its cells in the order of board::Corners:
/// nearly all load is on the two cells of one side. It cannot be further out: a foot that is
/// presses the edge all the same. Never where there is little load or cells pull, which are those
/// of a simulated plate without an edge.
bool AtEdge(const FootLoads& foot);

/// True when every load and position is finite and no count is over kMaxCells.
bool IsFinite(const ContactLoads& loads);

}  // namespace footing::momentum
