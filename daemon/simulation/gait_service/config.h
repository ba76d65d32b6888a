#pragma once

#include <string>

#include "common/runtime/config.h"
#include "daemon/simulation/mapping/any_interface.h"

namespace footing::gait_service {

/// Settings of the gait engine's service.
struct Config {
  std::string interface = "wrist";
  std::string turn_by = "head";     ///< Of the interface leg: head, feet or trunk.
  bool camera_roll = false;         ///< Likewise: the picture follows the head.
  bool boards_may_be_left = false;  ///< Of the interface boards: both feet may leave them.
  std::string mapping_table;        ///< Path, of the interface; empty: the built-in one.
  std::string track = "endless";    ///< Name of a built-in track, or a path.
  double frame_rate_hz = 100;       ///< CharacterFrames a second.
  double features_timeout_s = 0.5;
  double fall_shown_s = 0.7;
  double put_back_distance_m = 3;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when the interface or what turns is unknown.
Result<void> Check(const Config& config);

/// What may turn with the interface leg, by its number in the protocol; kUnspecified for others.
stream::TurnSource LegTurnSource(int number);

/// The interface that a checked config asks for.
mapping::InterfaceOptions OptionsOf(const Config& config);

}  // namespace footing::gait_service
