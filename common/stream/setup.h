#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"

namespace footing::stream {

/// Where a board lies in the world frame W (x forward, y left, z up).
struct BoardPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;  ///< Of the plate's front edge against W's x, about z.
};

/// A board in its plate frame P (x to the right, y to the front, origin in the middle). Its values
/// are in common/board/geometry.h.
struct BoardGeometry {
  double plate_x_m = 0;  ///< Outer size.
  double plate_y_m = 0;
  double sensor_distance_x_m = 0;  ///< Between the left and the right sensors.
  double sensor_distance_y_m = 0;  ///< Between the rear and the front sensors.

  bool operator==(const BoardGeometry&) const = default;
};

struct BoardLayout {
  std::string rig;
  BoardPose left;
  BoardPose right;
  double gap_mm = 0;
  std::string preset;  ///< "one_foot_each", "side_by_side", "single", "custom"; empty: none set.
  /// In force at the server; none where it does not publish one (board::GeometryOf).
  std::optional<BoardGeometry> left_geometry = std::nullopt;
  std::optional<BoardGeometry> right_geometry = std::nullopt;
};

/// One step of the guided set-up: when it was done and how well.
struct SetupItem {
  std::string name;
  std::string serial;
  bool passed = false;
  std::int64_t wall_time_ns = 0;
  double residual = 0;
  std::string unit;
  std::string note;
  bool stale = false;
};

/// How a worn device sits: f_M = rotation_MS f_S, where M is the frame of a perfect mounting (x
/// left, y front, z down while its wearer stands upright with the arms hanging). Features are of M.
struct DeviceMounting {
  std::string serial;
  Eigen::Quaterniond rotation_MS = Eigen::Quaterniond::Identity();
  double residual_rad = 0;
};

/// What the guided set-up asks the person for.
enum class Gesture {
  kUnspecified = 0,
  kSwitchOn = 1,   ///< Every device.
  kHoldStill = 2,  ///< Everything.
  kStepOff = 3,    ///< Off the boards; everything still.
  kStepOn = 4,     ///< On the board of the role alone.
  kStand = 5,      ///< Upright on all boards.
  kLean = 6,       ///< Forward from there.
  kShake = 7,      ///< The device of the role.
  kTakeSteps = 8   ///< Three, the left foot first, and stand again.
};

/// "switch on", "hold still", ..., for a log or a table.
const char* Name(Gesture gesture);

/// What a guided set-up asks for at present.
struct SetupPrompt {
  std::string item;
  std::string text;
  Gesture gesture = Gesture::kUnspecified;
  DeviceRole role = DeviceRole::kUnspecified;
  std::uint64_t number = 0;  ///< Of the prompts so far.
};

struct RigSetup {
  std::string rig;
  BoardLayout layout;
  std::vector<SetupItem> items;
  std::vector<DeviceMounting> mountings;
  std::optional<SetupPrompt> prompt = std::nullopt;
};

}  // namespace footing::stream
