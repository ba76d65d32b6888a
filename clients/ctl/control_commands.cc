#include <charconv>
#include <memory>
#include <optional>

#include "clients/ctl/commands.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;
using stream::DeviceStatus;

constexpr std::uint32_t kLeaseMs = 500;  // Renewed at half its time; so long it runs on after us.

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

Result<void> Led(Session& session, const std::string& name, const std::string& light,
                 const Shared& shared) {
  const auto leds = ParseLeds(light);
  const auto colour = ParseColour(light);
  if (!leds && !colour) {
    return UsageError(light + " is neither four lamps such as 1010 nor a colour such as #00ff40");
  }
  const auto device = session.Find(name);
  if (!device) return device.error();
  const bool move = device->kind == stream::DeviceKind::kPsMove;
  if (colour.has_value() != move) {
    return UsageError(device->serial + (move ? " is a PS Move: give a colour such as #00ff40"
                                             : " has lamps, no colour: give them such as 1010"));
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

}  // namespace

void AddControlCommands(CLI::App& app, Shared& shared) {
  struct Words {
    std::string device, light;
    double seconds = 1;
  };
  const auto words = std::make_shared<Words>();
  CLI::App* rumble = app.add_subcommand("rumble", "Let a device's motor run");
  rumble->add_option("DEVICE", words->device, "Serial, number, RIG/ROLE or ROLE")->required();
  rumble->add_option("--seconds", words->seconds, "So long; 1 when left out")
      ->check(CLI::Range(0.05, 30.0));
  rumble->footer("Example:\n  footing-ctl rumble left_hand --seconds 2");
  rumble->callback([words, &shared] {
    WithSession(shared, {"status"}, [&](Session& session) {
      return Rumble(session, words->device, words->seconds, shared);
    });
  });

  CLI::App* led = app.add_subcommand("led", "Set a device's lamps, or a PS Move's colour");
  led->add_option("DEVICE", words->device, "Serial, number, RIG/ROLE or ROLE")->required();
  led->add_option("LIGHT", words->light, "Four lamps, 1010, or a colour, #00ff40")->required();
  led->footer(
      "Examples:\n  footing-ctl led 00:1f:32:aa:bb:cc 1010\n  footing-ctl led head #00ff40");
  led->callback([words, &shared] {
    WithSession(shared, {"status"}, [&](Session& session) {
      return Led(session, words->device, words->light, shared);
    });
  });
}

}  // namespace footing::ctl
