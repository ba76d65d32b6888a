#include <algorithm>
#include <charconv>

#include "clients/ctl/report/checks.h"

namespace footing::ctl::doctor {
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

}  // namespace footing::ctl::doctor
