#pragma once

#include <string>

#include "common/config/config.h"

namespace footing::gait_service {

/// Settings of the gait engine's service.
struct Config {
  std::string interface = "wrist";
  std::string track = "endless";  ///< Name of a built-in track, or a path.
  double frame_rate_hz = 100;     ///< CharacterFrames a second.
  double features_timeout_s = 0.5;
  double fall_shown_s = 0.7;
  double put_back_distance_m = 3;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when the interface is unknown.
Result<void> Check(const Config& config);

}  // namespace footing::gait_service
