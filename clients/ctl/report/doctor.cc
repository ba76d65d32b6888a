#include "clients/ctl/report/doctor.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "common/base/text.h"

namespace footing::ctl::doctor {
namespace {

std::vector<Check> AllChecks() {
  std::vector<Check> all;
  for (const auto& some : {HostChecks(), BluetoothChecks(), DeviceChecks(), SetupChecks()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace

const char* Name(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      return "note";
  }
  return "note";
}

const User& OpenerOfNodes(const Facts& facts) {
  return facts.daemons.empty() ? facts.user : facts.daemons.begin()->second;
}

bool IsThere(const stream::DeviceStatus& device) {
  return device.state != stream::DeviceState::kLost;
}

bool AnyRealDeviceLives(const Facts& facts) {
  return std::any_of(facts.devices.begin(), facts.devices.end(), [](const auto& device) {
    return !device.simulated && device.state == stream::DeviceState::kLive;
  });
}

std::string Place(const stream::DeviceStatus& device) {
  if (device.role == stream::DeviceRole::kUnspecified) return device.serial;
  return std::string(stream::Name(device.role)) + " " + device.serial;
}

std::vector<Finding> Examine(const Facts& facts) {
  std::vector<Finding> findings;
  for (const Check& check : AllChecks()) {
    for (Symptom& symptom : check.find(facts)) {
      findings.push_back({check.id, symptom.severity, std::move(symptom.what),
                          std::move(symptom.where), std::move(symptom.remedy)});
    }
  }
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) < static_cast<int>(b.severity);
  });
  return findings;
}

bool Healthy(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& one) { return one.severity == Severity::kError; });
}

nlohmann::ordered_json ToJson(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& one : findings) {
    list.push_back({{"id", one.id},
                    {"severity", Name(one.severity)},
                    {"what", one.what},
                    {"where", one.where},
                    {"remedy", one.remedy}});
  }
  return {{"ok", Healthy(findings)}, {"findings", std::move(list)}};
}

std::string ToText(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& one : findings) {
    text += std::string(Name(one.severity)) + ": " + one.what +
            (one.where.empty() ? "" : " (" + one.where + ")") + "\n  -> " + one.remedy + "\n";
  }
  if (findings.empty()) return "all is well";
  return text + (Healthy(findings) ? "no error" : "fix the errors first, from the top");
}

std::vector<std::string> CheckIds() {
  std::vector<std::string> ids;
  for (const Check& check : AllChecks()) ids.emplace_back(check.id);
  return ids;
}

namespace {

constexpr int kMostLinks = 7;           // Active members of a piconet (Bluetooth Core, 1.2).
constexpr int kComfortableLinks = 4;    // Above, users see lag with 100 reports/s each.
constexpr double kCrowdedJitterMs = 8;  // One hop takes 8 +- 2.3 ms on a free link.

Severity WithoutLiveDevice(const Facts& facts, Severity severity) {
  return AnyRealDeviceLives(facts) ? Severity::kNote : severity;
}

std::string Value(const Facts& facts, const std::string& key) {
  const auto found = facts.input_config.find(key);
  return found == facts.input_config.end() ? "" : found->second;
}

/// "5.73" and "5.66-1" as 573 and 566; 0 when it is none.
int VersionNumber(const std::string& text) {
  int major = 0, minor = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, major);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return 0;
  const auto second = std::from_chars(first.ptr + 1, end, minor);
  return second.ec == std::errc() ? 100 * major + minor : 0;
}

std::vector<Symptom> NoAdapter(const Facts& facts) {
  if (!facts.adapters.empty()) return {};
  const bool any = std::any_of(facts.devices.begin(), facts.devices.end(), IsThere);
  return {
      {any ? Severity::kNote : Severity::kError,
       any ? "no Bluetooth adapter; the present devices do not need one" : "no Bluetooth adapter",
       "/sys/class/bluetooth",
       "plug one in (Bluetooth 2.1 or later), and look for it with: lsusb; sudo dmesg | grep -i "
       "bluetooth"}};
}

std::vector<Symptom> Blocked(const Facts& facts) {
  std::vector<Symptom> found;
  for (const Adapter& adapter : facts.adapters) {
    if (!adapter.blocked_soft && !adapter.blocked_hard) continue;
    found.push_back({Severity::kError, "the Bluetooth adapter is blocked", adapter.name,
                     adapter.blocked_hard
                         ? "turn on the wireless switch (or the firmware setting) of the computer"
                         : "rfkill unblock bluetooth"});
  }
  return found;
}

std::vector<Symptom> Off(const Facts& facts) {
  std::vector<Symptom> found;
  for (const Adapter& adapter : facts.adapters) {
    if (adapter.powered.value_or(true)) continue;
    found.push_back(
        {Severity::kError, "the Bluetooth adapter is off", adapter.name, "bluetoothctl power on"});
  }
  return found;
}

std::vector<Symptom> NoBluetoothd(const Facts& facts) {
  if (facts.bluetoothd_running || facts.adapters.empty()) return {};
  return {{Severity::kError, "bluetoothd is not running, so nothing can pair or connect",
           "bluetoothd", "sudo apt install bluez && sudo systemctl enable --now bluetooth"}};
}

std::vector<Symptom> BondedOnly(const Facts& facts) {
  if (Value(facts, "ClassicBondedOnly") == "false") return {};
  std::vector<Symptom> found;
  for (const KnownDevice& device : facts.known) {
    if (device.bonded || device.connected) continue;
    found.push_back(
        {Severity::kWarning,
         device.name + " is known without a bond, and BlueZ refuses such input devices",
         device.address,
         "bluetoothctl remove " + device.address +
             ", then footing-ctl pair with the red sync button; or, less safe: set "
             "ClassicBondedOnly=false in /etc/bluetooth/input.conf and sudo systemctl restart "
             "bluetooth"});
  }
  return found;
}

std::vector<Symptom> UnbondedAllowed(const Facts& facts) {
  if (Value(facts, "ClassicBondedOnly") != "false") return {};
  return {
      {Severity::kNote,
       "ClassicBondedOnly=false: any input device nearby may connect (CVE-2023-45866)",
       "/etc/bluetooth/input.conf",
       "leave it only for devices that can't be bonded; else remove the line and sudo systemctl "
       "restart bluetooth"}};
}

std::vector<Symptom> Persisting(const Facts& facts) {
  if (Value(facts, "UserspaceHID") != "persist") return {};
  return {{Severity::kWarning,
           "UserspaceHID=persist keeps the nodes of devices that are gone; they seem silent",
           "/etc/bluetooth/input.conf",
           "set UserspaceHID=true there and sudo systemctl restart bluetooth"}};
}

std::vector<Symptom> Regression(const Facts& facts) {
  const int version = VersionNumber(facts.bluez_version);
  if (version < 573 || facts.adapters.empty()) return {};
  return {
      {WithoutLiveDevice(facts, Severity::kWarning),
       "BlueZ " + facts.bluez_version +
           " may fail to pair Wiimotes and boards (from 5.73 on, "
           "https://github.com/bluez/bluez/issues/911)",
       "bluetoothd",
       "if the device goes off while it pairs: press its red button once more at that moment, or "
       "use BlueZ 5.66 of Debian 12"}};
}

std::vector<Symptom> NotConnected(const Facts& facts) {
  std::vector<Symptom> found;
  for (const KnownDevice& device : facts.known) {
    if (!device.paired || device.connected) continue;
    found.push_back({Severity::kWarning, device.name + " is paired but not connected: it sleeps",
                     device.address,
                     "press a button on it (a board: the power button at its front); if that "
                     "does not connect it: bluetoothctl connect " +
                         device.address});
  }
  return found;
}

std::vector<Symptom> NotTrusted(const Facts& facts) {
  std::vector<Symptom> found;
  for (const KnownDevice& device : facts.known) {
    if (!device.paired || device.trusted) continue;
    found.push_back({Severity::kWarning,
                     device.name + " is paired but not trusted, so it can't come back by itself",
                     device.address, "bluetoothctl trust " + device.address});
  }
  return found;
}

std::vector<Symptom> ConnectedWithoutNode(const Facts& facts) {
  std::vector<Symptom> found;
  for (const KnownDevice& device : facts.known) {
    const bool listed = std::any_of(facts.hid.begin(), facts.hid.end(), [&](const HidDevice& hid) {
      return std::equal(hid.serial.begin(), hid.serial.end(), device.address.begin(),
                        device.address.end(),
                        [](char a, char b) { return (a | 0x20) == (b | 0x20); });
    });
    if (!device.connected || listed) continue;
    found.push_back({Severity::kError,
                     device.name + " is connected, but the kernel has no HID device for it",
                     device.address,
                     "sudo modprobe -a uhid hidp; bluetoothctl disconnect " + device.address +
                         ", then press a button on it"});
  }
  return found;
}

std::vector<Symptom> TooMany(const Facts& facts) {
  double jitter_ms = 0;
  for (const stream::DeviceStatus& device : facts.devices) {
    if (!device.simulated && IsThere(device)) jitter_ms = std::max(jitter_ms, device.jitter_ms);
  }
  std::vector<Symptom> found;
  for (const Adapter& adapter : facts.adapters) {
    const bool full = adapter.links >= kMostLinks;
    const bool crowded = adapter.links > kComfortableLinks && jitter_ms > kCrowdedJitterMs;
    if (!full && !crowded) continue;
    found.push_back(
        {adapter.links > kMostLinks ? Severity::kError : Severity::kWarning,
         std::to_string(adapter.links) +
             " devices on one adapter, which supports 7 at most and 4 reliably",
         adapter.name,
         "plug in a second adapter and pair half of the devices there: bluetoothctl list, "
         "then bluetoothctl select ADDRESS"});
  }
  return found;
}

}  // namespace

std::vector<Check> BluetoothChecks() {
  return {{"no_adapter", NoAdapter},
          {"adapter_blocked", Blocked},
          {"adapter_off", Off},
          {"bluetoothd_missing", NoBluetoothd},
          {"unbonded_refused", BondedOnly},
          {"unbonded_allowed", UnbondedAllowed},
          {"nodes_persist", Persisting},
          {"bluez_pairing_regression", Regression},
          {"paired_not_connected", NotConnected},
          {"paired_not_trusted", NotTrusted},
          {"connected_without_hid", ConnectedWithoutNode},
          {"too_many_devices", TooMany}};
}

namespace {

using stream::CalibrationOrigin;
using stream::DeviceKind;
using stream::DeviceState;
using stream::DeviceStatus;

constexpr std::uint64_t kEnoughReports = 300;  // Three seconds: statistics mean nothing before.
constexpr double kPoorRateHz = 50;             // All of our devices send 60 or more.
constexpr double kPoorJitterMs = 15;           // A good link has 6, a free hop 2.3.
// Shares of long intervals: of 1000, a good link has at most one over 50 ms, a poor one 30 to 45.
constexpr double kPoorGapsShare = 5e-3;
constexpr double kSomeGapsShare = 1e-3;
constexpr std::uint64_t kStrayGaps = 5;       // Fewer are stalls of the host.
constexpr double kManyReassertsShare = 2e-3;  // One in 5 s at 100 Hz.
constexpr double kPoorClockMs = 5;
constexpr std::uint64_t kManyPlugs = 20;

double Share(std::uint64_t part, const DeviceStatus& device) {
  return static_cast<double>(part) /
         static_cast<double>(std::max<std::uint64_t>(device.reports, 1));
}

bool IsBoard(const DeviceStatus& device) { return device.kind == DeviceKind::kBalanceBoard; }

/// One symptom for each device for which `bad` holds.
template <typename Bad, typename Describe>
std::vector<Symptom> Each(const Facts& facts, Bad bad, Describe describe) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!bad(device)) continue;
    Symptom symptom = describe(device);
    symptom.where = Place(device);
    found.push_back(std::move(symptom));
  }
  return found;
}

std::vector<Symptom> None(const Facts& facts) {
  if (!facts.footingd_reached || std::any_of(facts.devices.begin(), facts.devices.end(), IsThere)) {
    return {};
  }
  return {{Severity::kWarning, "footingd has no device", facts.footingd_address,
           "press a button on a paired one, or pair one: footing-ctl pair wiimote"}};
}

std::vector<Symptom> Silent(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.state == DeviceState::kStale; },
      [](const DeviceStatus& device) {
        return Symptom{
            Severity::kError,
            "it is connected, but sends no data" + (device.note.empty() ? "" : ": " + device.note),
            "",
            IsBoard(device)
                ? "a board goes silent on weak batteries: change all four, then press its "
                  "power button"
                : "press a button on it; if it stays silent, remove a battery for 5 s"};
      });
}

std::vector<Symptom> Lost(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.state == DeviceState::kLost; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "it is lost" + (device.note.empty() ? "" : ": " + device.note), "",
                       IsBoard(device) ? "press the board's power button"
                                       : "press a button on it; it keeps its role"};
      });
}

bool IsSwitchKind(const DeviceStatus& device) {
  return device.kind == DeviceKind::kJoyConLeft || device.kind == DeviceKind::kJoyConRight ||
         device.kind == DeviceKind::kSwitchProController;
}

std::vector<Symptom> BatteryLow(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return IsThere(device) && device.battery_low; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning, "its battery is low", "",
                       device.kind == DeviceKind::kPsMove ? "charge it by USB"
                       : IsSwitchKind(device)
                           ? "charge it on a console, in a charging grip or by USB"
                       : IsBoard(device) ? "change its four AA batteries"
                                         : "change its two AA batteries"};
      });
}

std::vector<Symptom> Uncalibrated(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && (device.calibration == CalibrationOrigin::kDefaults ||
                                   device.extension_calibration == CalibrationOrigin::kDefaults ||
                                   device.gyroscope_calibration == CalibrationOrigin::kDefaults);
      },
      [](const DeviceStatus& device) {
        const bool move = device.kind == DeviceKind::kPsMove;
        return Symptom{
            Severity::kWarning,
            "its calibration could not be read or is invalid; typical values are used", "",
            move ? "connect it by USB once while footingd runs: its calibration is kept"
                 : "switch it off and on to read it again; if this persists, its numbers are "
                   "only approximate"};
      });
}

bool HasPoorLink(const DeviceStatus& device) {
  if (device.state != DeviceState::kLive || device.reports < kEnoughReports) return false;
  if (device.report_rate_hz < kPoorRateHz) return true;
  if (device.gaps < kStrayGaps) return false;
  const double gaps = Share(device.gaps, device);
  return gaps > kPoorGapsShare || (gaps > kSomeGapsShare && device.jitter_ms > kPoorJitterMs);
}

std::vector<Symptom> PoorLink(const Facts& facts) {
  return Each(facts, HasPoorLink, [](const DeviceStatus& device) {
    return Symptom{Severity::kWarning,
                   "its link is poor: " + std::to_string(static_cast<int>(device.report_rate_hz)) +
                       " reports/s, jitter " + std::to_string(static_cast<int>(device.jitter_ms)) +
                       " ms, " + std::to_string(device.gaps) + " gaps",
                   "",
                   "bring the adapter nearer (a USB extension, away from Wi-Fi and USB 3 plugs), "
                   "or move Wi-Fi to 5 GHz"};
  });
}

std::vector<Symptom> ModeStolen(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.mode_reasserts >= 5 &&
               Share(device.mode_reasserts, device) > kManyReassertsShare;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "its report mode had to be set again " +
                           std::to_string(device.mode_reasserts) +
                           " times: another program or driver changes it",
                       "",
                       "end other programs that use it (sudo fuser -v " +
                           (device.place.empty() ? "/dev/hidraw*" : device.place) +
                           "); against hid_wiimote: " + kIgnoreSpecialDrivers};
      });
}

std::vector<Symptom> Dropped(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.queue_drops > 0; },
      [](const DeviceStatus& device) {
        return Symptom{
            Severity::kWarning,
            std::to_string(device.queue_drops) + " reports were lost because the host was busy", "",
            "end what takes the processor (top), or give footingd a core of its own"};
      });
}

std::vector<Symptom> WritesFailed(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return IsThere(device) && device.writes_failed > 0; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       std::to_string(device.writes_failed) + " writes to it failed", "",
                       "switch it off and on; if that does not help: footing-ctl pair"};
      });
}

std::vector<Symptom> Undecodable(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return device.reports >= kEnoughReports && Share(device.undecodable, device) > 0.01;
      },
      [&facts](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       std::to_string(device.undecodable) +
                           " of its reports make no sense: it may be a counterfeit",
                       "",
                       "record it for a report: footing-log record --connect " +
                           facts.footingd_address + " --seconds 10 --out odd.mcap"};
      });
}

std::vector<Symptom> LoosePlug(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.extension_changes >= kManyPlugs;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "its extension was plugged in or out " +
                           std::to_string(device.extension_changes) +
                           " times: a loose plug or a clone",
                       "", "press the plug in, clean its contacts, or try another one"};
      });
}

std::vector<Symptom> UnknownExtension(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.extension == stream::Extension::kUnknown;
      },
      [](const DeviceStatus&) {
        return Symptom{Severity::kNote, "something is plugged in that Footing does not know", "",
                       "pull it out if the Nunchuk or MotionPlus is meant to work"};
      });
}

std::vector<Symptom> ClockUncertain(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return device.state == DeviceState::kLive && device.clock_offset_sd_ms > kPoorClockMs;
      },
      [](const DeviceStatus&) {
        return Symptom{Severity::kWarning, "its sampling times are uncertain", "",
                       "wait 10 s; if this persists, fix its link first (see poor_link)"};
      });
}

std::vector<Symptom> NoRole(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.role == stream::DeviceRole::kUnspecified;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning, "it has no role, so nothing uses it", "",
                       "footing-ctl assign " + device.serial + " main/left_hand (or another role)"};
      });
}

std::vector<Symptom> Notes(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return !device.note.empty() &&
               (device.state == DeviceState::kLive || device.state == DeviceState::kConnecting);
      },
      [](const DeviceStatus& device) {
        return Symptom{device.state == DeviceState::kLive ? Severity::kNote : Severity::kWarning,
                       device.note, "", "footing-ctl watch shows whether it persists"};
      });
}

}  // namespace

std::vector<Check> DeviceChecks() {
  return {{"no_device", None},
          {"device_silent", Silent},
          {"device_lost", Lost},
          {"battery_low", BatteryLow},
          {"uncalibrated", Uncalibrated},
          {"poor_link", PoorLink},
          {"mode_stolen", ModeStolen},
          {"reports_dropped", Dropped},
          {"writes_failed", WritesFailed},
          {"undecodable", Undecodable},
          {"loose_plug", LoosePlug},
          {"unknown_extension", UnknownExtension},
          {"clock_uncertain", ClockUncertain},
          {"no_role", NoRole},
          {"device_note", Notes}};
}

namespace {

/// In Footing's folder. A rule that names a group that does not exist is ignored by udev.
std::string InstallRule(const Facts& facts) {
  return std::string(facts.footing_gid ? "" : "sudo groupadd --system footing && ") +
         "sudo cp systemd/70-footing.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
         "sudo udevadm trigger --subsystem-match=hidraw";
}

std::string NeverBlacklist() {
  return std::string(
             "never blacklist or unbind hid_wiimote: without it there is no hidraw at "
             "all; to keep it away: ") +
         kIgnoreSpecialDrivers;
}

bool MayOpen(const User& who, const HidDevice& hid) {
  if (who.uid == 0) return true;
  constexpr std::uint32_t kReadWrite = 6;
  const bool in_group = std::find(who.gids.begin(), who.gids.end(), hid.node_gid) != who.gids.end();
  const unsigned shift = who.uid == hid.node_uid ? 6 : in_group ? 3 : 0;
  return (hid.node_mode >> shift & kReadWrite) == kReadWrite;
}

bool AnyOfSwitch(const Facts& facts) {
  return std::any_of(facts.hid.begin(), facts.hid.end(),
                     [](const HidDevice& hid) { return IsOfSwitch(hid.sysfs_id); });
}

bool IsNintendo(const HidDevice& hid) { return hid.sysfs_id.find(":057E:") != std::string::npos; }

/// Or needs no group.
bool InGroup(const Facts& facts) {
  const auto& gids = facts.user.gids;
  return !facts.footing_gid || facts.user.uid == 0 ||
         std::find(gids.begin(), gids.end(), *facts.footing_gid) != gids.end();
}

std::vector<Symptom> NotRunning(const Facts& facts) {
  if (facts.footingd_reached) return {};
  const bool elsewhere = !facts.daemons.empty();
  if (elsewhere && !InGroup(facts)) {
    return {{Severity::kError,
             "a footingd runs, but " + facts.user.name + " may not reach its socket",
             facts.footingd_address,
             "sudo usermod -aG footing " + facts.user.name + ", then log in again"}};
  }
  return {{Severity::kError,
           elsewhere ? "a footingd runs, but not at this address: " + facts.footingd_trouble
                     : "footingd is not running: " + facts.footingd_trouble,
           facts.footingd_address,
           elsewhere
               ? "footing-ctl --connect ADDRESS doctor, with an address that footingd listens "
                 "on"
               : "sudo systemctl start footingd.service, or run footingd in a terminal"}};
}

std::vector<Symptom> SecondDaemon(const Facts& facts) {
  if (facts.daemons.size() < 2) return {};
  std::vector<std::string> owners, numbers;
  bool foreign = false;
  for (const auto& [number, user] : facts.daemons) {
    owners.push_back(std::to_string(number) + " of " + user.name);
    numbers.push_back(std::to_string(number));
    foreign = foreign || user.uid != facts.user.uid;
  }
  // Without a device there is nothing to fight over yet.
  const bool fight = !facts.hid.empty();
  return {{fight ? Severity::kError : Severity::kWarning,
           std::to_string(facts.daemons.size()) + " footingd run; they " + (fight ? "" : "would ") +
               "write to the same devices and undo each other's settings",
           "processes " + text::Joined(owners),
           std::string(foreign ? "sudo " : "") + "kill " + text::Joined(numbers, " ") +
               ", without the number of the one to keep"}};
}

std::vector<Symptom> OtherVersion(const Facts& facts) {
  if (!facts.footingd_reached || facts.footingd_version == facts.own_version) return {};
  return {{Severity::kNote,
           "footingd is version " + facts.footingd_version + ", footing-ctl " + facts.own_version,
           facts.footingd_address, "sudo systemctl restart footingd.service, after an upgrade"}};
}

std::vector<Symptom> NoPermission(const Facts& facts) {
  std::vector<Symptom> found;
  const User& opener = OpenerOfNodes(facts);
  for (const HidDevice& hid : facts.hid) {
    if (hid.node.empty() || !hid.node_exists || MayOpen(opener, hid)) continue;
    const bool rule = !facts.udev_rules.empty();
    const bool group = facts.footing_gid && *facts.footing_gid == hid.node_gid;
    found.push_back({Severity::kError, opener.name + " may not open " + hid.name + " " + hid.serial,
                     hid.node,
                     group  ? "sudo usermod -aG footing " + opener.name + ", then log in again"
                     : rule ? "sudo udevadm trigger --subsystem-match=hidraw (the rule " +
                                  facts.udev_rules.front() + " was not applied to it)"
                            : InstallRule(facts)});
  }
  return found;
}

std::vector<Symptom> RuleMissing(const Facts& facts) {
  if (!facts.udev_rules.empty() || OpenerOfNodes(facts).uid == 0) return {};
  return {{facts.hid.empty() ? Severity::kNote : Severity::kWarning,
           "no udev rule gives the devices' nodes to the group footing", "/etc/udev/rules.d",
           InstallRule(facts)}};
}

std::vector<Symptom> NotInGroup(const Facts& facts) {
  if (InGroup(facts)) return {};
  if (facts.user_listed_in_group) {
    return {{Severity::kWarning,
             facts.user.name + " is in the group footing, but this login is older", "groups",
             "log out and in again, or: newgrp footing"}};
  }
  return {{Severity::kWarning,
           facts.user.name + " is not in the group footing, which owns footingd's socket",
           "/etc/group", "sudo usermod -aG footing " + facts.user.name + ", then log in again"}};
}

std::vector<Symptom> NodeMissing(const Facts& facts) {
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (!hid.node.empty()) continue;
    const bool none = hid.driver.empty();
    if (none && IsOfSwitch(hid.sysfs_id)) {
      found.push_back(
          {Severity::kError,
           hid.name + " " + hid.serial +
               " has no hidraw node: hid_nintendo's start failed, as it does with a copy "
               "that leaves one of its questions unanswered",
           "/sys/bus/hid/devices/" + hid.sysfs_id,
           "echo 'blacklist hid_nintendo' | sudo tee /etc/modprobe.d/footing.conf && "
           "sudo modprobe -r hid_nintendo, then switch it off and on; footingd needs no "
           "driver for it"});
      continue;
    }
    found.push_back(
        {Severity::kError,
         hid.name + " " + hid.serial + " has no hidraw node: " +
             (none ? "no kernel driver is bound to it" : "the driver " + hid.driver + " hides it"),
         "/sys/bus/hid/devices/" + hid.sysfs_id,
         IsNintendo(hid) ? std::string("sudo modprobe hid_wiimote, then switch the device off and "
                                       "on; ") +
                               NeverBlacklist()
                         : "sudo modprobe hid_sony, then switch the device off and on"});
  }
  return found;
}

std::vector<Symptom> Blacklisted(const Facts& facts) {
  if (facts.ignore_special_drivers) return {};
  std::vector<Symptom> found;
  for (const std::string& file : facts.others.blacklists) {
    found.push_back({Severity::kError,
                     "hid_wiimote is blacklisted, so Wiimotes and boards get no hidraw node", file,
                     "sudo sed -i '/hid.wiimote/d' " + file +
                         " && sudo modprobe hid_wiimote, then switch the device off and on; " +
                         NeverBlacklist()});
  }
  return found;
}

std::vector<Symptom> WrongDriver(const Facts& facts) {
  static const std::vector<std::string> right = {"wiimote", "hid-generic", "sony", "playstation",
                                                 "nintendo"};
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (hid.driver.empty()) continue;
    if (std::find(right.begin(), right.end(), hid.driver) != right.end()) continue;
    found.push_back({Severity::kWarning, hid.name + " is bound to the driver " + hid.driver,
                     "/sys/bus/hid/devices/" + hid.sysfs_id,
                     "stop the program that installed that driver; " + NeverBlacklist()});
  }
  return found;
}

std::vector<Symptom> DriverInTheWay(const Facts& facts) {
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (hid.driver != "wiimote") continue;
    found.push_back({Severity::kNote,
                     "hid_wiimote is bound beside footingd; it changes the report mode after every "
                     "status report, and footingd sets it again",
                     hid.name + " " + hid.serial,
                     "nothing, as long as rates are good; else " + NeverBlacklist() +
                         " (it keeps other special drivers away, too)"});
  }
  return found;
}

std::vector<Symptom> SteamWrites(const Facts& facts) {
  if (!facts.others.steam_running || !AnyOfSwitch(facts)) return {};
  return {{Severity::kNote,
           "Steam is running; it sets up Joy-Cons and Pro Controllers in its own way, and footingd "
           "sets them up again",
           "process steam",
           "end Steam, or switch off its support of Switch controllers in Settings, Controller"}};
}

std::vector<Symptom> JoycondRule(const Facts& facts) {
  if (facts.others.joycond_rules.empty() || !AnyOfSwitch(facts)) return {};
  return {
      {Severity::kWarning,
       "joycond's udev rule shuts the node of a Pro Controller after Footing's rule opened it",
       facts.others.joycond_rules.front(),
       "sudo apt remove joycond, or let Footing's rule come last: sudo cp "
       "/usr/lib/udev/rules.d/70-footing.rules /etc/udev/rules.d/90-footing.rules && sudo udevadm "
       "control --reload && sudo udevadm trigger --subsystem-match=hidraw"}};
}

}  // namespace

std::vector<Check> HostChecks() {
  return {{"footingd_not_running", NotRunning}, {"second_daemon", SecondDaemon},
          {"other_version", OtherVersion},      {"node_without_permission", NoPermission},
          {"udev_rule_missing", RuleMissing},   {"user_not_in_group", NotInGroup},
          {"hidraw_missing", NodeMissing},      {"driver_blacklisted", Blacklisted},
          {"wrong_driver", WrongDriver},        {"driver_in_the_way", DriverInTheWay},
          {"steam_writes", SteamWrites},        {"joycond_rule", JoycondRule}};
}

namespace {

std::string Redo(const stream::RigSetup& rig, const stream::SetupItem& item) {
  return "footing-ctl setup --rig " + rig.rig + " --only " + item.name;
}

template <typename Bad>
std::vector<Symptom> Items(const Facts& facts, Bad bad, const char* state) {
  std::vector<Symptom> found;
  for (const stream::RigSetup& rig : facts.setup) {
    for (const stream::SetupItem& item : rig.items) {
      if (!bad(item)) continue;
      found.push_back(
          {Severity::kWarning,
           "setup: " + item.name + " " + state + (item.note.empty() ? "" : ": " + item.note),
           item.serial.empty() ? rig.rig : rig.rig + " " + item.serial, Redo(rig, item)});
    }
  }
  return found;
}

std::vector<Symptom> Stale(const Facts& facts) {
  return Items(
      facts, [](const stream::SetupItem& item) { return item.passed && item.stale; },
      "is out of date");
}

std::vector<Symptom> Failed(const Facts& facts) {
  return Items(
      facts, [](const stream::SetupItem& item) { return !item.passed; }, "did not pass");
}

std::vector<Symptom> NotTared(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (device.kind != DeviceKind::kBalanceBoard || !IsThere(device) || device.tared) continue;
    found.push_back({Severity::kWarning, "the board is not tared: its empty weight counts as load",
                     Place(device), "step off, then footing-ctl tare " + device.serial});
  }
  return found;
}

std::vector<Symptom> NoLayout(const Facts& facts) {
  std::set<std::string> laid;
  for (const stream::RigSetup& rig : facts.setup) {
    if (!rig.layout.preset.empty()) laid.insert(rig.rig);
  }
  std::set<std::string> reported;
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (device.kind != DeviceKind::kBalanceBoard || !IsThere(device)) continue;
    if (laid.count(device.rig) > 0 || !reported.insert(device.rig).second) continue;
    found.push_back({Severity::kWarning, "the layout of the boards is not set", device.rig,
                     "footing-ctl layout --rig " + device.rig + " --check"});
  }
  return found;
}

std::vector<Symptom> SingleOfTwo(const Facts& facts) {
  std::vector<Symptom> found;
  for (const stream::RigSetup& rig : facts.setup) {
    const auto boards = std::count_if(facts.devices.begin(), facts.devices.end(),
                                      [&rig](const DeviceStatus& device) {
                                        return device.kind == DeviceKind::kBalanceBoard &&
                                               IsThere(device) && device.rig == rig.rig;
                                      });
    if (rig.layout.preset != "single" || boards < 2) continue;
    found.push_back({Severity::kError,
                     "the layout single is for one board, but " + std::to_string(boards) +
                         " are attached: forces and poses would be wrong",
                     rig.rig,
                     "footing-ctl layout --rig " + rig.rig +
                         " --preset one_foot_each --check, or switch the other board off"});
  }
  return found;
}

std::vector<Symptom> Moved(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!device.moved) continue;
    found.push_back({Severity::kWarning, "the board was moved after its place was checked",
                     Place(device), "footing-ctl layout --rig " + device.rig + " --check"});
  }
  return found;
}

std::vector<Symptom> Slipped(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!device.slipped) continue;
    found.push_back({Severity::kWarning, "it has slipped on its wearer: its directions are wrong",
                     Place(device), "footing-ctl setup --rig " + device.rig + " --only mounting"});
  }
  return found;
}

std::vector<Symptom> NotMounted(const Facts& facts) {
  static const std::set<stream::DeviceRole> mounted_roles = {
      stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg, stream::DeviceRole::kHead,
      stream::DeviceRole::kTrunk};
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!IsThere(device) || device.mounted || mounted_roles.count(device.role) == 0) continue;
    found.push_back({Severity::kWarning, "its mounting is not measured", Place(device),
                     "footing-ctl setup --rig " + device.rig + " --only mounting"});
  }
  return found;
}

}  // namespace

std::vector<Check> SetupChecks() {
  return {{"setup_stale", Stale},         {"setup_failed", Failed},
          {"board_not_tared", NotTared},  {"layout_missing", NoLayout},
          {"layout_single", SingleOfTwo}, {"board_moved", Moved},
          {"mounting_slipped", Slipped},  {"mounting_missing", NotMounted}};
}

}  // namespace footing::ctl::doctor
