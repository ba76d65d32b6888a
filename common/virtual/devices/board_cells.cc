#include "common/virtual/devices/board_cells.h"

#include <algorithm>
#include <cmath>

#include "common/board/layout.h"
#include "common/base/units.h"

namespace footing::virtual_sensors {
namespace {

constexpr double kFullLoadN = 370;  // Half a person: the slow error is stated for this load.

// Axes of P in W.
Eigen::Vector2d Front(const BoardPlace& board) {
  return {std::cos(board.yaw_rad), std::sin(board.yaw_rad)};
}
Eigen::Vector2d Right(const BoardPlace& board) {
  return {std::sin(board.yaw_rad), -std::cos(board.yaw_rad)};
}

}  // namespace

std::array<BoardPlace, kFeet> SideBySide() {
  const double middle_m = 0.5 * board::kBalanceBoard.plate_y_m;
  return {BoardPlace{{0, middle_m}, 0.5 * kPi}, BoardPlace{{0, -middle_m}, 0.5 * kPi}};
}

std::array<BoardPlace, kFeet> OneFootEach(double gap_m) {
  const auto poses = board::OneFootEach(gap_m);
  const auto place = [](const stream::BoardPose& pose) {
    return BoardPlace{{pose.x_m, pose.y_m}, pose.yaw_rad};
  };
  return {place(poses[0]), place(poses[1])};
}

std::array<Eigen::Vector2d, board::kCorners> SensorPlaces(const BoardPlace& board) {
  return board::SensorPlaces({board.middle_m.x(), board.middle_m.y(), board.yaw_rad});
}

bool IsBeside(const BoardPlace& board, const FootForce& foot) {
  const Eigen::Vector2d p = foot.cop_m - board.middle_m;
  return std::abs(p.dot(Right(board))) > 0.5 * board::kBalanceBoard.plate_x_m ||
         std::abs(p.dot(Front(board))) > 0.5 * board::kBalanceBoard.plate_y_m;
}

BoardLoad LoadBoard(const BoardPlace& board, const FootForce& foot, bool limited) {
  const Eigen::Vector2d p = foot.cop_m - board.middle_m;
  const double x = p.dot(Right(board)) / (0.5 * board::kBalanceBoard.sensor_distance_x_m);
  const double y = p.dot(Front(board)) / (0.5 * board::kBalanceBoard.sensor_distance_y_m);
  double inside_x = std::clamp(x, -1.0, 1.0), inside_y = std::clamp(y, -1.0, 1.0);
  BoardLoad load;
  load.outside = inside_x != x || inside_y != y;
  if (!limited) {
    inside_x = x;
    inside_y = y;
  }
  for (std::size_t i = 0; i < load.corners_n.size(); ++i) {
    load.corners_n[i] = 0.25 * foot.load_n * (1 + board::kCornerRight[i] * inside_x) *
                        (1 + board::kCornerFront[i] * inside_y);
  }
  return load;
}

CellErrors::CellErrors(const CellErrorConfig& config) : config_(config), random_(config.seed) {
  for (double& gain : gains_) gain = 1 + config.gain_spread * random_.Normal();
  slow_n_ = config.slow_force_n * random_.Normal();
}

Corners CellErrors::Advance(const Corners& true_n, double step_s) {
  const double total = true_n[0] + true_n[1] + true_n[2] + true_n[3];
  const double keep = std::exp(-step_s / config_.slow_time_s);
  slow_n_ = keep * slow_n_ + std::sqrt(1 - keep * keep) * config_.slow_force_n * random_.Normal();
  const double slow = 0.25 * slow_n_ * std::clamp(total / kFullLoadN, 0.0, 1.5);
  Corners read;
  for (std::size_t i = 0; i < read.size(); ++i) {
    // The play operator: the reading follows once the force has crossed the play.
    if (!started_) play_n_[i] = true_n[i];
    play_n_[i] =
        std::clamp(play_n_[i], true_n[i] - config_.hysteresis_n, true_n[i] + config_.hysteresis_n);
    read[i] =
        gains_[i] * play_n_[i] + slow + KilogramsToNewtons(config_.noise_kg) * random_.Normal();
  }
  started_ = true;
  return read;
}

}  // namespace footing::virtual_sensors
