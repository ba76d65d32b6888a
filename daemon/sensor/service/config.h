#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/board/plate.h"
#include "common/runtime/config.h"
#include "common/base/result.h"
#include "common/net/access.h"
#include "common/net/address.h"
#include "common/net/session_limits.h"
#include "common/base/units.h"
#include "daemon/sensor/devices/connection_limits.h"

namespace footing::sensor {

/// All settings of footingd.
struct Config {
  std::vector<std::string> listen;   ///< Empty: the default address of "sensor".
  std::vector<std::string> sources;  ///< Empty: hid, and stream: at the default of "devices".
  /// Let every user of this host attach simulated devices: a source may be stream:tcp:.
  bool tcp_devices = false;
  devices::ConnectionLimits device_connections;
  /// Serial to "rig/role"; overrides what a simulated device requests.
  std::map<std::string, std::string> roles;
  std::string default_rig = "main";
  double tick_rate_hz = 100;
  double stale_after_s = 0.5;  ///< A live device without data for this time is stale.
  board::PlateConfig plate;
  double local_gravity_mps2 = kStandardGravityMps2;  ///< Where the boards stand.
  /// Empty: see setup::StatePath. "none": nothing is kept between runs.
  std::string state_directory;
  bool motion_plus = true;        ///< Look for MotionPlus and use it.
  bool camera = false;            ///< Switch the infrared cameras of Wiimotes on.
  double status_interval_s = 60;  ///< Between requests for the status of devices; 0: never.
  transport::SessionLimits sessions;
  transport::AccessSettings access;
  std::string metrics;  ///< Where metrics are served (MetricsEndpoint); empty: nowhere.

  void Bind(config::Binder& binder);
};

/// Usage error for what no single key can show: an address or source of the wrong form, a border of
/// contact below the one that ends it.
Result<void> Check(const Config& config);

/// The address of a source "stream:ADDRESS"; none for "hid".
Result<std::optional<transport::Address>> ParseSource(const std::string& text);

}  // namespace footing::sensor
