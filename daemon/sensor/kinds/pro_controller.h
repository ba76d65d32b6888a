#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/wiimote_protocol.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::pro_controller {

/// Order of the sticks' axes in the data bytes.
enum Axis : std::size_t { kLeftX = 0, kRightX = 1, kLeftY = 2, kRightY = 3 };

/// Raw values of a Pro Controller's report.
struct Counts {
  std::array<std::uint16_t, 4> sticks{};  ///< 12 bits; rise to the right and to the front.
  std::uint16_t buttons = 0;              ///< Bits of reports::ClassicButton.
  bool left_stick = false;                ///< Pressed in.
  bool right_stick = false;
  std::uint8_t battery = 0;  ///< 0 empty to 4 full.
};

/// From the extension bytes of report 0x34, as the kernel's hid-wiimote has them (WiiUBrew's
/// discussion page gives the sticks' axes in another order): eight of the sticks, low byte first,
/// then three of buttons. None when fewer than these eleven, or all FF (it does not answer).
std::optional<Counts> DecodeCounts(reports::Bytes extension);

/// Its data reports. A plain value.
class Decoder {
 public:
  /// Empty when the report has no data of it.
  decode::Decoded Take(reports::Bytes extension);
  /// 0 to 1; -1 until a report had it.
  double battery_fraction() const { return battery_fraction_; }

 private:
  std::optional<stream::GamepadSample> last_;
  double battery_fraction_ = -1;
};

/// A Wii U Pro Controller: a gamepad that speaks the Wiimote's protocol, with the product id of a
/// Wiimote -TR. Its name or what answers at its port says what it is.
class ProController : public kinds::Speaker {
 public:
  static constexpr handshake::Plan kPlan = {false, 0x34, {0x01, 0x20}};

  static bool Matches(const decode::Product& product) {
    return product.name.find("RVL-CNT-01-UC") != std::string::npos;
  }

  explicit ProController(const decode::KindOptions&) {}

  stream::DeviceKind kind() const override { return stream::DeviceKind::kProController; }
  decode::Placement placement() const override { return decode::Placement::kInBothHands; }
  decode::Timing timing() const override { return {0.01, 0.01}; }

  void Restart() override { decoder_ = Decoder(); }
  decode::Decoded Take(const handshake::HandshakeSequencer& sequencer,
                       const reports::InputReport& report) override;
  void AddTo(const handshake::HandshakeSequencer& sequencer,
             stream::DeviceStatus& status) const override;

 private:
  Decoder decoder_;
};

}  // namespace footing::pro_controller
