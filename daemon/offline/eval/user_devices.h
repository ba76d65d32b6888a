#pragma once

#include <cstdint>
#include <vector>

#include "common/board/plate.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/people/felt.h"
#include "common/virtual/devices/accelerometer.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::eval {

/// The devices of a synthetic user and footingd's chain behind them: what the sensors make of what
/// they feel, then features, stick, or corner forces and COP. Of the kinds that the user has.
class UserDevices {
 public:
  static constexpr double kTickS = 0.01;

  /// `turn_by` is of the leg interface.
  UserDevices(stream::UserInterface interface, stream::TurnSource turn_by, std::uint64_t seed);

  /// The inputs of the next tick.
  mapping::Inputs Take(const users::Felt& felt);

 private:
  void TakeRemotes(const users::Felt& felt);
  void TakeStick(const users::Felt& felt);
  void TakeBoards(const users::Felt& felt);

  stream::UserInterface interface_;
  noise::Random random_;
  wrists::SensorModel sensor_;
  Chain chain_;
  std::vector<virtual_sensors::CellErrors> cells_;
  std::array<board::Plate, 2> plates_;
  std::int64_t ticks_ = 0;
  double board_due_s_ = 0;
  mapping::Inputs inputs_;
};

}  // namespace footing::eval
