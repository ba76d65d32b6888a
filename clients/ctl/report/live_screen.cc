#include "clients/ctl/report/live_screen.h"

#include <cmath>

#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/format.h"
#include "clients/ctl/report/server_table.h"
#include "common/base/units.h"

namespace footing::ctl::display {
namespace {

using nlohmann::ordered_json;
using stream::DeviceStatus;

constexpr double kFullCornerKg = 40;   // Of 150 kg a board, evenly on four cells.
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

}  // namespace footing::ctl::display
