#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/body_course.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::eval {

/// A motion file as two boards see it.
struct MomentumOptions {
  std::string motion;    ///< BVH, AMC, TRC or C3D.
  std::string skeleton;  ///< ASF, of an AMC.
  std::optional<double> bvh_unit_m = {};
  double mass_kg = 75;
  double rate_hz = 60;  ///< Of the cells and of the estimator.
  double loop_minutes = 0;
  bool unlimited = false;  ///< Boards without an edge.
  double lag_s = 0;
  bool paper = false;
  virtual_sensors::CellErrorConfig errors;
};

struct TrueFoot {
  double load_n = 0;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< Of the sole.
};

struct MomentumFrame {
  momentum::ContactLoads loads;
  Eigen::Vector3d com_m;
  Eigen::Vector3d angular_momentum;
  std::array<TrueFoot, momentum::kFeet> feet;
};

struct MomentumScene {
  double rate_hz = 60;
  momentum::Subject subject;
  std::vector<MomentumFrame> frames;  ///< Begins with kCalibrationS in the T-pose.
  double outside_share = 0;           ///< Of loaded feet whose COP is beyond the sensors.
};

/// Duration of the T-pose; the transition from it takes a second and a half.
inline constexpr double kCalibrationS = 6;

/// Errors name the file and what is wrong in it.
Result<MomentumScene> MakeMomentumScene(const MomentumOptions& options);

}  // namespace footing::eval
