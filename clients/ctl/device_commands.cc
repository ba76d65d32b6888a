#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/live_screen.h"
#include "clients/ctl/report/server_table.h"
#include "common/cli/cli.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

constexpr double kScreenEveryS = 0.25;
constexpr double kLineEveryS = 1;
constexpr double kNoticeS = 5;  // For this time watch shows what slows the server.
constexpr double kForeverS = 1e6;
constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

Result<void> Devices(Session& session, const Shared& shared) {
  const auto& devices = session.status();
  Print({{"devices", display::DevicesToJson(devices)}}, display::DeviceTable(devices), shared);
  if (devices.empty())
    return NoDevice(
        "footingd has no device: pair one with footing-ctl pair, or run footing-ctl doctor");
  return {};
}

/// The devices and their setup, or how to get some; other servers than footingd have none.
std::string DevicesText(const Session& session) {
  if (session.welcome().server_id() != "footingd") return "";
  const auto& devices = session.status();
  return "\n" +
         (devices.empty() ? "no device: run footing-ctl setup, or pair one with footing-ctl pair\n"
                          : display::DeviceTable(devices)) +
         "\n" + display::SetupTable(session.setup());
}

Result<void> Status(Session& session, const Shared& shared) {
  const v1::Welcome& welcome = session.welcome();
  const v1::Limits& limits = welcome.limits();
  ordered_json devices = ordered_json::array();
  for (const stream::DeviceStatus& device : session.status()) {
    devices.push_back({{"device", device.device},
                       {"serial", device.serial},
                       {"kind", stream::Name(device.kind)},
                       {"rig", device.rig},
                       {"role", stream::Name(device.role)},
                       {"state", stream::Name(device.state)},
                       {"simulated", device.simulated},
                       {"note", device.note}});
  }
  const auto& stats = session.stats();
  const std::string notice = session.TakeNotice();
  const ordered_json out{{"server", welcome.server_id()},
                         {"version", welcome.version()},
                         {"epoch", welcome.epoch()},
                         {"protocol", std::to_string(welcome.protocol_major()) + "." +
                                          std::to_string(welcome.protocol_minor())},
                         {"granted_role", v1::Role_Name(welcome.granted_role())},
                         {"limits",
                          {{"tick_rate_hz", limits.tick_rate_hz()},
                           {"ring_s", limits.ring_s()},
                           {"max_queue_ticks", limits.max_queue_ticks()},
                           {"max_message_in_bytes", limits.max_message_in_bytes()},
                           {"max_message_out_bytes", limits.max_message_out_bytes()}}},
                         {"setup", display::SetupToJson(session.setup())},
                         {"devices", std::move(devices)},
                         {"notice", notice},
                         {"stats", stats ? display::ServerStatsToJson(*stats) : ordered_json()}};
  Print(out,
        session.link() + ", " + ordered_json(limits.tick_rate_hz()).dump() + " ticks per second\n" +
            (notice.empty() ? "" : "NOTICE: " + notice + "\n") +
            (stats ? display::ServerLine(*stats) + "\n\n" + display::SessionTable(*stats) : "") +
            DevicesText(session),
        shared);
  return {};
}

Result<void> Watch(Session& session, double seconds, const Shared& shared) {
  display::Live live;
  session.set_on_tick([&](const v1::Tick& tick) {
    for (const auto& sample : tick.motion().samples()) live.Take(wire::FromProto(sample));
    for (const auto& sample : tick.nunchuk().samples()) live.Take(wire::FromProto(sample));
    for (const auto& sample : tick.gamepad().samples()) live.Take(wire::FromProto(sample));
    for (const auto& sample : tick.boards().samples()) live.Take(wire::FromProto(sample));
  });
  const bool screen = !shared.json && isatty(STDOUT_FILENO) == 1;
  const double every_s = screen ? kScreenEveryS : kLineEveryS;
  const double whole_s = seconds > 0 ? seconds : kForeverS;
  double passed_s = 0, noticed_s = 0;
  Waited waited = Waited::kTimeUp;
  while (waited != Waited::kInterrupted && passed_s < whole_s) {
    const double step_s = std::min(every_s, whole_s - passed_s);
    waited = session.RunFor(step_s);
    passed_s += step_s;
    live.devices = session.status();
    live.link = session.link();
    live.lost = !session.live();
    live.server = session.stats();
    if (std::string notice = session.TakeNotice(); !notice.empty()) {
      live.notice = std::move(notice);
      noticed_s = passed_s;
    } else if (!shared.json && passed_s - noticed_s > kNoticeS) {
      live.notice.clear();
    }
    if (screen) {
      std::cout << kHomeAndClear << display::LiveScreen(live) << "\nCtrl-C leaves." << std::endl;
    } else if (!shared.json) {
      std::cout << display::LiveLine(live) << std::endl;
    }
  }
  session.set_on_tick({});
  if (shared.json) Print(display::LiveToJson(live, passed_s), "", shared);
  return {};
}

}  // namespace

void AddDeviceCommands(CLI::App& app, Shared& shared) {
  CLI::App* devices = app.add_subcommand("devices", "List the devices of footingd");
  devices->footer("Examples:\n  footing-ctl devices\n  footing-ctl devices --json");
  devices->callback([&shared] {
    WithSession(shared, {"status"}, [&](Session& session) { return Devices(session, shared); });
  });

  CLI::App* status = app.add_subcommand(
      "status", "Print the state of footingd, its sessions, its devices and their setup");
  status->footer("Example:\n  footing-ctl status --json");
  status->callback([&shared] {
    WithSession(shared, {"status", "setup", "stats"},
                [&](Session& session) { return Status(session, shared); });
  });

  const auto seconds = std::make_shared<double>(0);
  CLI::App* watch = app.add_subcommand("watch", "Show rates, batteries and forces live");
  watch->add_option("--seconds", *seconds, "Duration, s (default: until Ctrl-C)")
      ->check(CLI::Range(0.1, 1e5));
  watch->footer("Examples:\n  footing-ctl watch\n  footing-ctl watch --seconds 5 --json");
  watch->callback([seconds, &shared] {
    WithSession(shared, {"status", "motion", "nunchuk", "gamepad", "boards", "stats"},
                [&](Session& session) { return Watch(session, *seconds, shared); });
  });
}

}  // namespace footing::ctl
