#include "clients/ctl/report/device_table.h"

#include <algorithm>
#include <array>

#include "clients/ctl/report/live_screen.h"
#include "common/base/text.h"

namespace footing::ctl::display {
namespace {

using nlohmann::ordered_json;
using stream::DeviceStatus;

ordered_json Known(double value) { return value < 0 ? ordered_json(nullptr) : ordered_json(value); }

std::string Colour(std::uint32_t rgb) {
  constexpr std::array kDigits = {'0', '1', '2', '3', '4', '5', '6', '7',
                                  '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string text = "#";
  for (int shift = 20; shift >= 0; shift -= 4) text += kDigits[rgb >> shift & 0xfu];
  return text;
}

std::string Marks(const DeviceStatus& device) {
  std::string text;
  const auto add = [&](bool on, const char* mark) {
    if (on) text += (text.empty() ? "" : ",") + std::string(mark);
  };
  add(device.simulated, "simulated");
  add(device.calibration == stream::CalibrationOrigin::kDefaults, "UNCALIBRATED");
  add(device.tared, "tared");
  add(device.mounted, "mounted");
  add(device.slipped, "SLIPPED");
  add(device.moved, "MOVED");
  return text.empty() ? "-" : text;
}

std::string ExtensionWord(const DeviceStatus& device) {
  return device.kind == stream::DeviceKind::kWiimote ? stream::Name(device.extension) : "-";
}

}  // namespace

ordered_json DeviceToJson(const DeviceStatus& device) {
  return {{"device", device.device},
          {"serial", device.serial},
          {"kind", stream::Name(device.kind)},
          {"name", device.name},
          {"rig", device.rig},
          {"role", stream::Name(device.role)},
          {"state", stream::Name(device.state)},
          {"simulated", device.simulated},
          {"extension", stream::Name(device.extension)},
          {"calibration", stream::Name(device.calibration)},
          {"extension_calibration", stream::Name(device.extension_calibration)},
          {"gyroscope_calibration", stream::Name(device.gyroscope_calibration)},
          {"rate_hz", device.report_rate_hz},
          {"jitter_ms", device.jitter_ms},
          {"reports", device.reports},
          {"gaps", device.gaps},
          {"repeats", device.repeats},
          {"clipped", device.clipped},
          {"undecodable", device.undecodable},
          {"battery_fraction", Known(device.battery_fraction)},
          {"battery_low", device.battery_low},
          {"leds", Lamps(device.leds)},
          {"sphere", Colour(device.sphere_rgb)},
          {"rumble", device.rumble},
          {"driver", device.driver},
          {"place", device.place},
          {"mode_reasserts", device.mode_reasserts},
          {"queue_drops", device.queue_drops},
          {"writes_failed", device.writes_failed},
          {"extension_changes", device.extension_changes},
          {"clock_offset_sd_ms", Known(device.clock_offset_sd_ms)},
          {"tared", device.tared},
          {"mounted", device.mounted},
          {"slipped", device.slipped},
          {"moved", device.moved},
          {"note", device.note}};
}

ordered_json DevicesToJson(const std::vector<DeviceStatus>& devices) {
  ordered_json out = ordered_json::array();
  for (const DeviceStatus& device : devices) out.push_back(DeviceToJson(device));
  return out;
}

std::string RigRole(const DeviceStatus& device) {
  if (device.role == stream::DeviceRole::kUnspecified) return "-";
  return device.rig + "/" + stream::Name(device.role);
}

std::string Battery(const DeviceStatus& device) {
  if (device.battery_fraction < 0) return device.battery_low ? "LOW" : "-";
  return Fixed(100 * device.battery_fraction, 0) + " %" + (device.battery_low ? " LOW" : "");
}

std::string DeviceTable(const std::vector<DeviceStatus>& devices) {
  std::vector<std::vector<std::string>> rows = {{"nr", "serial", "kind", "role", "state",
                                                 "extension", "rate Hz", "jitter ms", "battery",
                                                 "leds", "marks"}};
  std::string notes;
  for (const DeviceStatus& device : devices) {
    rows.push_back({std::to_string(device.device), device.serial, stream::Name(device.kind),
                    RigRole(device), stream::Name(device.state), ExtensionWord(device),
                    Fixed(device.report_rate_hz, 1), Fixed(device.jitter_ms, 1), Battery(device),
                    Lamps(device.leds), Marks(device)});
    if (!device.note.empty()) notes += device.serial + ": " + device.note + "\n";
  }
  return Table(rows) + notes;
}

ordered_json SetupToJson(const std::vector<stream::RigSetup>& rigs) {
  ordered_json out = ordered_json::array();
  for (const stream::RigSetup& rig : rigs) {
    ordered_json items = ordered_json::array();
    for (const stream::SetupItem& item : rig.items) {
      items.push_back({{"name", item.name},
                       {"serial", item.serial},
                       {"passed", item.passed},
                       {"date", Date(item.wall_time_ns)},
                       {"wall_time_ns", item.wall_time_ns},
                       {"residual", item.residual},
                       {"unit", item.unit},
                       {"stale", item.stale},
                       {"note", item.note}});
    }
    out.push_back({{"rig", rig.rig},
                   {"layout", {{"preset", rig.layout.preset}, {"gap_mm", rig.layout.gap_mm}}},
                   {"items", std::move(items)}});
  }
  return out;
}

std::string SetupTable(const std::vector<stream::RigSetup>& rigs) {
  std::vector<std::vector<std::string>> rows = {
      {"rig", "setup", "device", "result", "date", "residual", "note"}};
  bool is_set_up = false;
  for (const stream::RigSetup& rig : rigs) {
    bool has_layout = false;
    for (const stream::SetupItem& item : rig.items) {
      is_set_up = true;
      has_layout = has_layout || item.name == "layout";
      rows.push_back({rig.rig, item.name, item.serial.empty() ? "-" : item.serial,
                      !item.passed ? "FAILED"
                      : item.stale ? "STALE"
                                   : "ok",
                      Date(item.wall_time_ns),
                      item.unit.empty() ? "-" : Fixed(item.residual, 2) + " " + item.unit,
                      item.note});
    }
    // Chosen, but never checked with a person on the boards.
    if (!rig.layout.preset.empty() && !has_layout) {
      rows.push_back({rig.rig, "layout", "-", "set", "-", "-", rig.layout.preset});
    }
  }
  if (rows.size() == 1) return "nothing is set up yet: footing-ctl setup\n";
  return Table(rows) + (is_set_up ? "" : "nothing else is set up yet: footing-ctl setup\n");
}

namespace {

std::string WhatThereIs(const std::vector<DeviceStatus>& devices) {
  if (devices.empty()) return "footingd has no device: pair one with footing-ctl pair";
  std::string text = "there are:";
  for (const DeviceStatus& device : devices) {
    text += " " + std::to_string(device.device) + " = " + device.serial;
    if (device.role != stream::DeviceRole::kUnspecified) {
      text += " = " + device.rig + "/" + stream::Name(device.role);
    }
    text += device.state == stream::DeviceState::kLost ? " (lost)," : ",";
  }
  text.pop_back();
  return text;
}

bool Answers(const DeviceStatus& device, const std::string& name) {
  if (text::Lower(device.serial) == name || std::to_string(device.device) == name) return true;
  if (device.role == stream::DeviceRole::kUnspecified) return false;
  if (device.state == stream::DeviceState::kLost) return false;
  const std::string role = stream::Name(device.role);
  return name == role || name == text::Lower(device.rig) + "/" + role;
}

}  // namespace

Result<DeviceStatus> FindDevice(const std::vector<DeviceStatus>& devices, const std::string& name) {
  const std::string wanted = text::Lower(name);
  std::vector<DeviceStatus> found;
  for (const DeviceStatus& device : devices) {
    if (Answers(device, wanted)) found.push_back(device);
  }
  if (found.size() == 1) return found.front();
  if (found.empty()) return NoDevice("no device " + name + "; " + WhatThereIs(devices));
  return NoDevice("more than one device is " + name + "; " + WhatThereIs(found));
}

Boards BoardsOf(const std::vector<DeviceStatus>& devices) {
  Boards boards;
  for (const DeviceStatus& device : devices) {
    if (device.kind != stream::DeviceKind::kBalanceBoard) continue;
    if (device.state != stream::DeviceState::kLost) {
      boards.there.push_back(device);
      continue;
    }
    const bool needed =
        device.role != stream::DeviceRole::kUnspecified &&
        std::none_of(devices.begin(), devices.end(), [&](const DeviceStatus& other) {
          return other.state != stream::DeviceState::kLost && other.rig == device.rig &&
                 other.role == device.role;
        });
    if (needed) boards.lost.push_back(device);
  }
  return boards;
}

std::vector<DeviceStatus> Reassigned(const std::vector<DeviceStatus>& before,
                                     const std::vector<DeviceStatus>& now) {
  std::vector<DeviceStatus> changed;
  for (const DeviceStatus& device : now) {
    const bool known = std::any_of(before.begin(), before.end(), [&](const DeviceStatus& other) {
      return other.device == device.device && other.serial == device.serial &&
             (other.rig != device.rig || other.role != device.role);
    });
    if (known) changed.push_back(device);
  }
  return changed;
}

Result<std::pair<std::string, stream::DeviceRole>> ParseRigRole(const std::string& text) {
  const std::size_t slash = text.rfind('/');  // A rig's name may have one.
  const std::string rig = slash == std::string::npos ? "" : text.substr(0, slash);
  const std::string name = slash == std::string::npos ? text : text.substr(slash + 1);
  const stream::DeviceRole role = stream::RoleNamed(name);
  if (role == stream::DeviceRole::kUnspecified || (slash != std::string::npos && rig.empty())) {
    return UsageError(
        text + " is not a RIG/ROLE such as main/left_hand; roles are: " + stream::RoleNames());
  }
  return std::make_pair(rig, role);
}

}  // namespace footing::ctl::display
