#include "daemon/sensor/kinds/pro_controller.h"

#include <algorithm>

#include "daemon/sensor/kinds/decoded.h"

namespace footing::pro_controller {
namespace {

constexpr double kLowBattery = 0.26;  // One bar of four.
constexpr std::size_t kDataBytes = 11;
constexpr int kMiddleCounts = 0x800;
constexpr double kSpanCounts = 0x400;  // Nominal: hid-wiimote's range of an axis.
constexpr double kFullBattery = 4;

double StickOf(std::uint16_t counts) {
  return std::clamp((counts - kMiddleCounts) / kSpanCounts, -1.0, 1.0);
}

}  // namespace

std::optional<Counts> DecodeCounts(reports::Bytes extension) {
  if (extension.size() < kDataBytes) return std::nullopt;
  const reports::Bytes b = extension.first(kDataBytes);
  if (std::all_of(b.begin(), b.end(), [](std::uint8_t one) { return one == 0xff; })) {
    return std::nullopt;
  }
  Counts counts;
  for (std::size_t axis = 0; axis < counts.sticks.size(); ++axis) {
    counts.sticks[axis] = static_cast<std::uint16_t>((b[2 * axis + 1] & 0x0f) << 8 | b[2 * axis]);
  }
  // 0 is pressed; bit 0 of byte 8 is unused.
  counts.buttons = static_cast<std::uint16_t>((~b[8] & 0xfe) << 8 | (~b[9] & 0xff));
  counts.left_stick = (b[10] & 0x02) == 0;
  counts.right_stick = (b[10] & 0x01) == 0;
  counts.battery = b[10] >> 4 & 0x07;
  return counts;
}

decode::Decoded Decoder::Take(reports::Bytes extension) {
  decode::Decoded decoded;
  const auto counts = DecodeCounts(extension);
  if (!counts) return decoded;
  stream::GamepadSample& sample = decoded.gamepad.emplace();
  sample.left_x = StickOf(counts->sticks[kLeftX]);
  sample.left_y = StickOf(counts->sticks[kLeftY]);
  sample.right_x = StickOf(counts->sticks[kRightX]);
  sample.right_y = StickOf(counts->sticks[kRightY]);
  sample.buttons = decode::GamepadButtons(counts->buttons) |
                   (counts->left_stick ? stream::kGamepadLeftStick : 0u) |
                   (counts->right_stick ? stream::kGamepadRightStick : 0u);
  sample.left_trigger = (sample.buttons & stream::kGamepadL) != 0 ? 1 : 0;
  sample.right_trigger = (sample.buttons & stream::kGamepadR) != 0 ? 1 : 0;
  sample.uncalibrated = true;
  sample.repeated = last_ && decode::SameReading(*last_, sample);
  decoded.changed = !sample.repeated;
  last_ = sample;
  battery_fraction_ = std::min(1.0, counts->battery / kFullBattery);
  return decoded;
}

decode::Decoded ProController::Take(const handshake::HandshakeSequencer&,
                                    const reports::InputReport& report) {
  const auto* data = std::get_if<reports::Data>(&report.body);
  return data == nullptr ? decode::Decoded() : decoder_.Take(data->extension());
}

void ProController::AddTo(const handshake::HandshakeSequencer&,
                          stream::DeviceStatus& status) const {
  status.battery_fraction = decoder_.battery_fraction();
  status.battery_low = status.battery_fraction >= 0 && status.battery_fraction < kLowBattery;
}

}  // namespace footing::pro_controller
