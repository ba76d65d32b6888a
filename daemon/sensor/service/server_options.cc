#include "daemon/sensor/service/server_options.h"

#include "common/net/monitor.h"
#include "common/runtime/service_manager.h"
#include "common/net/address.h"
#include "daemon/sensor/service/publish.h"

namespace footing::sensor {

std::string OwnAddress(const std::string& name) {
  if (service_manager::PassedSocket(name) >= 0) return "fd:" + name;
  return transport::DefaultAddress(name, true).Text();
}

transport::AccessSettings AccessOf(const Config& config) {
  transport::AccessSettings access = config.access;
  const bool own_state = !config.state_directory.empty() && config.state_directory != "none";
  if (access.identity_file.empty() && own_state) {
    access.identity_file = config.state_directory + "/identity.pem";
  }
  return access;
}

Result<void> CheckStart(const Config& config) { return AccessOf(config).CheckStart(config.listen); }

transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version,
                                           const transport::ServerOptions& with_access) {
  transport::ServerOptions options = with_access;
  options.server_id = "footingd";
  options.version = version;
  options.channels = Channels();
  options.channels.push_back(monitoring::StatsChannel());
  options.tick_rate_hz = config.tick_rate_hz;
  options.sessions = config.sessions;
  options.capabilities = {"features", "boards", "raw",      "rumble", "leds", "assign",
                          "nunchuk",  "camera", "sphere",   "setup",  "tare", "mounting",
                          "layout",   "hands",  "contacts", "lease"};
  return options;
}

}  // namespace footing::sensor
