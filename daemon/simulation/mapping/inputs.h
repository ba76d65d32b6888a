#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "common/stream/sensor.h"
#include "common/stream/user_interface.h"

/// What the user interfaces get: plain values of fixed size. Copying allocates nothing, so they can
/// pass to the simulation thread.
namespace footing::mapping {

/// The features of one controller (gait paper, section 6).
struct LimbFeatures {
  bool present = false;
  bool moving = false;
  bool frequency_valid = false;
  double frequency_hz = 0;
  bool amplitude_valid = false;
  double amplitude_mps2 = 0;  ///< Half peak to peak of the raw samples over one cycle.
  bool inclination_valid = false;
  double roll_rad = 0;   ///< Left side higher is positive.
  double pitch_rad = 0;  ///< Front higher is positive.
  bool swing_valid = false;
  double swing_rad = 0;  ///< Of the horizontal swing from the controller's front, left positive.
  bool mounted = false;  ///< The features are of the frame M of a perfect mounting, else of S.

  bool operator==(const LimbFeatures&) const = default;
};

/// A left and a right limb.
struct LimbPair {
  LimbFeatures left;
  LimbFeatures right;
  bool phase_valid = false;
  double phase_rad = 0;  ///< Right minus left, in (-pi, pi].

  bool operator==(const LimbPair&) const = default;
};

/// The stick of a Nunchuk and button A of the Wiimote that it is plugged into.
struct StickInput {
  bool present = false;
  double x = 0;               ///< -1 left to 1 right.
  double y = 0;               ///< -1 back to 1 front.
  bool pressed = false;       ///< Button A.
  std::uint64_t presses = 0;  ///< So far; none is lost between two inputs.
  /// Of that Wiimote, also while it is not present; unspecified: not known.
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;

  bool operator==(const StickInput&) const = default;
};

/// One Balance Board.
struct BoardInput {
  bool present = false;
  /// Corner forces: top left, top right, bottom left, bottom right.
  std::array<double, 4> corners_n{};
  bool cop_valid = false;
  double cop_x_m = 0;  ///< In W: forward.
  double cop_y_m = 0;  ///< In W: to the left.

  double LoadN() const { return corners_n[0] + corners_n[1] + corners_n[2] + corners_n[3]; }
  bool operator==(const BoardInput&) const = default;
};

/// The bit of `role` when its controller is missing, or is worn without a mounting; else 0.
constexpr std::uint32_t Missing(const LimbFeatures& limb, stream::DeviceRole role) {
  return limb.present ? 0 : stream::RoleBit(role);
}
constexpr std::uint32_t Unmounted(const LimbFeatures& limb, stream::DeviceRole role) {
  return !limb.present || limb.mounted ? 0 : stream::RoleBit(role);
}

/// What one person wears, holds and stands on at one instant.
struct Inputs {
  LimbPair hands;
  LimbPair legs;
  LimbFeatures head;
  LimbFeatures trunk;
  StickInput stick;
  BoardInput left_board;
  BoardInput right_board;
  bool simulated = false;  ///< A simulated device is among them.
  /// The gait that the character runs; the engine fills it in.
  stream::Gait running = stream::Gait::kStep;

  bool operator==(const Inputs&) const = default;
};

/// The features of a controller. Numbers that are not finite count as not valid. One from which
/// footingd has not heard for a while, so that it knows neither motion nor inclination, is not
/// present.
LimbFeatures ToLimb(const stream::DeviceFeatures& device, bool mounted);

/// Replaces hands, legs, head and trunk by those of the rig: devices by their roles, and the pairs
/// they form. What the rig lacks is not present. Bits of `mounted_roles` are by stream::RoleBit.
void TakeFeatures(const stream::RigFeatures& rig, std::uint32_t mounted_roles, Inputs& inputs);

}  // namespace footing::mapping
