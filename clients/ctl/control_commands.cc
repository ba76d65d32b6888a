#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/find_device.h"
#include "common/cli/cli.h"
#include "common/base/joined.h"

namespace footing::ctl {
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

std::optional<std::uint32_t> ParseColour(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return rgb;
}

Result<void> Rumble(Session& session, const std::string& name, double seconds,
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
  if (ParseLeds(light) || ParseColour(light)) return {};
  return UsageError(light + " is neither four LEDs such as 1010 nor a colour such as #00ff40");
}

Result<void> Led(Session& session, const std::string& name, const std::string& light,
                 const Shared& shared) {
  const auto leds = ParseLeds(light);
  const auto colour = ParseColour(light);
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

Result<Tared> TareOne(Session& session, const DeviceStatus& device, bool clear) {
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
Result<void> TareAll(Session& session, bool clear, const Shared& shared) {
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

Result<void> Tare(Session& session, const std::string& name, bool clear, const Shared& shared) {
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

Result<void> Assign(Session& session, const std::string& name, const std::string& rig_role,
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
    WithSession(shared, {"status"}, [&](Session& session) {
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
    WithSession(shared, {"status"}, [&](Session& session) {
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
    WithSession(shared, {"status"},
                [&](Session& session) { return Tare(session, arguments->device, *clear, shared); });
  });
}

}  // namespace footing::ctl
