#include <iostream>
#include <memory>
#include <set>

#include "clients/ctl/collect.h"
#include "clients/ctl/commands.h"
#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/doctor.h"
#include "clients/ctl/report/pairing.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

stream::DeviceKind KindOf(pairing::Kind kind) {
  switch (kind) {
    case pairing::Kind::kWiimote:
      return stream::DeviceKind::kWiimote;
    case pairing::Kind::kBoard:
      return stream::DeviceKind::kBalanceBoard;
    case pairing::Kind::kMove:
      return stream::DeviceKind::kPsMove;
  }
  return stream::DeviceKind::kUnspecified;
}

pairing::Host Look(const std::string& root) {
  const doctor::Facts facts = CollectHost(root);
  pairing::Host host;
  if (!facts.adapters.empty()) host.adapter = facts.adapters.front().name;
  host.bluez_version = facts.bluez_version;
  // One rule for both commands: what the doctor warns of.
  for (const doctor::Finding& one : doctor::Examine(facts)) {
    if (one.id == "bluez_pairing_regression") host.may_fail = true;
  }
  return host;
}

/// Waits until a device of the kind that was not live before is.
Result<void> WaitForNew(Session& session, pairing::Kind kind, double within_s) {
  const auto live = [&] {
    std::set<std::string> serials;
    for (const stream::DeviceStatus& device : session.status()) {
      const bool counts = device.kind == KindOf(kind);
      if (counts && device.state == stream::DeviceState::kLive) serials.insert(device.serial);
    }
    return serials;
  };
  const std::set<std::string> before = live();
  std::string found;
  const Waited waited = session.RunUntil(
      [&] {
        for (const std::string& serial : live()) {
          if (before.count(serial) == 0) found = serial;
        }
        return !found.empty();
      },
      within_s);
  if (waited == Waited::kInterrupted) return Failure("stopped");
  if (waited == Waited::kTimeUp) {
    return NoDevice(std::string("no new ") + pairing::Name(kind) +
                    " appeared; run footing-ctl doctor to find the cause");
  }
  const auto device = session.Find(found);
  if (!device) return device.error();
  std::cout << "It is there: " << found << ", " << display::RigRole(*device)
            << ". To change the role: footing-ctl assign " << found << " main/ROLE" << std::endl;
  return {};
}

void Pair(const std::string& name, bool print, double within_s, const std::string& root,
          Shared& shared) {
  const auto kind = pairing::KindNamed(name);
  if (!kind) {
    shared.exit_code =
        cli::Report(UsageError("cannot pair a " + name + "; must be wiimote, board or move"));
    return;
  }
  const pairing::Host host = Look(root);
  Print(pairing::ToJson(*kind, host), pairing::ToText(*kind, host), shared);
  if (shared.json || print) return;
  std::cout << "Waiting until footingd finds it (Ctrl-C to stop) ..." << std::endl;
  WithSession(shared, {"status"},
              [&](Session& session) { return WaitForNew(session, *kind, within_s); });
}

}  // namespace

void AddPairCommand(CLI::App& app, Shared& shared) {
  struct Arguments {
    std::string device, root = "/";
    bool print = false;
    double within_s = 180;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("pair", "Pair a new device, step by step");
  command->add_option("DEVICE", arguments->device, "Kind of device: wiimote, board or move")
      ->required();
  command->add_flag("--print", arguments->print, "Only print the steps");
  command->add_option("--seconds", arguments->within_s, "Timeout, s (default 180)")
      ->check(CLI::Range(0.1, 3600.0));
  command->add_option("--root", arguments->root, "Root folder of the host to examine")->group("");
  command->footer("Examples:\n  footing-ctl pair wiimote\n  footing-ctl pair board --json");
  command->callback([arguments, &shared] {
    Pair(arguments->device, arguments->print, arguments->within_s, arguments->root, shared);
  });
}

}  // namespace footing::ctl
