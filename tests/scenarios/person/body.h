#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>

#include "common/device_models/balance_board.h"
#include "common/synthetic/random.h"

namespace footing::scenario {

/// A made person on two boards with a remote on each wrist, told in words what to do. Boards and
/// hands are numbered 0 (left) and 1 (right) by what the person calls them.
class Body {
 public:
  /// One line: off | left | right | both | lean | shake left | shake right | still | walk | run |
  /// jump | steps | swap | turn left | turn right | slip DEGREES. False when it is not known.
  bool Tell(const std::string& line);

  /// What the board feels that lies in this place in the beginning. Times never go back.
  device_models::CornerForces Board(int board, double t_s);
  Eigen::Vector3d Hand(int hand, double t_s);

 private:
  struct Swing {
    double frequency_hz = 0;
    double phase_rad = 0;  // Right minus left.
    double amplitude_mps2 = 0;
  };
  double Share(int place) const;

  std::string stance_ = "off";
  double lean_m_ = 0;
  std::array<Swing, 2> swing_;
  std::array<bool, 2> turned_{};
  bool swapped_ = false;
  double slip_rad_ = 0;
  std::array<double, 2> share_{};  // As it is now; follows Share() within a third of a second.
  std::array<double, 2> leaning_m_{};
  std::array<double, 2> board_s_{};
  std::array<double, 2> hand_s_{};
  std::array<double, 2> angle_rad_{};
  synthetic::Random random_{7};
};

}  // namespace footing::scenario
