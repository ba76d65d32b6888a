#include "daemon/sensor/service/config.h"

#include "common/net/metrics_endpoint.h"
#include "daemon/sensor/service/binding.h"

namespace footing::sensor {

void Config::Bind(config::Binder& binder) {
  binder.TextList("listen", listen,
                  "Addresses for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  binder.TextList("sources", sources,
                  "Sources of devices: hid, or stream:ADDRESS for simulated devices");
  binder.Flag("tcp_devices", tcp_devices,
              "Allow stream:tcp:HOST:PORT as a source: then every user of this host may attach "
              "simulated devices");
  binder.Integer("max_device_connections", device_connections.max_connections, 1, 1000,
                 "Connections to the device socket at once; 8 more for the server's own user and "
                 "root");
  binder.Integer("max_device_connections_per_user", device_connections.max_connections_per_user, 1,
                 1000,
                 "Connections of one user to the device socket, without those of the server's own "
                 "user and root; all those over TCP count as one user's");
  binder.TextMap("roles", roles,
                 "Rig and role of each serial, e.g. {\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}",
                 [](const std::string& text) {
                   const auto binding = ParseBinding(text);
                   return binding ? std::string() : binding.error().message;
                 });
  binder.Text("default_rig", default_rig, "Rig of unassigned devices");
  binder.Number("tick_rate_hz", tick_rate_hz, 10, 200, "Tick rate, Hz");
  binder.Number("stale_after_s", stale_after_s, 0.1, 10,
                "Time without data after which a device is stale, s");
  binder.Number("board_sensor_distance_x_m", plate.geometry.sensor_distance_x_m,
                board::kLeastLengthM, board::kMostLengthM,
                "Distance between a board's left and right sensors, m");
  binder.Number("board_sensor_distance_y_m", plate.geometry.sensor_distance_y_m,
                board::kLeastLengthM, board::kMostLengthM,
                "Distance between a board's front and rear sensors, m");
  binder.Number("board_contact_on_n", plate.contact_on_n, 1, 500,
                "Force above which a board reports contact, N");
  binder.Number("board_contact_off_n", plate.contact_off_n, 1, 500,
                "Force below which a board reports no contact and no COP, N");
  binder.Number("local_gravity_mps2", local_gravity_mps2, 9.76, 9.84,
                "Local gravity at the boards, m/s2; forces are scaled by it");
  binder.Text("state_directory", state_directory,
              "Folder of the stored setup; empty: $STATE_DIRECTORY, else $XDG_STATE_HOME/footing, "
              "else ~/.local/state/footing; none: store nothing");
  binder.Flag("motion_plus", motion_plus, "Detect and use MotionPlus");
  binder.Flag("camera", camera, "Enable the infrared cameras of Wiimotes");
  binder.Number("status_interval_s", status_interval_s, 0, 3600,
                "Interval of status requests to devices, s (0: never)");
  access.Bind(binder);
  binder.Text("metrics", metrics,
              "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH (empty: "
              "none)");
  sessions.Bind(binder);
}

Result<std::optional<transport::Address>> ParseSource(const std::string& text) {
  static const std::string kPrefix = "stream:";
  if (text == "hid") return std::optional<transport::Address>();
  if (!text.starts_with(kPrefix)) {
    return UsageError("unknown source \"" + text + "\"; there are: hid, stream:ADDRESS");
  }
  const auto address = transport::ParseAddress(text.substr(kPrefix.size()));
  if (!address) return address.error();
  return std::optional(*address);
}

Result<void> Check(const Config& config) {
  for (const std::string& text : config.listen) {
    if (const auto address = transport::ParseAddress(text); !address) return address.error();
  }
  for (const std::string& text : config.sources) {
    const auto source = ParseSource(text);
    if (!source) return source.error();
    if (*source && (*source)->kind == transport::Address::Kind::kTcp && !config.tcp_devices) {
      return UsageError("source " + text +
                        ": over TCP every user of this host may attach devices; use "
                        "stream:unix:PATH, or allow it with --set tcp_devices=true");
    }
  }
  if (const auto rig = CheckRig(config.default_rig); !rig) {
    return UsageError("config: default_rig: " + rig.error().message);
  }
  if (const auto access = config.access.Check(); !access) return access;
  if (!config.metrics.empty()) {
    if (auto checked = monitoring::MetricsEndpoint::Check(config.metrics); !checked) return checked;
  }
  if (config.plate.contact_on_n < config.plate.contact_off_n) {
    return UsageError("config: board_contact_on_n must not be below board_contact_off_n");
  }
  return {};
}

}  // namespace footing::sensor
