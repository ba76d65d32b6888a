#include "daemon/sensor/service/config.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/net/address.h"
#include "common/net/device_link.h"
#include "common/net/metrics_endpoint.h"
#include "common/net/monitoring.h"
#include "common/runtime/config.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/wire/wire.h"
#include "daemon/sensor/features/config.h"
#include "daemon/sensor/service/device.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::sensor {

void Config::Bind(config::Binder& binder) {
  binder.TextList("listen", listen,
                  "Addresses for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  binder.TextList("sources", sources,
                  "Sources of devices: hid, or stream:ADDRESS for simulated devices and trackers; "
                  "stream:tls:HOST:PORT takes those of other hosts, from clients with the role "
                  "control");
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
  binder.Text("features", features,
              "Method of the features: best, or paper for equations 3 and 4 as the gait paper "
              "prints them");
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

bool ComesBySession(const transport::Address& source) {
  if (source.kind == transport::Address::Kind::kPassed) {
    sockaddr_storage name{};
    socklen_t size = sizeof(name);
    const int passed = service_manager::PassedSocket(source.path);
    return passed >= 0 && getsockname(passed, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
           name.ss_family != AF_UNIX;
  }
  return device_link::BySession(source);
}

std::vector<std::string> SessionSources(const Config& config) {
  std::vector<std::string> addresses;
  for (const std::string& text : config.sources) {
    const auto source = ParseSource(text);
    if (source && *source && ComesBySession(**source)) addresses.push_back((*source)->Text());
  }
  return addresses;
}

std::vector<std::string> SessionAddresses(const Config& config) {
  std::vector<std::string> addresses = config.listen;
  for (const std::string& address : SessionSources(config)) {
    const bool there = std::find(addresses.begin(), addresses.end(), address) != addresses.end();
    if (!there) addresses.push_back(address);
  }
  return addresses;
}

Result<void> Check(const Config& config) {
  for (const std::string& text : config.listen) {
    if (const auto address = transport::ParseAddress(text); !address) return address.error();
  }
  for (const std::string& text : config.sources) {
    const auto source = ParseSource(text);
    if (!source) return source.error();
    const bool in_clear = *source && (*source)->kind == transport::Address::Kind::kTcp;
    if (in_clear && !ComesBySession(**source) && !config.tcp_devices) {
      return UsageError("source " + text +
                        ": over TCP every user of this host may attach devices; use "
                        "stream:unix:PATH, or allow it with --set tcp_devices=true");
    }
  }
  if (const auto rig = CheckRig(config.default_rig); !rig) {
    return UsageError("config: default_rig: " + rig.error().message);
  }
  if (!features::Named(config.features)) {
    return UsageError("unknown --features " + config.features + "; there are: best, paper");
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

Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say) {
  Config next = before;
  next.stale_after_s = wanted.stale_after_s;
  next.default_rig = wanted.default_rig;
  next.motion_plus = wanted.motion_plus;
  next.camera = wanted.camera;
  next.status_interval_s = wanted.status_interval_s;
  next.sessions = wanted.sessions;
  next.access.token_file = wanted.access.token_file;
  next.access.view_token_file = wanted.access.view_token_file;
  next.access.clients_file = wanted.access.clients_file;
  for (const auto& line : config::DescribeReload(before, next, wanted, changed_files)) say(line);
  return next;
}

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

Result<void> CheckStart(const Config& config) {
  return AccessOf(config).CheckStart(SessionAddresses(config));
}

transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version,
                                           const transport::ServerOptions& with_access) {
  transport::ServerOptions options = with_access;
  options.server_id = "footingd";
  options.version = version;
  options.channels = Channels();
  if (!EffectiveConfig(config).empty()) {
    options.channels.push_back({"config", v1::Tick::kConfigFieldNumber, true});
  }
  options.channels.push_back(monitoring::StatsChannel());
  options.tick_rate_hz = config.tick_rate_hz;
  options.sessions = config.sessions;
  options.capabilities = {"features", "boards", "raw",      "rumble", "leds",   "assign",
                          "nunchuk",  "camera", "sphere",   "setup",  "tare",   "mounting",
                          "layout",   "hands",  "contacts", "lease",  "markers"};
  options.takes_markers = true;
  if (!SessionSources(config).empty()) options.capabilities.push_back("devices");
  return options;
}

std::string EffectiveConfig(const Config& config) {
  if (config.features == Config().features) return "";
  return nlohmann::json{{"program", "footingd"}, {"settings", {{"features", config.features}}}}
      .dump();
}

std::string FeaturesIn(const std::string& effective_config) {
  return text::SettingIn(effective_config, "features").value_or(Config().features);
}

namespace {

using v1::Tick;

template <typename List>
void Append(std::vector<transport::ChannelBytes>& channels, int field, const List& list) {
  channels.push_back({static_cast<std::uint32_t>(field), list.SerializeAsString()});
}

/// A channel of one repeated message; none when there is nothing in it.
template <typename Values, typename List, typename Element>
void AppendList(std::vector<transport::ChannelBytes>& channels, int field, const Values& values,
                Element* (List::*add)()) {
  if (values.empty()) return;
  List list;
  for (const auto& value : values) *(list.*add)() = wire::ToProto(value);
  Append(channels, field, list);
}

}  // namespace

std::vector<transport::Channel> Channels() {
  return {{"status", Tick::kStatusFieldNumber, true},
          {"motion", Tick::kMotionFieldNumber, false},
          {"features", Tick::kFeaturesFieldNumber, false},
          {"boards", Tick::kBoardsFieldNumber, false},
          {"raw", Tick::kRawFieldNumber, false},
          {"nunchuk", Tick::kNunchukFieldNumber, false},
          {"camera", Tick::kCameraFieldNumber, false},
          {"events", Tick::kEventsFieldNumber, false},
          {"setup", Tick::kSetupFieldNumber, true},
          {"hands", Tick::kHandsFieldNumber, false},
          {"reference", Tick::kReferenceFieldNumber, false},
          {"contacts", Tick::kContactsFieldNumber, false},
          {"gamepad", Tick::kGamepadFieldNumber, false}};
}

std::vector<transport::ChannelBytes> ToChannels(const TickContent& content) {
  std::vector<transport::ChannelBytes> channels;
  if (content.has_status) {
    v1::DeviceStatusList list;
    for (const auto& status : content.status) *list.add_devices() = wire::ToProto(status);
    Append(channels, Tick::kStatusFieldNumber, list);
  }
  AppendList(channels, Tick::kMotionFieldNumber, content.motion, &v1::MotionSamples::add_samples);
  AppendList(channels, Tick::kFeaturesFieldNumber, content.features, &v1::FeatureFrame::add_rigs);
  AppendList(channels, Tick::kBoardsFieldNumber, content.boards, &v1::BoardSamples::add_samples);
  if (content.has_setup) {
    v1::SetupState state;
    for (const auto& rig : content.setup) *state.add_rigs() = wire::ToProto(rig);
    Append(channels, Tick::kSetupFieldNumber, state);
  }
  AppendList(channels, Tick::kNunchukFieldNumber, content.nunchuks,
             &v1::NunchukSamples::add_samples);
  AppendList(channels, Tick::kGamepadFieldNumber, content.gamepads,
             &v1::GamepadSamples::add_samples);
  AppendList(channels, Tick::kCameraFieldNumber, content.cameras, &v1::CameraSamples::add_samples);
  AppendList(channels, Tick::kHandsFieldNumber, content.hands, &v1::HandSamples::add_samples);
  AppendList(channels, Tick::kReferenceFieldNumber, content.reference,
             &v1::ReferencePoses::add_poses);
  AppendList(channels, Tick::kContactsFieldNumber, content.contacts,
             &v1::ContactSamples::add_samples);
  AppendList(channels, Tick::kRawFieldNumber, content.raw, &v1::RawReports::add_reports);
  if (!content.config.empty()) {
    v1::EffectiveConfig config;
    config.set_json(content.config);
    Append(channels, Tick::kConfigFieldNumber, config);
  }
  return channels;
}

cli::ServerProgram Program() {
  using Kind = cli::KeyOption::Kind;
  return {"footingd",
          "Sensor daemon: reads devices, publishes samples, features and forces.",
          "  footingd\n"
          "  footingd --source stream:unix:/tmp/devices.sock\n"
          "  footingd --source hid --source stream:tls:192.168.1.5:7432 --set token_file=token\n"
          "  footingd --features paper\n"
          "  footingd --set 'roles={\"00:1f:32:aa:bb:cc\": \"main/left_hand\"}'\n",
          {{"--source", "sources",
            "Source of devices: hid, or stream:ADDRESS for simulated devices (of other hosts: "
            "stream:tls:HOST:PORT); may be repeated",
            Kind::kList},
           {"--features", "features",
            "Method of the features: best, or paper for equations 3 and 4 of the gait paper as "
            "printed (default: best)"},
           {"--metrics", "metrics",
            "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH"},
           {"--insecure-lan", "insecure_lan",
            "Allow --listen tcp: beyond this host WITHOUT ENCRYPTION; needs --set token_file=FILE",
            Kind::kFlag}}};
}

Result<Config> ReadConfig(const cli::ServerLine& line) {
  Config config;
  config::Binder binder;
  config.Bind(binder);
  if (const auto done = line.Apply(binder); !done) return done.error();
  if (const auto done = Check(config); !done) return done.error();
  line.PrintIfAsked(binder);
  if (!line.check) return config;
  const auto checked = CheckStart(config);
  return checked ? Result<Config>(config) : checked.error();
}

}  // namespace footing::sensor
