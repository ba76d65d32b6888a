#pragma once

#include <string>
#include <vector>

#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/pose_service/config.h"
#include "daemon/simulation/serving/config.h"

namespace footing::footing_sim {

/// All settings of footing-sim. A config file may hold those of both engines.
struct Config {
  std::string engine = "gait";
  serving::Config serving;
  gait_service::Config gait;
  pose_service::Config pose;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when engine, interface, mode or lag is none of them.
Result<void> Check(const Config& config);

/// Usage error when one of `settings` ("key=value"), given on the command line, belongs to the
/// engine that does not run.
Result<void> CheckApply(const Config& config, const std::vector<std::string>& settings);

}  // namespace footing::footing_sim
