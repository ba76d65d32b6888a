#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/cli/server.h"
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
  std::string features = "best";  ///< Method of features::Named: best or paper.
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

/// Whether the devices of this source come within sessions, by the rules of all clients: those over
/// TLS, over TCP beyond this host, and over a passed socket of TCP.
bool ComesBySession(const transport::Address& source);

/// The addresses of those sources; empty: no session may attach devices.
std::vector<std::string> SessionSources(const Config& config);

/// Where it listens for sessions: `listen`, and the sources whose devices come within one.
std::vector<std::string> SessionAddresses(const Config& config);

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

/// Settings by which a recording is replayed, JSON: the method of the features. Empty if that is
/// the default.
std::string EffectiveConfig(const Config& config);

/// The features that an EffectiveConfig of a recording names; "best" where it names none.
std::string FeaturesIn(const std::string& effective_config);

/// The channels that footingd publishes; a channel is one field of v1::Tick. `config` comes only
/// with an EffectiveConfig.
std::vector<transport::Channel> Channels();

/// Each channel that has something to say, serialised once for all sessions.
std::vector<transport::ChannelBytes> ToChannels(const TickContent& content);

/// footingd, as its help describes it.
cli::ServerProgram Program();

/// The config of a command line: defaults < file < --set < options of their own. Prints and checks
/// what the command line asks for.
Result<Config> ReadConfig(const cli::ServerLine& line);

}  // namespace footing::sensor
