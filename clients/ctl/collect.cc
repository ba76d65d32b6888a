#include "clients/ctl/collect.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>

#include <sys/stat.h>
#include <unistd.h>

#include "clients/ctl/commands.h"
#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/doctor.h"
#include "clients/ctl/report/pairing.h"
#include "clients/ctl/report/parse.h"
#include "common/cli/cli.h"

namespace footing::ctl {
namespace {

namespace fs = std::filesystem;
using doctor::Facts;

std::string ReadFile(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::string FirstLine(const fs::path& path) {
  std::string text = ReadFile(path);
  return text.substr(0, text.find('\n'));
}

/// Entries of a folder by name; none when it can't be read.
std::vector<fs::path> Entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator next(folder, error), end; !error && next != end;
       next.increment(error)) {
    found.push_back(next->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> FilesWith(const fs::path& root, const std::vector<const char*>& folders,
                                   const std::string& ending,
                                   const std::function<bool(const std::string&)>& wanted) {
  std::vector<std::string> found;
  for (const char* folder : folders) {
    for (const fs::path& file : Entries(root / folder)) {
      if (file.extension() == ending && wanted(ReadFile(file))) {
        found.push_back(std::string("/") + folder + "/" + file.filename().string());
      }
    }
  }
  return found;
}

std::string UserName(const fs::path& root, std::uint32_t uid) {
  std::ifstream in(root / "etc/passwd");
  for (std::string line; std::getline(in, line);) {
    const std::size_t name = line.find(':'), password = line.find(':', name + 1);
    if (name == std::string::npos || password == std::string::npos) continue;
    if (line.compare(password + 1, std::to_string(uid).size() + 1, std::to_string(uid) + ":") ==
        0) {
      return line.substr(0, name);
    }
  }
  return "user " + std::to_string(uid);
}

void CollectUser(const fs::path& root, Facts& facts) {
  facts.user.uid = geteuid();
  facts.user.name = UserName(root, facts.user.uid);
  std::vector<gid_t> groups(static_cast<std::size_t>(std::max(0, getgroups(0, nullptr))));
  const int count = getgroups(static_cast<int>(groups.size()), groups.data());
  groups.resize(static_cast<std::size_t>(std::max(0, count)));
  facts.user.gids.assign(groups.begin(), groups.end());
  facts.user.gids.push_back(getegid());
  std::uint32_t gid = 0;
  std::vector<std::string> members;
  if (doctor::ParseGroup(ReadFile(root / "etc/group"), "footing", gid, members)) {
    facts.footing_gid = gid;
    facts.user_listed_in_group =
        std::find(members.begin(), members.end(), facts.user.name) != members.end();
  }
}

/// A footingd whose command line names simulated devices only leaves the real devices alone.
bool OwnsDevices(const std::string& command_line) {
  const std::string words = '\0' + command_line + '\0';
  const std::string source("\0--source\0", 10);
  return words.find(source) == std::string::npos ||
         words.find(source + std::string("hid\0", 4)) != std::string::npos;
}

void CollectProcesses(const fs::path& root, Facts& facts) {
  for (const fs::path& process : Entries(root / "proc")) {
    const std::string number = process.filename().string();
    int pid = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), pid);
    if (error != std::errc() || end != number.data() + number.size()) continue;
    const std::string name = FirstLine(process / "comm");
    if (name == "bluetoothd") facts.bluetoothd_running = true;
    if (name == "steam") facts.others.steam_running = true;
    if (name != "footingd" || !OwnsDevices(ReadFile(process / "cmdline"))) continue;
    doctor::User user = doctor::ParseProcess(ReadFile(process / "status"));
    user.name = UserName(root, user.uid);
    facts.daemons[pid] = user;
  }
}

std::string UeventValue(const std::string& uevent, const std::string& key) {
  const auto values = "\n" + uevent;
  const std::size_t at = values.find("\n" + key + "=");
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size() + 2;
  return values.substr(from, values.find('\n', from) - from);
}

void CollectHid(const fs::path& root, Facts& facts) {
  for (const fs::path& device : Entries(root / "sys/bus/hid/devices")) {
    doctor::HidDevice hid;
    hid.sysfs_id = device.filename().string();
    if (!doctor::IsOurs(hid.sysfs_id)) continue;
    const std::string uevent = ReadFile(device / "uevent");
    hid.name = UeventValue(uevent, "HID_NAME");
    hid.serial = UeventValue(uevent, "HID_UNIQ");
    hid.driver = UeventValue(uevent, "DRIVER");
    for (const fs::path& node : Entries(device / "hidraw")) {
      hid.node = "/dev/" + node.filename().string();
    }
    struct stat info = {};
    const fs::path node = root / fs::path(hid.node).relative_path();
    if (!hid.node.empty() && stat(node.c_str(), &info) == 0) {
      hid.node_exists = true;
      hid.node_uid = info.st_uid;
      hid.node_gid = info.st_gid;
      hid.node_mode = info.st_mode & 0777u;
    }
    facts.hid.push_back(hid);
  }
}

void CollectModules(const fs::path& root, Facts& facts) {
  const std::vector<const char*> folders = {"etc/modprobe.d", "run/modprobe.d",
                                            "usr/lib/modprobe.d"};
  facts.others.blacklists = FilesWith(root, folders, ".conf", doctor::BlacklistsWiimote);
  const std::string now = FirstLine(root / "sys/module/hid/parameters/ignore_special_drivers");
  // Before hid is loaded the options of its loading decide.
  facts.ignore_special_drivers =
      now.empty() ? !FilesWith(root, folders, ".conf", doctor::IgnoresSpecialDrivers).empty()
                  : now == "1" || now == "Y";
}

void CollectAdapters(const fs::path& root, Facts& facts) {
  const std::vector<fs::path> entries = Entries(root / "sys/class/bluetooth");
  for (const fs::path& entry : entries) {
    doctor::Adapter adapter;
    adapter.name = entry.filename().string();
    if (adapter.name.find(':') != std::string::npos) continue;  // A connection: hci0:12.
    for (const fs::path& inside : Entries(entry)) {
      if (inside.filename().string().rfind("rfkill", 0) != 0) continue;
      adapter.blocked_soft = adapter.blocked_soft || FirstLine(inside / "soft") == "1";
      adapter.blocked_hard = adapter.blocked_hard || FirstLine(inside / "hard") == "1";
    }
    adapter.links =
        static_cast<int>(std::count_if(entries.begin(), entries.end(), [&](const fs::path& other) {
          return other.filename().string().rfind(adapter.name + ":", 0) == 0;
        }));
    facts.adapters.push_back(adapter);
  }
}

void AskBlueZ(Facts& facts) {
  facts.bluez_version = doctor::ValueOf(AskBluetoothctl("--version"), "bluetoothctl");
  if (!facts.bluetoothd_running) return;  // bluetoothctl would wait for it.
  if (facts.adapters.size() == 1) {
    const std::string powered = doctor::ValueOf(AskBluetoothctl("show"), "Powered");
    if (!powered.empty()) facts.adapters[0].powered = powered == "yes";
  }
  facts.known = doctor::ParseDevices(AskBluetoothctl("devices"));
  for (doctor::KnownDevice& device : facts.known) {
    doctor::AddInfo(AskBluetoothctl("info " + device.address), device);
  }
}

}  // namespace

std::string AskBluetoothctl(const std::string& words) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(
      popen(("timeout 2 bluetoothctl " + words + " </dev/null 2>/dev/null").c_str(), "r"), pclose);
  std::string text;
  if (!pipe) return text;
  char part[512];
  while (const std::size_t count = fread(part, 1, sizeof part, pipe.get()))
    text.append(part, count);
  return text;
}

Facts CollectHost(const std::string& root) {
  Facts facts;
  const fs::path base(root);
  CollectUser(base, facts);
  CollectProcesses(base, facts);
  CollectHid(base, facts);
  CollectModules(base, facts);
  CollectAdapters(base, facts);
  const std::vector<const char*> rules = {"etc/udev/rules.d", "run/udev/rules.d",
                                          "usr/lib/udev/rules.d", "usr/local/lib/udev/rules.d"};
  facts.udev_rules = FilesWith(base, rules, ".rules", doctor::HasRule);
  facts.others.joycond_rules = FilesWith(base, rules, ".rules", doctor::TakesSwitchNodes);
  facts.input_config = doctor::ParseIni(ReadFile(base / "etc/bluetooth/input.conf"));
  if (root == "/") AskBlueZ(facts);
  return facts;
}

namespace {

/// Silence shows as a stale state within this, jitter settles within it.
constexpr double kObservedS = 1;

void Doctor(Shared& shared, const std::string& root) {
  doctor::Facts facts = CollectHost(root);
  facts.own_version = cli::Version();
  facts.footingd_address =
      shared.connect.empty() ? transport::DefaultAddress("sensor").Text() : shared.connect;
  const auto session = Open(shared, {"status", "setup"});
  if (!session && session.error().kind == ErrorKind::kUsage) {
    shared.exit_code = cli::Report(session.error());
    return;
  }
  facts.footingd_reached = session.ok();
  if (session) {
    (*session)->RunFor(kObservedS);
    facts.footingd_version = (*session)->welcome().version();
    facts.devices = (*session)->status();
    facts.setup = (*session)->setup();
  } else {
    const bool refused = session.error().kind == ErrorKind::kFailure;
    facts.footingd_trouble = refused ? session.error().message : "nothing answers";
  }
  const std::vector<doctor::Finding> findings = doctor::Examine(facts);
  Print(doctor::ToJson(findings), doctor::ToText(findings), shared);
  if (!doctor::Healthy(findings)) shared.exit_code = static_cast<int>(ErrorKind::kFailure);
}

}  // namespace

void AddDoctorCommand(CLI::App& app, Shared& shared) {
  const auto root = std::make_shared<std::string>("/");
  CLI::App* command = app.add_subcommand("doctor", "Find faults and print their remedies");
  command->add_option("--root", *root, "Root folder of the host to examine")->group("");
  command->footer(
      "Exit code 0 when there is no error, else 1.\n"
      "Examples:\n  footing-ctl doctor\n  sudo footing-ctl doctor --json");
  command->callback([root, &shared] { Doctor(shared, *root); });
}

namespace {

bool IsA(pairing::Kind kind, stream::DeviceKind device) {
  switch (kind) {
    case pairing::Kind::kWiimote:
      return device == stream::DeviceKind::kWiimote;
    case pairing::Kind::kBoard:
      return device == stream::DeviceKind::kBalanceBoard;
    case pairing::Kind::kMove:
      return device == stream::DeviceKind::kPsMove;
    case pairing::Kind::kJoycon:
      return device == stream::DeviceKind::kJoyConLeft ||
             device == stream::DeviceKind::kJoyConRight ||
             device == stream::DeviceKind::kSwitchProController;
  }
  return false;
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
Result<void> WaitForNew(Connection& session, pairing::Kind kind, double within_s) {
  const auto live = [&] {
    std::set<std::string> serials;
    for (const stream::DeviceStatus& device : session.status()) {
      const bool counts = IsA(kind, device.kind);
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
    shared.exit_code = cli::Report(
        UsageError("cannot pair a " + name + "; must be wiimote, board, move or joycon"));
    return;
  }
  const pairing::Host host = Look(root);
  Print(pairing::ToJson(*kind, host), pairing::ToText(*kind, host), shared);
  if (shared.json || print) return;
  std::cout << "Waiting until footingd finds it (Ctrl-C to stop) ..." << std::endl;
  WithSession(shared, {"status"},
              [&](Connection& session) { return WaitForNew(session, *kind, within_s); });
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
  command->add_option("DEVICE", arguments->device, "Kind of device: wiimote, board, move or joycon")
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
