#pragma once

#include <string>
#include <vector>

#include "common/runtime/config.h"
#include "common/net/access.h"
#include "common/net/session_limits.h"

namespace footing::serving {

/// Settings that every engine's service has; Bind gives ranges and documentation.
struct Config {
  std::string sensor;               ///< Address of footingd; empty: the default one.
  std::vector<std::string> listen;  ///< Empty: the default one.
  std::string rig;                  ///< Whose motion commands; empty: the first one that can.
  std::string data_folder;          ///< In place of the installed data.
  std::string metrics;              ///< Where metrics are served (MetricsEndpoint); empty: nowhere.
  transport::SessionLimits sessions;
  transport::AccessSettings access;
  std::string version;  ///< Of the program; not a setting.

  void Bind(config::Binder& binder);
};

}  // namespace footing::serving
