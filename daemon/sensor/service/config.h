#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "daemon/sensor/board/plate.h"

namespace footing::sensor {

/// Everything footingd can be told.
struct Config {
  std::vector<std::string> listen;   ///< Empty: the default address of "sensor".
  std::vector<std::string> sources;  ///< Empty: hid, and stream: at the default of "devices".
  /// Serial to "rig/role"; comes before what a stand-in wishes.
  std::map<std::string, std::string> roles;
  std::string default_rig = "main";
  double tick_rate_hz = 100;
  double stale_after_s = 0.5;  ///< A live device without data for so long is stale.
  board::PlateConfig plate;

  void Bind(config::Binder& binder);
};

}  // namespace footing::sensor
