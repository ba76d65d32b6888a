#include "clients/ctl/report/device_table.h"

#include <array>

#include "clients/ctl/report/format.h"

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

}  // namespace footing::ctl::display
