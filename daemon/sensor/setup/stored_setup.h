#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/board/plate.h"
#include "common/stream/setup.h"

namespace footing::setup {

struct StoredMounting {
  std::string role;  ///< "rig/role" that it was found for; stale on another.
  Eigen::Quaterniond rotation_MS = Eigen::Quaterniond::Identity();
  double residual_rad = 0;
  bool slipped = false;  ///< Since it was found.
};

struct StoredTare {
  board::CornerForces offset;
  double residual_n = 0;
};

/// What a device reports of its own calibration.
struct StoredCalibration {
  std::string serial;
  std::vector<std::uint8_t> bytes;
};

/// The parts of a stored set-up. Roles ("rig/role"), tares, mountings and moved boards are by
/// serial, layouts and items by rig.
using Roles = std::map<std::string, std::string>;
using Tares = std::map<std::string, StoredTare>;
using Mountings = std::map<std::string, StoredMounting>;
using Layouts = std::map<std::string, stream::BoardLayout>;
using Items = std::map<std::string, std::vector<stream::SetupItem>>;
using MovedBoards = std::map<std::string, bool>;

}  // namespace footing::setup
