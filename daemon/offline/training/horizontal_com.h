#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/offline/training/examples.h"
#include "daemon/simulation/cascade/network.h"

/// The horizontal COM from the loads of two boards (pose paper, section 4.2).
namespace footing::training {

constexpr std::size_t kBoardCells = 8;

/// One frame, 60 to 120 a second.
struct LoadFrame {
  std::array<double, kBoardCells> load{};  ///< Of each cell, as part of the body's weight.
  Eigen::Vector2d c_W_m{0, 0};             ///< COM, x forward and y left of the feet's middle.
  /// Middle of the left and of the right board.
  std::array<Eigen::Vector2d, 2> board_W_m = {Eigen::Vector2d(0, 0.16), Eigen::Vector2d(0, -0.16)};
};

/// The loads of a board's cells (front left, front right, rear left, rear right) under a load whose
/// COP is at `cop_P_m` from the board's middle.
void ShareOut(double load, const Eigen::Vector2d& cop_P_m, double* cells);

/// Where the sum of all cells acts; nothing under 10 % of the weight, where noise decides.
std::optional<Eigen::Vector2d> Cop(const LoadFrame& frame);

/// A recording without a gap.
using LoadClip = std::vector<LoadFrame>;

/// Columns of the network's inputs that are its own outputs in use: c(t-2), c(t-1), c(t) of the
/// axis, and c(t) of the other.
constexpr std::size_t kHorizontalInputs = 2 * kBoardCells + 4;
std::vector<std::vector<Eigen::Index>> FeedbackColumns();

/// X = {F(t-1), F(t), c(t-2), c(t-1), c(t), other c(t)} -> Y = {c(t+1)} of `axis` (0 x, 1 y), for
/// every t of every clip that has them all.
Examples HorizontalExamples(std::span<const LoadClip> clips, int axis);

/// Root mean square error of each axis in metres when the networks go on from their own outputs,
/// from the third frame on. A COM more than `border_m` away is held there.
Eigen::Vector2d ClosedLoopError(const cascade::CascadeNetwork& x, const cascade::CascadeNetwork& y,
                                const LoadClip& clip, double border_m = 1);

/// The same of the COP, held where there is none: what a network that knows nothing else would say.
Eigen::Vector2d CopError(const LoadClip& clip);

/// A made recording: a body that leans and bends its knees as an inverted pendulum of 1 m over two
/// boards, all sums of sines with random phases, white noise on the cells.
struct SwaySettings {
  double seconds = 84;
  double rate_hz = 60;
  double noise_sd = 0.0013;  ///< Of a cell: 0.1 kg of 75 kg.
};
LoadClip MakeSway(const SwaySettings& settings, std::uint64_t seed);

}  // namespace footing::training
