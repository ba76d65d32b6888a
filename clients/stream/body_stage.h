#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/scene.h"

namespace footing::stream_client {

/// Which movement, and where it stands.
struct StageOptions {
  std::string motion;    ///< A built-in name, or a path: .json, .bvh, .amc, .trc, .c3d.
  std::string skeleton;  ///< ASF of an AMC.
  std::optional<double> bvh_unit_m = {};
  double mass_kg = 75;
  double height_m = 1.75;     ///< Of who performs a script; recordings have their own.
  bool on_boards = true;      ///< False: it may walk anywhere, and nothing is said of boards.
  bool place_boards = false;  ///< Lay the boards under the feet instead of 20 mm apart.
  double seconds = 0;         ///< A recording plays forwards and backwards for this time; 0: once.
};

/// A body in motion over two boards, ready to be felt. Immutable once made.
struct Stage {
  virtual_sensors::Scene scene;
  std::vector<std::array<virtual_sensors::FootForce, virtual_sensors::kFeet>> feet;  ///< A frame.
  std::array<virtual_sensors::BoardPlace, virtual_sensors::kFeet> boards;
  double gap_m = 0.02;       ///< Between the boards' facing edges.
  double outside_share = 0;  ///< Of loaded feet whose COP is beyond the board's sensors.
  bool repeats = false;      ///< Ends as it begins; goes on and on.

  double duration_s() const;
  /// A time as a frame and the way to the next one, 0 to 1. After the end the last frame stays,
  /// unless it repeats.
  struct Instant {
    Eigen::Index frame = 0;
    double share = 0;
  };
  Instant At(double t_s) const;
  /// Load and COP under a foot; between frames as the forces go over.
  virtual_sensors::FootForce FootAt(std::size_t foot, double t_s) const;
};

/// Loads or performs the motion and stands it on the boards: the middle of both soles at the start
/// is W's origin, the boards are 20 mm apart, left and right of it. Logs what it does and how the
/// boards would have to lie.
Result<std::shared_ptr<const Stage>> MakeStage(const StageOptions& options);

}  // namespace footing::stream_client
