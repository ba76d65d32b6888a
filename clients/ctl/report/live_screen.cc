#include "clients/ctl/report/live_screen.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <vector>

#include "clients/ctl/report/device_table.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::ctl::display {
namespace {

using nlohmann::ordered_json;
using stream::DeviceStatus;

constexpr double kFullCornerKg = 40;   // Full board: 150 kg, evenly on four cells.
constexpr double kFullForceMps2 = 40;  // A Wiimote's range ends there.
constexpr int kBarCells = 20;

std::string Percent(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "-";
  return Fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::string Corner(const char* name, double force_n) {
  const double mass_kg = NewtonsToKilograms(force_n);
  const std::string number = Fixed(mass_kg, 1);
  return std::string("  ") + name + " [" + Bar(mass_kg, kFullCornerKg, kBarCells) + "] " +
         std::string(number.size() < 6 ? 6 - number.size() : 0, ' ') + number + " kg";
}

std::string Side(double value_m, const char* positive, const char* negative) {
  return Fixed(1e3 * std::abs(value_m), 0) + " mm " + (value_m >= 0 ? positive : negative);
}

std::string CentreOfPressure(const stream::BoardSample& board) {
  if (!board.cop_valid) return "no centre of pressure (too little load)";
  return "centre of pressure " + Side(board.cop_x_m, "right", "left") + ", " +
         Side(board.cop_y_m, "front", "rear");
}

std::string BoardLines(const stream::BoardSample& board) {
  return Corner("TL", board.top_left_n) + Corner("TR", board.top_right_n) + "\n" +
         Corner("BL", board.bottom_left_n) + Corner("BR", board.bottom_right_n) + "\n  total " +
         Fixed(NewtonsToKilograms(board.total_n), 1) + " kg, " + CentreOfPressure(board) +
         (board.tared ? "" : ", not tared") + (board.uncalibrated ? ", UNCALIBRATED" : "") + "\n";
}

std::string Axes(const Eigen::Vector3d& value, int decimals) {
  return "(" + Fixed(value.x(), decimals) + ", " + Fixed(value.y(), decimals) + ", " +
         Fixed(value.z(), decimals) + ")";
}

std::string MotionLine(const stream::MotionSample& motion) {
  const double force_mps2 = motion.specific_force_mps2.norm();
  std::string line = "  |f| [" + Bar(force_mps2, kFullForceMps2, kBarCells) + "] " +
                     Fixed(force_mps2, 1) + " m/s2 " + Axes(motion.specific_force_mps2, 1);
  if (motion.has_angular_velocity) {
    line += "  turn " + Axes(motion.angular_velocity_radps, 2) + " rad/s";
  }
  if (motion.clipped_axes != 0) line += "  CLIPPED";
  if (motion.uncalibrated) line += "  UNCALIBRATED";
  return line + "\n";
}

std::string Stick(double x, double y) { return "(" + Fixed(x, 2) + ", " + Fixed(y, 2) + ")"; }

std::string NunchukLine(const stream::NunchukSample& nunchuk) {
  return "  nunchuk stick " + Stick(nunchuk.stick_x, nunchuk.stick_y) + (nunchuk.c ? " C" : "") +
         (nunchuk.z ? " Z" : "") + " " + Axes(nunchuk.specific_force_mps2, 1) + " m/s2\n";
}

struct ButtonName {
  stream::GamepadButton button;
  const char* name;
};
constexpr ButtonName kButtonNames[] = {
    {stream::kGamepadA, "A"},
    {stream::kGamepadB, "B"},
    {stream::kGamepadX, "X"},
    {stream::kGamepadY, "Y"},
    {stream::kGamepadL, "L"},
    {stream::kGamepadR, "R"},
    {stream::kGamepadZl, "ZL"},
    {stream::kGamepadZr, "ZR"},
    {stream::kGamepadMinus, "minus"},
    {stream::kGamepadPlus, "plus"},
    {stream::kGamepadHome, "home"},
    {stream::kGamepadUp, "up"},
    {stream::kGamepadDown, "down"},
    {stream::kGamepadLeft, "left"},
    {stream::kGamepadRight, "right"},
    {stream::kGamepadLeftStick, "left stick"},
    {stream::kGamepadRightStick, "right stick"},
};

std::string GamepadLine(const stream::GamepadSample& gamepad) {
  std::string line = "  sticks " + Stick(gamepad.left_x, gamepad.left_y) + " " +
                     Stick(gamepad.right_x, gamepad.right_y) + "  triggers " +
                     Fixed(gamepad.left_trigger, 2) + " " + Fixed(gamepad.right_trigger, 2);
  std::string pressed;
  for (const ButtonName& one : kButtonNames) {
    if ((gamepad.buttons & one.button) != 0)
      pressed += std::string(pressed.empty() ? "  " : ", ") + one.name;
  }
  return line + pressed + (gamepad.uncalibrated ? "  UNCALIBRATED" : "") + "\n";
}

std::string Title(const DeviceStatus& device) {
  return std::to_string(device.device) + " " +
         (device.role == stream::DeviceRole::kUnspecified ? device.serial : RigRole(device));
}

ordered_json VectorToJson(const Eigen::Vector3d& value) {
  return {value.x(), value.y(), value.z()};
}

ordered_json BoardToJson(const stream::BoardSample& board) {
  return {{"top_left_kg", NewtonsToKilograms(board.top_left_n)},
          {"top_right_kg", NewtonsToKilograms(board.top_right_n)},
          {"bottom_left_kg", NewtonsToKilograms(board.bottom_left_n)},
          {"bottom_right_kg", NewtonsToKilograms(board.bottom_right_n)},
          {"total_kg", NewtonsToKilograms(board.total_n)},
          {"cop_valid", board.cop_valid},
          {"cop_x_mm", 1e3 * board.cop_x_m},
          {"cop_y_mm", 1e3 * board.cop_y_m},
          {"contact", board.contact}};
}

ordered_json NewestToJson(const Live::Newest& newest) {
  ordered_json out{{"samples", newest.samples}};
  if (newest.motion) {
    out["motion"] = {{"specific_force_mps2", VectorToJson(newest.motion->specific_force_mps2)},
                     {"buttons", newest.motion->buttons}};
    if (newest.motion->has_angular_velocity) {
      out["motion"]["angular_velocity_radps"] = VectorToJson(newest.motion->angular_velocity_radps);
    }
  }
  if (newest.nunchuk) {
    out["nunchuk"] = {{"stick_x", newest.nunchuk->stick_x},
                      {"stick_y", newest.nunchuk->stick_y},
                      {"c", newest.nunchuk->c},
                      {"z", newest.nunchuk->z}};
  }
  if (newest.gamepad) {
    out["gamepad"] = {{"left_x", newest.gamepad->left_x},
                      {"left_y", newest.gamepad->left_y},
                      {"right_x", newest.gamepad->right_x},
                      {"right_y", newest.gamepad->right_y},
                      {"left_trigger", newest.gamepad->left_trigger},
                      {"right_trigger", newest.gamepad->right_trigger},
                      {"buttons", newest.gamepad->buttons}};
  }
  if (newest.board) out["board"] = BoardToJson(*newest.board);
  return out;
}

}  // namespace

void Live::Take(const stream::MotionSample& sample) {
  newest[sample.device].motion = sample;
  ++newest[sample.device].samples;
}

void Live::Take(const stream::NunchukSample& sample) { newest[sample.device].nunchuk = sample; }

void Live::Take(const stream::GamepadSample& sample) {
  Newest& of_device = newest[sample.device];
  of_device.gamepad = sample;
  if (!of_device.motion) ++of_device.samples;
}

void Live::Take(const stream::BoardSample& sample) {
  newest[sample.device].board = sample;
  ++newest[sample.device].samples;
}

std::string LiveScreen(const Live& live) {
  std::vector<std::vector<std::string>> rows = {{"nr", "role", "serial", "state", "rate Hz",
                                                 "jitter ms", "gaps", "repeats", "battery",
                                                 "extension"}};
  std::string below;
  for (const DeviceStatus& device : live.devices) {
    rows.push_back(
        {std::to_string(device.device), RigRole(device), device.serial, stream::Name(device.state),
         Fixed(device.report_rate_hz, 1), Fixed(device.jitter_ms, 1), std::to_string(device.gaps),
         Percent(device.repeats, device.reports), Battery(device),
         device.kind == stream::DeviceKind::kWiimote ? stream::Name(device.extension) : "-"});
    const auto found = live.newest.find(device.device);
    const bool measures = found != live.newest.end() && device.state == stream::DeviceState::kLive;
    if (!measures && device.note.empty()) continue;
    below += "\n" + Title(device) + (device.simulated ? " (simulated)" : "") + "\n";
    if (!device.note.empty()) below += "  " + device.note + "\n";
    if (!measures) continue;
    if (found->second.board) below += BoardLines(*found->second.board);
    if (found->second.motion) below += MotionLine(*found->second.motion);
    if (found->second.nunchuk) below += NunchukLine(*found->second.nunchuk);
    if (found->second.gamepad) below += GamepadLine(*found->second.gamepad);
  }
  if (live.devices.empty()) below = "no device yet: footing-ctl pair, then press a button on it\n";
  const std::string notice = live.notice.empty() ? "" : "NOTICE: " + live.notice + "\n";
  const std::string server = live.server ? ServerLine(*live.server) + "\n" : "";
  return live.link + "\n" + server + notice + "\n" + Table(rows) + below;
}

std::string LiveLine(const Live& live) {
  const std::string notice = live.notice.empty() ? "" : " | NOTICE: " + live.notice;
  if (live.lost) return live.link;
  if (live.devices.empty()) return "no device yet" + notice;
  std::string line;
  for (const DeviceStatus& device : live.devices) {
    line += (line.empty() ? "" : " | ") + Title(device) + " " + stream::Name(device.state) + " " +
            Fixed(device.report_rate_hz, 1) + " Hz, jitter " + Fixed(device.jitter_ms, 1) +
            " ms, gaps " + std::to_string(device.gaps) + ", repeats " +
            Percent(device.repeats, device.reports) + ", battery " + Battery(device);
    const auto found = live.newest.find(device.device);
    if (found != live.newest.end() && found->second.board) {
      line += ", " + Fixed(NewtonsToKilograms(found->second.board->total_n), 1) + " kg";
    }
  }
  return line + notice;
}

ordered_json LiveToJson(const Live& live, double seconds) {
  ordered_json devices = ordered_json::array();
  for (const DeviceStatus& device : live.devices) {
    ordered_json one = DeviceToJson(device);
    const auto found = live.newest.find(device.device);
    one.update(NewestToJson(found == live.newest.end() ? Live::Newest() : found->second));
    devices.push_back(std::move(one));
  }
  return {{"seconds", seconds},
          {"link", live.link},
          {"notice", live.notice},
          {"devices", std::move(devices)}};
}

namespace {

std::string Plural(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string Counted(std::uint64_t count, const std::string& noun, const std::string& what = "") {
  return count == 0 ? "" : ", " + Plural(count, noun) + what;
}

ordered_json KnownOrNull(bool known, double value) {
  return known ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json SessionToJson(const stream::SessionStats& one) {
  return {{"session", one.session},
          {"client", one.client_name},
          {"role", one.role},
          {"local", one.local},
          {"connected_s", one.connected_s},
          {"policy", one.policy},
          {"queue_ticks", one.queue_ticks},
          {"queue_capacity", one.queue_capacity},
          {"lag_s", one.lag_s},
          {"ticks_sent", one.ticks_sent},
          {"ticks_dropped", one.ticks_dropped},
          {"budget_refusals", one.slowed},
          {"clock_offset_s", KnownOrNull(one.clock_valid, one.clock_offset_s)},
          {"clock_uncertainty_s", KnownOrNull(one.clock_valid, one.clock_uncertainty_s)}};
}

ordered_json DeviceToJson(const stream::DeviceStats& one) {
  return {{"device", one.device},
          {"serial", one.serial},
          {"state", stream::Name(one.state)},
          {"report_rate_hz", one.report_rate_hz},
          {"jitter_s", one.jitter_s},
          {"reports", one.reports},
          {"gaps", one.gaps},
          {"queue_drops", one.queue_drops},
          {"undecodable", one.undecodable},
          {"writes_failed", one.writes_failed},
          {"battery_fraction", KnownOrNull(one.battery_fraction >= 0, one.battery_fraction)}};
}

}  // namespace

ordered_json ServerStatsToJson(const stream::ServerStats& stats) {
  ordered_json sessions = ordered_json::array(), devices = ordered_json::array();
  for (const auto& one : stats.sessions) sessions.push_back(SessionToJson(one));
  for (const auto& one : stats.devices) devices.push_back(DeviceToJson(one));
  return {{"uptime_s", stats.uptime_s},
          {"ticks",
           {{"ticks", stats.ticks.ticks},
            {"rate_hz", stats.ticks.rate_hz},
            {"late_max_s", stats.ticks.late_max_s},
            {"overruns", stats.ticks.overruns},
            {"left_out", stats.ticks.left_out}}},
          {"session_count", stats.session_count},
          {"connections_accepted", stats.sessions_accepted},
          {"connections_refused", stats.sessions_refused},
          {"ticks_dropped", stats.ticks_dropped},
          {"budget_refusals", stats.slowed},
          {"channels_left_out", stats.channels_left_out},
          {"ring_bytes", stats.ring_bytes},
          {"sessions", std::move(sessions)},
          {"devices", std::move(devices)}};
}

std::string ServerLine(const stream::ServerStats& stats) {
  return "up " + Fixed(stats.uptime_s, 0) + " s, " + Fixed(stats.ticks.rate_hz, 1) +
         " ticks per second, max delay " + Fixed(1e3 * stats.ticks.late_max_s, 1) + " ms, " +
         Plural(stats.session_count, "session") + Counted(stats.ticks.overruns, "overrun") +
         Counted(stats.ticks.left_out, "tick", " skipped (overload)") +
         Counted(stats.ticks_dropped, "tick", " dropped (queue full)") +
         Counted(stats.slowed, "rate-limit wait") +
         Counted(stats.sessions_refused, "connection", " refused");
}

std::string SessionTable(const stream::ServerStats& stats) {
  if (stats.sessions.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"session", "client", "role", "policy", "queue", "lag ms", "sent", "dropped", "clock ms"}};
  for (const stream::SessionStats& one : stats.sessions) {
    rows.push_back({std::to_string(one.session), one.client_name, one.role,
                    one.policy.empty() ? "-" : one.policy,
                    std::to_string(one.queue_ticks) + "/" + std::to_string(one.queue_capacity),
                    Fixed(1e3 * one.lag_s, 1), std::to_string(one.ticks_sent),
                    std::to_string(one.ticks_dropped),
                    one.clock_valid ? Fixed(1e3 * one.clock_offset_s, 2) + " +-" +
                                          Fixed(1e3 * one.clock_uncertainty_s, 2)
                                    : "-"});
  }
  std::string text = Table(rows);
  if (stats.session_count > stats.sessions.size()) {
    text += "not shown: " + std::to_string(stats.session_count - stats.sessions.size()) +
            " that lag less\n";
  }
  return text;
}

namespace {

std::string TwoDigits(unsigned value) {
  return std::string(value < 10 ? "0" : "") + std::to_string(value);
}

bool IsNumber(const std::string& cell) {
  return cell.find_first_of("0123456789") != std::string::npos &&
         cell.find_first_not_of("0123456789.-% ") == std::string::npos;
}

}  // namespace

std::string Fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  return text::Fixed(value, decimals);
}

std::string Date(std::int64_t wall_time_ns) {
  if (wall_time_ns == 0) return "-";
  const std::chrono::sys_time<std::chrono::nanoseconds> time{
      std::chrono::nanoseconds(wall_time_ns)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(std::chrono::floor<std::chrono::minutes>(time - day));
  return std::to_string(static_cast<int>(date.year())) + "-" +
         TwoDigits(static_cast<unsigned>(date.month())) + "-" +
         TwoDigits(static_cast<unsigned>(date.day())) + " " +
         TwoDigits(static_cast<unsigned>(clock.hours().count())) + ":" +
         TwoDigits(static_cast<unsigned>(clock.minutes().count())) + " UTC";
}

std::string Table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      if (i > 0) line += "  ";
      line += IsNumber(row[i]) ? blanks + row[i] : row[i] + blanks;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string Bar(double value, double full, int cells) {
  const double share = std::isfinite(value) ? std::clamp(value / full, 0.0, 1.0) : 0.0;
  const auto filled = static_cast<std::size_t>(std::lround(share * cells));
  return std::string(filled, '#') + std::string(static_cast<std::size_t>(cells) - filled, '.');
}

std::string Lamps(std::uint32_t leds) {
  std::string text;
  for (unsigned bit = 0; bit < 4; ++bit) text += (leds >> bit & 1u) != 0 ? '1' : '0';
  return text;
}

}  // namespace footing::ctl::display
