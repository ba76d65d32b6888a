#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::stream_client {

/// Options of the command `sensors`.
struct SensorsOptions {
  std::string listen = "127.0.0.1:6969";  ///< HOST:PORT, UDP.
  std::vector<std::string> roles;         ///< ROLE in order of arrival, or SENSOR=ROLE.
  std::string rig;
};

CLI::App* AddSensorsCommand(CLI::App& app, SensorsOptions& options);

/// Attaches the inertial sensors that send to a UDP port (see SensorPackets) to footingd, until
/// SIGINT or for `seconds`, where that is not 0. A sensor that is silent for 5 s is detached. Usage
/// error for roles and addresses that are none; failure when it cannot listen; no device when
/// footingd was not there for all of `seconds`.
Result<void> RunSensors(const SensorsOptions& options, const transport::Address& to,
                        double seconds);

}  // namespace footing::stream_client
