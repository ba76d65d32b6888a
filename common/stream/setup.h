#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace footing::stream {

/// Where a board lies in the world frame W (x forward, y left, z up).
struct BoardPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;  ///< Of the plate's front edge against W's x, about z.
};

struct BoardLayout {
  std::string rig;
  BoardPose left;
  BoardPose right;
  double gap_mm = 0;
  std::string preset;  ///< "one_foot_each", "side_by_side", "single", "custom"; empty: none set.
};

/// Plate of a board: its long and its short side, and how high its surface is.
inline constexpr double kPlateLongM = 0.511;
inline constexpr double kPlateShortM = 0.316;
inline constexpr double kPlateHeightM = 0.053;

/// Where boards lie that nobody has laid out: one foot each, long sides fore and aft, power buttons
/// outwards, 2 cm apart.
BoardLayout DefaultLayout();

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

struct RigSetup {
  std::string rig;
  BoardLayout layout;
  std::vector<SetupItem> items;
  std::vector<DeviceMounting> mountings;
};

}  // namespace footing::stream
