#pragma once

#include <string>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"
#include "common/virtual_sensors/board_cells.h"

namespace footing::stream_client {

struct BoardsOptions {
  StageOptions stage;
  std::string hands = "none";  ///< none, move or wiimote.
  double hand_noise_m = 0.01;  ///< Standard deviation along each axis, of hands "move".
  virtual_sensors::CellErrorConfig errors;  ///< Its seed is not used.
};

/// Two Balance Boards under a body in motion, its true pose, and its hands: as a tracker sees them
/// ("move"), or two Wiimotes with MotionPlus on the forearms ("wiimote"), each mounted so that with
/// hanging arms x is left, y front and z down.
Result<Plan> PlanBoards(const BoardsOptions& options, const Common& common);

}  // namespace footing::stream_client
