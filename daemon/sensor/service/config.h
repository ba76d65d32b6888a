#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/net/access.h"
#include "common/net/address.h"
#include "common/net/limits.h"
#include "common/net/server.h"
#include "common/runtime/config.h"
#include "daemon/sensor/devices/socket_source.h"
#include "daemon/sensor/service/device.h"

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

/// `before` with those settings of `wanted` that footingd takes while it runs. `say` gets a line
/// with what changed, and one with what needs a restart.
///
/// `changed_files`: settings whose files have another content. The limits of sessions hold for
/// sessions that come; stale_after_s, the token files and clients_file hold at once; default_rig,
/// motion_plus, camera and status_interval_s for devices that attach.
Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say);

/// The socket that the service manager passed under this name, or the user's own.
std::string OwnAddress(const std::string& name);

/// Who may come over TCP and TLS; a configured state_directory has the certificate, too.
transport::AccessSettings AccessOf(const Config& config);

/// Checks of the start besides the config itself, without its sockets and devices.
Result<void> CheckStart(const Config& config);

/// `with_access`: who may come in.
transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version,
                                           const transport::ServerOptions& with_access);

/// The channels that footingd publishes; a channel is one field of v1::Tick.
std::vector<transport::Channel> Channels();

/// Each channel that has something to say, serialised once for all sessions.
std::vector<transport::ChannelBytes> ToChannels(const TickContent& content);

/// Request on the command line.
struct CommandLine {
  Config config;
  bool json = false;  ///< One JSON object on standard output once it listens.
};

/// Parses it and reads the config: defaults < file < --set < flags of their own. Without a value
/// the program ends with `exit_code`: help, version, --print-config, --check-config or an error,
/// already printed.
std::optional<CommandLine> ParseCommandLine(int argc, char** argv, int& exit_code);

/// The config of the same command line once more, with what its file has now.
Result<Config> ReadConfigAgain(int argc, char** argv);

}  // namespace footing::sensor
