#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>

#include "common/stream/device.h"
#include "common/virtual/devices/balance_board.h"
#include "common/virtual/devices/random.h"

namespace footing::stream_client {

/// A synthetic person on boards with a remote in each hand, on each wrist or on each shin, who does
/// what a guided setup asks for. Boards and limbs are numbered 0 (left) and 1 (right) by what the
/// person calls them.
///
/// A limb that hangs feels (0, 0, -g) in its frame M (x left, y front, z down) and swings in the
/// plane of front and down, from rest: left leg and right hand to the front first, the left hand to
/// the back, the right leg half a cycle later. Remotes on wrists and shins are strapped on askew,
/// each in its own way, so that nothing is right before the mounting is found; those in the hands
/// are held as they should be.
class SetupBody {
 public:
  enum class Place { kHands, kWrists, kShins };
  /// One who stands on `boards` boards. They lie one foot each until Lay() says otherwise.
  explicit SetupBody(Place place, double mass_kg = 70, int boards = 2);

  stream::DeviceRole Role(int limb) const;

  /// One line: off | left | right | both | lean | shake left | shake right | still | walk | run |
  /// jump | swap (the boards) | turn left | turn right (a board, by half) | slip left DEGREES |
  /// slip right DEGREES (a strap, about the limb) | loose left | loose right (a strap; again:
  /// tight). False when it is not known.
  bool Do(const std::string& line);

  /// How the boards lie: their yaw in W, as in stream::BoardPose.
  void Lay(double left_yaw_rad, double right_yaw_rad) { yaw_rad_ = {left_yaw_rad, right_yaw_rad}; }

  /// What the board feels that lies in this place in the beginning. Times never go back.
  virtual_devices::CornerForces Board(int board, double t_s);
  /// What the limb's remote feels, in the remote's own axes.
  Eigen::Vector3d Limb(int limb, double t_s);

 private:
  struct Swing {
    double frequency_hz = 0;
    double amplitude_mps2 = 0;
    bool in_turns = false;
  };
  struct Strap {
    double slip_rad = 0;  // About the limb.
    bool loose = false;
  };
  double Share(int place) const;
  double Wave(int limb) const;

  Place place_;
  double weight_n_;
  int boards_;
  std::array<double, 2> yaw_rad_;
  std::string stance_ = "off";
  double lean_m_ = 0;
  std::array<Swing, 2> swing_;
  std::array<Strap, 2> strap_;
  std::array<bool, 2> turned_{};
  bool swapped_ = false;
  std::array<double, 2> share_{};  // As it is now; follows Share() within a third of a second.
  std::array<double, 2> leaning_m_{};
  std::array<double, 2> board_s_{};
  std::array<double, 2> limb_s_{};
  std::array<double, 2> swinging_s_{};  // Since the swing began.
  noise::Random random_{7};
};

}  // namespace footing::stream_client
