#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/held_device.h"

namespace footing::stream_client {

struct BoardsOptions {
  StageOptions stage;
  std::string hands = "none";          ///< none, move, wiimote, straps, kinect or camera.
  std::string camera_file, frames_to;  ///< Of hands "camera": the simulated camera, and a FIFO.
  bool moves = false;         ///< With hands "camera": PS Moves in the fists light the spheres.
  std::string head = "none";  ///< none, or sphere: one on a cap, as a tracker sees it.
  /// A hand that is lost for a while: its Wiimote out of reach, or not seen.
  std::string lost_hand;  ///< left or right; empty: none is.
  double lost_from_s = 0, lost_for_s = 0;
  double hand_noise_m = 0.01;  ///< Standard deviation along each axis, of hands "move".
  virtual_sensors::CellErrorConfig errors;  ///< Its seed is not used.
};

/// Two Balance Boards under a body in motion, its true pose, and its hands: as a tracker sees them
/// ("move"), as a Kinect does ("kinect"), or as two Wiimotes with MotionPlus in the fists feel them
/// ("wiimote"), each held so that it points forward with its buttons up in the T-pose, give or take
/// the errors of virtual_sensors::HeldErrors, or strapped on upper arms and forearms ("straps"); or
/// as rendered frames for footing-camera ("camera").
Result<Plan> PlanBoards(const BoardsOptions& options, const Common& common);

/// What a Wiimote in the fist of side 0 (left) or 1 feels. A copy starts from the beginning.
SimulatedDevice::WiimoteMotion InFist(std::shared_ptr<const Stage> stage, int side,
                                      std::uint64_t seed);

/// What a Wiimote strapped there feels.
SimulatedDevice::WiimoteMotion OnSegment(std::shared_ptr<const Stage> stage, int side,
                                         virtual_sensors::ArmSegment segment, std::uint64_t seed);

}  // namespace footing::stream_client
