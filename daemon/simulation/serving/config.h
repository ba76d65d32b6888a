#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace footing::serving {

/// What footing-sim can be told; Bind gives ranges and documentation.
struct Config {
  std::string engine = "gait";
  std::string interface = "wrist";
  std::string sensor;               ///< Address of footingd; empty: the default one.
  std::vector<std::string> listen;  ///< Empty: the default one.
  std::string rig;                  ///< Whose motion commands; empty: the first rig with hands.
  std::string track = "straight";   ///< Name of a track that the product carries, or a path.
  std::string data_folder;          ///< In place of the installed data.
  double frame_rate_hz = 100;       ///< CharacterFrames a second.
  double features_timeout_s = 0.5;
  double fall_shown_s = 0.7;
  double put_back_distance_m = 3;
  std::string subject;        ///< Subject file of the pose engine; empty: nobody has been named.
  std::string mode = "best";  ///< Of the pose engine: "best" or "paper".
  std::int64_t lag_ms = 0;    ///< Of the pose engine: 0, 100 or 200.

  void Bind(config::Binder& binder);
};

/// Usage error that lists what is built when engine, interface, mode or lag is not.
Result<void> CheckBuilt(const Config& config);

}  // namespace footing::serving
