#include "clients/ctl/commands.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "clients/ctl/guided.h"
#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/live_screen.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"
#include "common/net/address.h"
#include "common/net/discovery.h"
#include "common/runtime/child.h"
#include "common/runtime/files.h"
#include "common/runtime/subject.h"
#include "common/stream/leg_turn.h"
#include "common/stream/user_interface.h"
#include "common/wire/wire.h"

namespace footing::ctl {

Result<std::unique_ptr<Connection>> Open(const Shared& shared, std::vector<std::string> channels) {
  ConnectionOptions options;
  options.channels = std::move(channels);
  const auto address = transport::AddressOrDefault(shared.connect, "sensor");
  if (!address) return address.error();
  options.address = *address;
  return Connection::Open(std::move(options));
}

void Print(const nlohmann::ordered_json& out, const std::string& text, const Shared& shared) {
  using nlohmann::ordered_json;
  std::cout << (shared.json ? text::ToText(out) : text) << std::endl;
}

void AddRemark(const v1::CommandResult& result, nlohmann::ordered_json& out, std::string& text) {
  if (result.message().empty()) return;
  out["message"] = result.message();
  text += "; " + result.message();
}

void WithSession(Shared& shared, const std::vector<std::string>& channels,
                 const std::function<Result<void>(Connection&)>& body) {
  const auto session = Open(shared, channels);
  if (!session) {
    shared.exit_code = cli::Report(session.error());
    return;
  }
  if (const Result<void> done = body(**session); !done) {
    shared.exit_code = cli::Report(done.error());
  }
}

Result<std::unique_ptr<Connection>> OpenSimulation(const Shared& shared,
                                                   std::vector<std::string> channels,
                                                   const std::string& start_with) {
  Shared simulation = shared;
  if (simulation.connect.empty()) {
    simulation.connect = transport::DefaultAddress("simulation").Text();
  }
  auto session = Open(simulation, std::move(channels));
  if (!session && session.error().kind != ErrorKind::kNoDevice) return session.error();
  if (!session) {
    // Its own remedy is about footingd.
    const std::string& message = session.error().message;
    const std::string why = message.substr(0, message.find("; "));
    const std::string start = "start it with: " + start_with + ", or name it with --connect";
    return NoDevice("no footing-sim on " + simulation.connect + transport::RemedyFor(why, start));
  }
  return session;
}

Result<void> SendToSimulation(const Shared& shared, v1::Command command,
                              const std::string& start_with) {
  // The skeletons are published to whoever comes.
  const auto session = OpenSimulation(shared, {"skeletons"}, start_with);
  if (!session) return session.error();
  if (const auto done = (*session)->Call(std::move(command)); !done) return done.error();
  return {};
}

void AddAssignCommand(CLI::App& app, Shared& shared) {
  struct Arguments {
    std::string device, rig_role;
    std::string rig = "main";
    std::vector<std::string> body_roles;
    bool gesture = false;
    bool script = false;
  };
  const auto given = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("assign", "Assign a device to a rig and a role");
  command->add_option("DEVICE", given->device, "Serial, number, RIG/ROLE or ROLE");
  command->add_option("ROLE", given->rig_role, "RIG/ROLE, or ROLE in the default rig");
  command->add_flag("--gesture", given->gesture,
                    "Identify devices by stepping on boards and shaking remotes");
  command->add_option("--rig", given->rig, "Rig of --gesture (default main)");
  command
      ->add_option("--worn", given->body_roles,
                   "Roles of the remotes for --gesture, such as left_leg,right_leg")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--script", given->script,
                    "Print the prompts of --gesture as lines PROMPT: ...");
  command->footer(
      "A role that is taken is swapped with the device's own.\n"
      "Example:\n  footing-ctl assign 00:1f:32:aa:bb:cc main/left_hand\n"
      "  footing-ctl assign --gesture --worn left_leg,right_leg");
  command->callback([given, &shared] {
    if (given->gesture) {
      const auto roles = BodyRoles(given->body_roles);
      if (!roles) {
        shared.exit_code = cli::Report(roles.error());
        return;
      }
      WithSession(shared, GuidedChannels(), [&](Connection& session) {
        return AssignByGesture(session, given->rig, *roles, given->script, shared);
      });
      return;
    }
    if (given->device.empty() || given->rig_role.empty()) {
      shared.exit_code = cli::Report(
          UsageError("assign takes DEVICE and ROLE, or --gesture; see footing-ctl assign --help"));
      return;
    }
    if (const auto role = display::ParseRigRole(given->rig_role); !role) {
      shared.exit_code = cli::Report(role.error());
      return;
    }
    WithSession(shared, {"status"}, [&](Connection& session) {
      return Assign(session, given->device, given->rig_role, shared);
    });
  });
}

namespace {

struct ConfigOptions {
  std::string of = "footingd";
  std::string file;
  bool origin = false;
};

/// Becomes the server, which prints its config and ends; only an error comes back.
Error ShowConfig(const ConfigOptions& options, const Shared& shared) {
  if (!shared.connect.empty()) {
    return UsageError(
        "config connects to no server: it shows the config that one would start with; leave "
        "--connect out");
  }
  const auto beside = process::Beside(options.of);
  if (!beside) return beside.error();
  const std::string& program = *beside;
  std::vector<std::string> words{program, "--print-config"};
  if (!options.file.empty()) words.insert(words.end(), {"--config", options.file});
  if (options.origin) words.push_back("--origin");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return Failure("cannot start " + program + ": " + std::strerror(errno) +
                 "; install it, or run its own --print-config where it is");
}

}  // namespace

void AddConfigCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ConfigOptions>();
  CLI::App* config = app.add_subcommand("config", "Show the config of a server");
  config->require_subcommand(1);
  CLI::App* show =
      config->add_subcommand("show", "Print the config that a server would start with, JSON");
  show->add_option("--of", options->of, "Server: footingd or footing-sim")
      ->check(CLI::IsMember({"footingd", "footing-sim"}))
      ->capture_default_str();
  show->add_option("--config", options->file, "Config file, JSON (default: none)");
  show->add_flag("--origin", options->origin,
                 "Where each value comes from, too (default, FILE:LINE)");
  const std::string examples =
      "Examples:\n"
      "  footing-ctl config show --origin\n"
      "  footing-ctl config show --of footing-sim";
  config->footer(examples);
  show->footer(examples);
  show->callback(
      [options, &shared] { shared.exit_code = cli::Report(ShowConfig(*options, shared)); });
}

namespace {

using nlohmann::ordered_json;
using stream::DeviceStatus;

constexpr std::uint32_t kLeaseMs =
    500;  // Renewed at half its time; the rumble ends that long after this program at the latest.
constexpr double kTareWithinS = 10;  // It looks at the last seconds only; generous for a busy host.
constexpr double kShownWithinS = 2;

/// Four digits 0 and 1, first lamp first, into bits 0 to 3.
std::optional<std::uint32_t> ParseLeds(const std::string& text) {
  if (text.size() != 4) return std::nullopt;
  std::uint32_t leds = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (text[i] != '0' && text[i] != '1') return std::nullopt;
    if (text[i] == '1') leds |= 1u << i;
  }
  return leds;
}

Result<void> Rumble(Connection& session, const std::string& name, double seconds,
                    const Shared& shared) {
  const auto device = session.Find(name);
  if (!device) return device.error();
  const auto set = [&](bool on) {
    v1::Command command;
    command.mutable_set_rumble()->set_device(device->device);
    command.mutable_set_rumble()->set_on(on);
    command.mutable_set_rumble()->set_lease_ms(kLeaseMs);
    return session.Call(std::move(command));
  };
  constexpr double kRenewS = kLeaseMs * 1e-3 / 2;
  for (double left_s = seconds; left_s > 0; left_s -= kRenewS) {
    if (const auto done = set(true); !done) return done.error();
    if (session.RunFor(std::min(left_s, kRenewS)) == Waited::kInterrupted) break;
  }
  if (const auto done = set(false); !done) return done.error();
  Print({{"device", device->device}, {"serial", device->serial}, {"seconds", seconds}},
        device->serial + " rumbled for " + ordered_json(seconds).dump() + " s", shared);
  return {};
}

Result<void> CheckLight(const std::string& light) {
  if (ParseLeds(light) || frames::ParseColour(light)) return {};
  return UsageError(light + " is neither four LEDs such as 1010 nor a colour such as #00ff40");
}

Result<void> Led(Connection& session, const std::string& name, const std::string& light,
                 const Shared& shared) {
  const auto leds = ParseLeds(light);
  const auto colour = frames::ParseColour(light);
  const auto device = session.Find(name);
  if (!device) return device.error();
  const bool move = device->kind == stream::DeviceKind::kPsMove;
  if (colour.has_value() != move) {
    return UsageError(device->serial + (move ? " is a PS Move: give a colour such as #00ff40"
                                             : " has four LEDs, not a colour: write them as 1010"));
  }
  v1::Command command;
  if (move) {
    command.mutable_set_sphere()->set_device(device->device);
    command.mutable_set_sphere()->set_rgb(*colour);
  } else {
    command.mutable_set_leds()->set_device(device->device);
    command.mutable_set_leds()->set_leds(*leds);
  }
  if (const auto done = session.Call(std::move(command)); !done) return done.error();
  Print({{"device", device->device}, {"serial", device->serial}, {"light", light}},
        device->serial + " shows " + light, shared);
  return {};
}

struct Tared {
  ordered_json out;
  std::string text;
};

Result<Tared> TareOne(Connection& session, const DeviceStatus& device, bool clear) {
  v1::Command command;
  command.mutable_tare()->set_serial(device.serial);
  command.mutable_tare()->set_clear(clear);
  const auto done = session.Call(std::move(command), kTareWithinS);
  if (!done) return done.error();
  Tared tared;
  tared.out = {{"device", device.device},
               {"serial", device.serial},
               {"cleared", clear},
               {"residual", done->residual()},
               {"unit", done->unit()}};
  tared.text = device.serial + (clear ? ": tare forgotten" : ": tared");
  if (!clear) tared.text += ", residual " + tared.out["residual"].dump() + " " + done->unit();
  AddRemark(*done, tared.out, tared.text);
  return tared;
}

/// All that are there. Those that are not tared are named, each with the reason.
Result<void> TareAll(Connection& session, bool clear, const Shared& shared) {
  const display::Boards boards = display::BoardsOf(session.status());
  if (boards.there.empty() && boards.lost.empty()) return NoDevice("footingd has no board");
  ordered_json tared = ordered_json::array(), missed = ordered_json::array();
  std::vector<std::string> texts, reasons;
  const auto miss = [&](const DeviceStatus& board, const std::string& reason) {
    missed.push_back({{"device", board.device},
                      {"serial", board.serial},
                      {"role", stream::Name(board.role)},
                      {"reason", reason}});
    reasons.push_back(board.serial + " (" + display::RigRole(board) + "): " + reason);
  };
  for (const DeviceStatus& board : boards.there) {
    const auto one = TareOne(session, board, clear);
    if (one) {
      texts.push_back(one->text);
      tared.push_back(one->out);
    } else {
      miss(board, one.error().message);
    }
  }
  const bool refused = !reasons.empty();
  for (const DeviceStatus& board : boards.lost) {
    miss(board, "lost; press its button, then run this command again");
  }
  if (shared.json || !texts.empty()) {
    Print({{"boards", tared}, {"not_tared", missed}}, text::Joined(texts, "\n"), shared);
  }
  if (reasons.empty()) return {};
  const std::string all =
      std::string(clear ? "tare not removed: " : "not tared: ") + text::Joined(reasons, "; ");
  return refused ? Failure(all) : NoDevice(all);
}

Result<void> Tare(Connection& session, const std::string& name, bool clear, const Shared& shared) {
  if (name == "all") return TareAll(session, clear, shared);
  const auto board = session.Find(name);
  if (!board) return board.error();
  if (board->kind != stream::DeviceKind::kBalanceBoard) {
    return UsageError(board->serial + " is not a Balance Board but a " + stream::Name(board->kind));
  }
  const auto tared = TareOne(session, *board, clear);
  if (!tared) return Failure(board->serial + ": " + tared.error().message);
  Print({{"boards", ordered_json::array({tared->out})}}, tared->text, shared);
  return {};
}

}  // namespace

Result<void> Assign(Connection& session, const std::string& name, const std::string& rig_role,
                    const Shared& shared) {
  const auto binding = display::ParseRigRole(rig_role);
  if (!binding) return binding.error();
  const auto device = session.Find(name);
  if (!device) return device.error();
  const std::vector<DeviceStatus> before = session.status();
  v1::Command command;
  command.mutable_assign_role()->set_serial(device->serial);
  command.mutable_assign_role()->set_rig(binding->first);
  command.mutable_assign_role()->set_role(static_cast<v1::DeviceRole>(binding->second));
  const auto done = session.Call(std::move(command));
  if (!done) return done.error();
  const auto now_is = [&]() -> const DeviceStatus* {
    for (const DeviceStatus& one : session.status()) {
      if (one.serial == device->serial && one.state != stream::DeviceState::kLost) return &one;
    }
    return nullptr;
  };
  // The list that shows it comes with one of the next ticks.
  session.RunUntil(
      [&] {
        const DeviceStatus* one = now_is();
        return one != nullptr && one->role == binding->second &&
               (binding->first.empty() || one->rig == binding->first);
      },
      kShownWithinS);
  const DeviceStatus* one = now_is();
  if (one == nullptr) return NoDevice(device->serial + " went away");
  ordered_json out = {{"device", one->device},
                      {"serial", one->serial},
                      {"rig", one->rig},
                      {"role", stream::Name(one->role)}};
  std::string text = one->serial + " is now " + display::RigRole(*one);
  for (const DeviceStatus& other : display::Reassigned(before, session.status())) {
    if (other.device == one->device) continue;
    out["swapped"] = {{"device", other.device},
                      {"serial", other.serial},
                      {"rig", other.rig},
                      {"role", stream::Name(other.role)}};
    text += ", " + other.serial + " is now " + display::RigRole(other);
  }
  AddRemark(*done, out, text);
  Print(out, text, shared);
  return {};
}

void AddControlCommands(CLI::App& app, Shared& shared) {
  struct Arguments {
    std::string device, light;
    double seconds = 1;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* rumble = app.add_subcommand("rumble", "Run the vibration motor of a device");
  rumble->add_option("DEVICE", arguments->device, "Serial, number, RIG/ROLE or ROLE")->required();
  rumble->add_option("--seconds", arguments->seconds, "Duration, s (default 1)")
      ->check(CLI::Range(0.05, 30.0));
  rumble->footer("Example:\n  footing-ctl rumble left_hand --seconds 2");
  rumble->callback([arguments, &shared] {
    WithSession(shared, {"status"}, [&](Connection& session) {
      return Rumble(session, arguments->device, arguments->seconds, shared);
    });
  });

  CLI::App* led = app.add_subcommand("led", "Set the LEDs of a device, or the colour of a PS Move");
  led->add_option("DEVICE", arguments->device, "Serial, number, RIG/ROLE or ROLE")->required();
  led->add_option("LIGHT", arguments->light,
                  "Four LEDs, such as 1010, or a colour, such as #00ff40")
      ->required();
  led->footer(
      "Examples:\n  footing-ctl led 00:1f:32:aa:bb:cc 1010\n  footing-ctl led head '#00ff40'");
  led->callback([arguments, &shared] {
    if (const auto light = CheckLight(arguments->light); !light) {
      shared.exit_code = cli::Report(light.error());
      return;
    }
    WithSession(shared, {"status"}, [&](Connection& session) {
      return Led(session, arguments->device, arguments->light, shared);
    });
  });

  const auto clear = std::make_shared<bool>(false);
  CLI::App* tare = app.add_subcommand("tare", "Set a board's zero while nobody stands on it");
  tare->add_option("BOARD", arguments->device, "Serial, number, RIG/ROLE or ROLE; or all")
      ->required();
  tare->add_flag("--clear", *clear, "Remove the tare");
  tare->footer("Examples:\n  footing-ctl tare all\n  footing-ctl tare left_board --clear");
  tare->callback([arguments, clear, &shared] {
    WithSession(shared, {"status"}, [&](Connection& session) {
      return Tare(session, arguments->device, *clear, shared);
    });
  });
}

namespace {

constexpr double kScreenEveryS = 0.25;
constexpr double kLineEveryS = 1;
constexpr double kNoticeS = 5;  // For this time watch shows what slows the server.
constexpr double kForeverS = 1e6;
constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

Result<void> Devices(Connection& session, const Shared& shared) {
  const auto& devices = session.status();
  Print({{"devices", display::DevicesToJson(devices)}}, display::DeviceTable(devices), shared);
  if (devices.empty())
    return NoDevice(
        "footingd has no device: pair one with footing-ctl pair, or run footing-ctl doctor");
  return {};
}

/// The devices and their setup, or how to get some; other servers than footingd have none.
std::string DevicesText(const Connection& session) {
  if (session.welcome().server_id() != "footingd") return "";
  const auto& devices = session.status();
  return "\n" +
         (devices.empty() ? "no device: run footing-ctl setup, or pair one with footing-ctl pair\n"
                          : display::DeviceTable(devices)) +
         "\n" + display::SetupTable(session.setup());
}

Result<void> Status(Connection& session, const Shared& shared) {
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

Result<void> Watch(Connection& session, double seconds, const Shared& shared) {
  display::Live live;
  session.set_on_tick([&](const v1::Tick& tick, const rig::Tick&) {
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
    WithSession(shared, {"status"}, [&](Connection& session) { return Devices(session, shared); });
  });

  CLI::App* status = app.add_subcommand(
      "status", "Print the state of footingd, its sessions, its devices and their setup");
  status->footer("Example:\n  footing-ctl status --json");
  status->callback([&shared] {
    WithSession(shared, {"status", "setup", "stats"},
                [&](Connection& session) { return Status(session, shared); });
  });

  const auto seconds = std::make_shared<double>(0);
  CLI::App* watch = app.add_subcommand("watch", "Show rates, batteries and forces live");
  watch->add_option("--seconds", *seconds, "Duration, s (default: until Ctrl-C)")
      ->check(CLI::Range(0.1, 1e5));
  watch->footer("Examples:\n  footing-ctl watch\n  footing-ctl watch --seconds 5 --json");
  watch->callback([seconds, &shared] {
    WithSession(shared, {"status", "motion", "nunchuk", "gamepad", "boards", "stats"},
                [&](Connection& session) { return Watch(session, *seconds, shared); });
  });
}

namespace {

Result<void> RunDiscover(double within_s, const Shared& shared) {
  const auto found = discovery::Browse(within_s);
  if (!found) return found.error();
  ordered_json servers = ordered_json::array();
  std::string text;
  for (const discovery::Found& one : *found) {
    const discovery::Service& service = one.service;
    servers.push_back({{"name", service.name},
                       {"program", service.program},
                       {"address", one.address.Text()},
                       {"fingerprint", service.fingerprint}});
    text += (text.empty() ? "" : "\n") + service.name + "  " + service.program + "  " +
            one.address.Text();
    if (!service.fingerprint.empty()) text += "\n  says that it has " + service.fingerprint;
  }
  if (text.empty()) {
    text = "no server advertises itself in this network; name its address with --connect";
  } else {
    text +=
        "\nAnyone in the network can say so: compare the fingerprint with what footing-ctl trust "
        "prints on the server.";
  }
  Print({{"servers", servers}}, text, shared);
  return {};
}

}  // namespace

void AddDiscoverCommand(CLI::App& app, Shared& shared) {
  auto within_s = std::make_shared<double>(3);
  CLI::App* command = app.add_subcommand(
      "discover", "List servers in this network that advertise themselves (needs avahi-daemon)");
  command->add_option("--seconds", *within_s, "Timeout, s")->check(CLI::Range(0.1, 60.0));
  command->footer(
      "Examples:\n"
      "  footing-ctl discover\n"
      "  footing-ctl discover --json");
  command->callback([within_s, &shared] {
    const auto done = RunDiscover(*within_s, shared);
    if (!done) shared.exit_code = cli::Report(done.error());
  });
}

namespace {

struct InterfaceOptions {
  std::string name, turn_by, table;
};

Result<v1::Command> CommandOf(const InterfaceOptions& options) {
  const stream::UserInterface interface = stream::UserInterfaceNamed(options.name);
  if (interface == stream::UserInterface::kUnspecified) {
    return UsageError("unknown interface " + options.name +
                      "; there are: " + stream::UserInterfaceNames());
  }
  v1::Command command;
  v1::SetInterface& set = *command.mutable_set_interface();
  set.set_character(1);
  set.set_interface(static_cast<v1::UserInterface>(interface));
  if (!options.table.empty()) {
    auto table = config::ReadTextFile(options.table);
    if (!table) return table.error();
    set.set_table(std::move(table).value());
  }
  if (options.turn_by.empty()) return command;
  const auto source = stream::LegTurnSourceNamed(options.turn_by);
  if (source == stream::TurnSource::kUnspecified) {
    return UsageError("unknown --turn-by " + options.turn_by + "; there are: head, feet, trunk");
  }
  set.set_turn_by(static_cast<v1::TurnSource>(source));
  return command;
}

Result<void> ChangeInterface(const InterfaceOptions& options, const Shared& shared) {
  auto command = CommandOf(options);
  if (!command) return command.error();
  const auto sent = SendToSimulation(shared, std::move(command).value(), "footing-sim");
  // The server does not know the file's name.
  if (!sent && sent.error().kind == ErrorKind::kFailure && !options.table.empty())
    return Failure("with --table " + options.table + ": " + sent.error().message);
  if (!sent) return sent;
  Print({{"interface", options.name}}, "the interface is " + options.name, shared);
  return {};
}

}  // namespace

void AddInterfaceCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<InterfaceOptions>();
  CLI::App* command = app.add_subcommand("interface", "Change the user interface between trials");
  command->add_option("NAME", options->name, "Interface: " + stream::UserInterfaceNames())
      ->required();
  command->add_option(
      "--turn-by", options->turn_by,
      "Body part that steers with the interface leg: head, feet or trunk (default: unchanged)");
  command->add_option("--table", options->table,
                      "Mapping table, such as one of footing-study ranges (default: the built-in "
                      "one)");
  command->footer(
      "Examples (connect to footing-sim):\n"
      "  footing-ctl interface arm\n"
      "  footing-ctl interface wrist --table P01_wrist.json\n"
      "  footing-ctl interface leg --turn-by trunk");
  command->callback([options, &shared] {
    if (const auto done = ChangeInterface(*options, shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

namespace {

constexpr double kFrameWithinS = 3;
constexpr double kLeaseS = 1;  // It is released at once.

/// The holder that the newest frame names; empty: nobody.
Result<std::string> ReadHolder(Connection& session) {
  std::optional<std::string> holder;
  session.set_on_tick([&](const v1::Tick& tick, const rig::Tick&) {
    if (tick.has_characters()) holder = tick.characters().lease_holder();
  });
  const Waited waited = session.RunUntil([&] { return holder.has_value(); }, kFrameWithinS);
  session.set_on_tick(nullptr);
  if (waited == Waited::kInterrupted) return Failure("stopped");
  if (!holder) return Failure("footing-sim publishes no frames: " + session.link());
  return std::move(*holder);
}

/// Takes the lease from whoever has it, and gives it back, so that anybody may take it.
Result<void> TakeOver(Connection& session) {
  v1::Command take;
  take.mutable_take_lease()->set_holder(cli::UserAtHost() + ", footing-ctl");
  take.mutable_take_lease()->set_seconds(kLeaseS);
  take.mutable_take_lease()->set_take_over(true);
  if (const auto taken = session.Call(std::move(take)); !taken) return taken.error();
  v1::Command release;
  release.mutable_release_lease();
  if (const auto released = session.Call(std::move(release)); !released) return released.error();
  return {};
}

Result<void> RunLease(bool take_over, const Shared& shared) {
  const auto session = OpenSimulation(shared, {"skeletons", "characters"}, "footing-sim");
  if (!session) return session.error();
  if ((*session)->welcome().server_id() == "footingd") {
    return UsageError(
        "lease: this address is footingd's; connect to footing-sim, or, to take over the lease of "
        "footingd, add --of footingd --take-over");
  }
  const auto holder = ReadHolder(**session);
  if (!holder) return holder.error();
  if (take_over) {
    if (const auto done = TakeOver(**session); !done) return done;
  }
  Print({{"holder", take_over ? "" : *holder}, {"taken_from", take_over ? *holder : ""}},
        holder->empty() ? "nobody has the lease"
        : take_over     ? "the lease was taken over from " + *holder + "; now nobody has it"
                        : *holder + " has the lease",
        shared);
  return {};
}

Result<void> TakeOverFootingd(bool take_over, const Shared& shared) {
  if (!take_over) {
    return UsageError(
        "lease: footingd does not publish who has its lease; a command that it refuses names the "
        "holder. To take the lease over add --take-over");
  }
  const auto session = Open(shared);
  if (!session) return session.error();
  if (const auto done = TakeOver(**session); !done) return done;
  Print({{"holder", ""}}, "the lease of footingd was taken over; now nobody has it", shared);
  return {};
}

}  // namespace

void AddLeaseCommand(CLI::App& app, Shared& shared) {
  const auto take_over = std::make_shared<bool>(false);
  const auto of = std::make_shared<std::string>("footing-sim");
  CLI::App* command = app.add_subcommand(
      "lease", "Print who holds the lease of footing-sim, or take over a server's lease");
  command
      ->add_option("--of", *of,
                   "Server of the lease; that of footingd can be taken over, not printed")
      ->check(CLI::IsMember({"footing-sim", "footingd"}))
      ->capture_default_str();
  command->add_flag("--take-over", *take_over,
                    "Take the lease from its holder: a study that has it stops");
  command->footer(
      "Examples (connect to footing-sim, or with --of to footingd):\n"
      "  footing-ctl lease\n"
      "  footing-ctl lease --take-over\n"
      "  footing-ctl lease --of footingd --take-over");
  command->callback([take_over, of, &shared] {
    const auto done =
        *of == "footingd" ? TakeOverFootingd(*take_over, shared) : RunLease(*take_over, shared);
    if (!done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

namespace {

Result<void> Send(const Shared& shared, v1::Command command) {
  return SendToSimulation(shared, std::move(command), "footing-sim --engine pose");
}

Result<void> TakeTPose(const Shared& shared) {
  v1::Command command;
  command.mutable_calibrate_t_pose()->set_character(1);
  if (const auto sent = Send(shared, std::move(command)); !sent) return sent;
  Print({{"t_pose", "awaited"}}, "stand still in the T-pose for five seconds", shared);
  return {};
}

Result<void> NextSubject(const std::string& file, const Shared& shared) {
  const auto subject = subject::ReadSubject(file);
  if (!subject) return subject.error();
  v1::Command command;
  v1::SetSubject& set = *command.mutable_set_subject();
  set.set_code(subject->code);
  set.set_height_m(subject->height_m);
  set.set_mass_kg(subject->mass_kg);
  set.set_foot_length_m(subject->foot_length_m);
  if (const auto sent = Send(shared, std::move(command)); !sent) return sent;
  Print({{"subject", subject->code}, {"t_pose", "awaited"}},
        subject->code + " is next: step on the boards and stand still in a T-pose for five seconds",
        shared);
  return {};
}

Result<void> SetMode(const std::string& mode, const std::vector<std::string>& left_out,
                     const Shared& shared) {
  v1::Command command;
  v1::SetPoseMode& set = *command.mutable_set_pose_mode();
  set.set_character(1);
  set.set_mode(mode);
  for (const std::string& part : left_out) set.add_left_out(part);
  if (const auto sent = Send(shared, std::move(command)); !sent) return sent;
  Print({{"mode", mode}, {"left_out", left_out}},
        mode + " mode" + (left_out.empty() ? "" : " without " + text::Joined(left_out, ", ")),
        shared);
  return {};
}

void Keep(const Result<void>& done, Shared& shared) {
  if (!done) shared.exit_code = cli::Report(done.error());
}

}  // namespace

void AddPoseCommands(CLI::App& app, Shared& shared) {
  CLI::App* t_pose = app.add_subcommand("t-pose", "Repeat the T-pose of the pose engine");
  t_pose->footer("Example:\n  footing-ctl t-pose   # connects to footing-sim");
  t_pose->callback([&shared] { Keep(TakeTPose(shared), shared); });

  const auto file = std::make_shared<std::string>();
  CLI::App* next = app.add_subcommand("subject", "Start the next subject of the pose engine");
  next->add_option("FILE", *file, "Subject file, JSON: code, height_m, mass_kg, foot_length_m")
      ->required();
  next->footer("Example:\n  footing-ctl subject p08.json   # connects to footing-sim");
  next->callback([file, &shared] { Keep(NextSubject(*file, shared), shared); });

  const auto mode = std::make_shared<std::string>();
  const auto left_out = std::make_shared<std::vector<std::string>>();
  CLI::App* change = app.add_subcommand(
      "mode", "Change the mode of the pose engine; stand upright meanwhile, the T-pose stays");
  change->add_option("MODE", *mode, "best, or paper")
      ->required()
      ->check(CLI::IsMember({"best", "paper"}));
  change
      ->add_option("--leave-out", *left_out,
                   "Parts to leave out: angular_momentum, momentum, posture, basis, cleanup")
      ->delimiter(',')
      ->check(CLI::IsMember({"angular_momentum", "momentum", "posture", "basis", "cleanup"}));
  change->footer(
      "Examples (connect to footing-sim):\n"
      "  footing-ctl mode paper\n"
      "  footing-ctl mode paper --leave-out angular_momentum");
  change->callback([mode, left_out, &shared] { Keep(SetMode(*mode, *left_out, shared), shared); });
}

namespace {

struct TrialOptions {
  std::string id, track, task, reason;
  std::uint64_t seed = 0, failure = 0;
};

/// Sends the command and prints that it was carried out.
void SendTrial(Shared& shared, v1::Command command, const nlohmann::ordered_json& out,
               const std::string& text) {
  if (const auto sent = SendToSimulation(shared, std::move(command), "footing-sim"); !sent) {
    shared.exit_code = cli::Report(sent.error());
    return;
  }
  Print(out, text, shared);
}

void StartTrial(const TrialOptions& options, Shared& shared) {
  v1::Command command;
  v1::StartTrial& start = *command.mutable_start_trial();
  start.set_character(1);
  start.set_trial(options.id);
  start.set_track(options.track);
  start.set_seed(options.seed);
  start.set_task(options.task);
  SendTrial(shared, std::move(command), {{"trial", options.id}, {"state", "ready"}},
            "trial " + options.id + " is ready: its clock starts at the start line");
}

void StopTrial(const TrialOptions& options, Shared& shared) {
  v1::Command command;
  command.mutable_stop_trial()->set_character(1);
  command.mutable_stop_trial()->set_trial(options.id);
  SendTrial(shared, std::move(command), {{"state", "stopped"}}, "the trial is stopped");
}

void CorrectFailure(const TrialOptions& options, bool restore, Shared& shared) {
  v1::Command command;
  v1::CorrectFailure& correct = *command.mutable_correct_failure();
  correct.set_failure(options.failure);
  correct.set_restore(restore);
  correct.set_reason(options.reason);
  const std::string state = restore ? "restored" : "withdrawn";
  SendTrial(shared, std::move(command), {{"failure", options.failure}, {"state", state}},
            "failure " + std::to_string(options.failure) + " is " + state);
}

void PutBack(Shared& shared) {
  v1::Command command;
  command.mutable_put_back()->set_character(1);
  SendTrial(shared, std::move(command), {{"state", "put back"}},
            "the character is put back; this is not a failure");
}

void AddCorrections(CLI::App& trial, const std::shared_ptr<TrialOptions>& options, Shared& shared) {
  const auto add = [&](const char* name, const char* help, bool restore) {
    CLI::App* command = trial.add_subcommand(name, help);
    command->add_option("FAILURE", options->failure, "Number of the failure, as in its event")
        ->required();
    command->add_option("--reason", options->reason, "Reason, for the record");
    command->callback([options, restore, &shared] { CorrectFailure(*options, restore, shared); });
  };
  add("withdraw", "Withdraw a failure that was counted by mistake; it stays in the recording",
      false);
  add("restore", "Count a withdrawn failure again", true);
}

}  // namespace

void AddTrialCommands(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<TrialOptions>();
  CLI::App* trial = app.add_subcommand("trial", "Start, stop and correct trials on a track");
  trial->require_subcommand(1);
  trial->fallthrough();
  trial->footer(
      "Examples (all connect to footing-sim):\n"
      "  footing-ctl trial start p07-wrist-1 --track straight --seed 7\n"
      "  footing-ctl trial withdraw 3 --reason \"a cable was pulled\"\n"
      "  footing-ctl trial stop");
  CLI::App* start = trial->add_subcommand("start", "Put the character before the start line");
  start->add_option("ID", options->id, "Id of the trial: 1 to 64 letters, digits, - _ and .")
      ->required();
  start->add_option("--track", options->track,
                    "Track: straight, 1 to 4, another built-in name, or the file that footing-sim "
                    "was started with (default: the current one)");
  start->add_option("--seed", options->seed, "Seed that draws the task of a straight track");
  start->add_option("--task", options->task, "Task (default: drawn with the seed)");
  start->callback([options, &shared] { StartTrial(*options, shared); });
  CLI::App* stop = trial->add_subcommand("stop", "End the trial before its finish line");
  stop->add_option("ID", options->id, "Id of the trial (default: the current one)");
  stop->callback([options, &shared] { StopTrial(*options, shared); });
  CLI::App* back = trial->add_subcommand("put-back", "Put the character back without a failure");
  back->callback([&shared] { PutBack(shared); });
  AddCorrections(*trial, options, shared);
}

}  // namespace footing::ctl
