#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/device.h"

namespace footing::stream {

/// One accelerometer sample in the sensor frame S (x left, y front, z down).
struct MotionSample {
  std::uint32_t device = 0;
  std::uint64_t report_count = 0;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  /// Raw, calibrated. Held still face up it is (0, 0, -9.81) m/s².
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d filtered_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z at the end of the sensor's range.
  bool repeated = false;
  bool uncalibrated = false;
  bool simulated = false;
  std::uint32_t buttons = 0;
  bool has_angular_velocity = false;
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();  ///< In S, bias removed.
  bool angular_velocity_clipped = false;
  bool gyroscope_uncalibrated = false;
  bool has_magnetic_field = false;
  Eigen::Vector3d magnetic_field = Eigen::Vector3d::Zero();  ///< Counts in S.
  double trigger = 0;                                        ///< 0 to 1, of a PS Move.
  double temperature_c = 0;
  Eigen::Vector3d gyroscope_bias_radps = Eigen::Vector3d::Zero();  ///< In S; what was removed.
};

/// One sample of a Nunchuk, in its own sensor frame (x left, y front, z down).
struct NunchukSample {
  std::uint32_t device = 0;
  std::uint64_t report_count = 0;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  double stick_x = 0;  ///< -1 left to 1 right.
  double stick_y = 0;  ///< -1 back to 1 front.
  bool c = false;
  bool z = false;
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;
  bool repeated = false;
  bool uncalibrated = false;
  bool simulated = false;
};

/// Bits of GamepadSample::buttons.
enum GamepadButton : std::uint32_t {
  kGamepadA = 0x1,
  kGamepadB = 0x2,
  kGamepadX = 0x4,
  kGamepadY = 0x8,
  kGamepadL = 0x10,
  kGamepadR = 0x20,
  kGamepadZl = 0x40,
  kGamepadZr = 0x80,
  kGamepadMinus = 0x100,
  kGamepadPlus = 0x200,
  kGamepadHome = 0x400,
  kGamepadUp = 0x800,
  kGamepadDown = 0x1000,
  kGamepadLeft = 0x2000,
  kGamepadRight = 0x4000,
  kGamepadLeftStick = 0x8000,
  kGamepadRightStick = 0x10000,
};

/// One sample of a Classic Controller or a Wii U Pro Controller.
struct GamepadSample {
  std::uint32_t device = 0;
  std::uint64_t report_count = 0;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  double left_x = 0;  ///< Sticks: -1 left to 1 right, -1 back to 1 front.
  double left_y = 0;
  double right_x = 0;
  double right_y = 0;
  double left_trigger = 0;  ///< 0 to 1.
  double right_trigger = 0;
  std::uint32_t buttons = 0;
  bool repeated = false;
  bool uncalibrated = false;
  bool simulated = false;
};

/// A bright point as a Wiimote's camera counts: x 0 to 1023, y 0 to 767.
struct CameraPoint {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t size = 0;
};

struct CameraSample {
  std::uint32_t device = 0;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  std::vector<CameraPoint> points;
  bool simulated = false;
};

/// Features of one controller (gait paper, section 6).
struct DeviceFeatures {
  std::uint32_t device = 0;
  DeviceRole role = DeviceRole::kUnspecified;
  bool moving = false;
  bool frequency_valid = false;
  double frequency_hz = 0;
  bool amplitude_valid = false;
  double amplitude_mps2 = 0;  ///< Half peak to peak of the raw samples over one cycle.
  bool inclination_valid = false;
  double roll_rad = 0;   ///< Left side higher is positive.
  double pitch_rad = 0;  ///< Front higher is positive.
  bool held = false;     ///< Held from before, because samples clip.
  bool simulated = false;
  bool swing_valid = false;  ///< The horizontal swing of the last cycle has a direction.
  double swing_rad = 0;      ///< It, from the front; left positive, within 2.1 rad.
};

/// Right minus left, in (-pi, pi].
struct PairFeatures {
  std::uint32_t left_device = 0;
  std::uint32_t right_device = 0;
  bool phase_valid = false;
  double phase_rad = 0;
  bool phase_held = false;  ///< From before: the newest cycle shows none, or not yet for sure.
};

struct RigFeatures {
  std::string rig;
  std::vector<DeviceFeatures> devices;
  std::vector<PairFeatures> pairs;
  std::int64_t newest_received_ns = 0;
  std::int64_t decoded_ns = 0;
  std::int64_t computed_ns = 0;
};

/// One board sample in the plate frame P (x right, y front, origin in the middle).
struct BoardSample {
  std::uint32_t device = 0;
  std::uint64_t report_count = 0;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  double top_left_n = 0;
  double top_right_n = 0;
  double bottom_left_n = 0;
  double bottom_right_n = 0;
  double total_n = 0;
  bool cop_valid = false;
  double cop_x_m = 0;
  double cop_y_m = 0;
  bool contact = false;
  bool repeated = false;
  bool uncalibrated = false;
  bool simulated = false;
  bool tared = false;
};

}  // namespace footing::stream
