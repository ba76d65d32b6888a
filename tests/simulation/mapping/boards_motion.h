#pragma once

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::mapping {

/// The loads of a synthetic person on two boards, one foot each, 60 readings a second with the
/// noise of a board's sensors.
class BoardPerson {
 public:
  explicit BoardPerson(double mass_kg, std::uint64_t seed = 3)
      : weight_n_(KilogramsToNewtons(mass_kg)), random_(seed) {}

  /// How the person moves now.
  bool on_boards = true;
  double lean = 0;       ///< Share of the load moved to the right, of both feet.
  double step_hz = 0;    ///< Steps a second; 0 stands.
  double step_lean = 0;  ///< The right foot stands longer: (right - left) / (right + left).
  double rise_m = 0;     ///< COP towards the toes, while the heels are up.
  double push = 0;       ///< Load above the weight, as its share.

  double time_s() const { return time_s_; }

  /// The inputs 1 / 60 s later.
  Inputs Advance() {
    time_s_ += 1.0 / 60;
    phase_ = step_hz > 0 ? std::fmod(phase_ + step_hz / 2 / 60, 1.0) : 0;
    double right_share = 0.5 + lean / 2;
    double load = 1 + push;
    if (step_hz > 0) {
      // The right foot carries from 0 to `border` of a cycle; the load goes over in a tenth.
      const double border = 0.5 * (1 + step_lean);
      const double into = std::min(phase_, std::min(std::fabs(phase_ - border), 1 - phase_));
      const double away = std::clamp(into / 0.05, 0.0, 1.0);
      right_share = phase_ < border ? 0.5 + 0.49 * away : 0.5 - 0.49 * away;
      load += 0.2 * std::cos(4 * kPi * phase_);  // Each touchdown pushes.
    }
    if (!on_boards) load = 0;
    Inputs inputs;
    inputs.left_board = Board((1 - right_share) * load, 0.17);
    inputs.right_board = Board(right_share * load, -0.17);
    return inputs;
  }

 private:
  BoardInput Board(double share, double side_m) {
    const double load_n = share * weight_n_;
    const double front = 0.5 + rise_m / 0.433;
    BoardInput board{.present = true, .cop_valid = load_n > 49};
    for (std::size_t i = 0; i < 4; ++i) {
      const double part = i < 2 ? front / 2 : (1 - front) / 2;
      board.corners_n[i] = part * load_n + 0.5 * random_.Normal();
    }
    if (board.cop_valid) board.cop_x_m = rise_m + 0.002 * random_.Normal();
    if (board.cop_valid) board.cop_y_m = side_m;
    return board;
  }

  double weight_n_;
  noise::Random random_;
  double time_s_ = 0;
  double phase_ = 0;
};

}  // namespace footing::mapping
