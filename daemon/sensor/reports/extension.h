#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemon/sensor/reports/input_report.h"

/// What is plugged into the extension port, and the Balance Board's bytes.
namespace footing::reports {

enum class Extension {
  kNotReady,  ///< All FF, or encrypted leftovers: ask again, do not conclude that there is none.
  kNunchuk,
  kClassic,  ///< Classic Controller or Classic Controller Pro.
  kBalanceBoard,
  kMotionPlusInactive,  ///< Answers at 0xa600fa only.
  kMotionPlus,          ///< Active, alone; from here on it answers at 0xa400fa.
  kMotionPlusNunchuk,   ///< Active, with a Nunchuk's packets in between.
  kMotionPlusClassic,   ///< Active, with a Classic's packets in between.
  kOther,
};

/// From the six bytes at 0xa400fa (0xa600fa of an inactive MotionPlus). The first byte varies
/// between units and does not count.
Extension IdentifyExtension(Bytes id);

/// Corners in the order in which the board's bytes and calibration have them.
enum Corner : std::size_t { kTopRight = 0, kBottomRight = 1, kTopLeft = 2, kBottomLeft = 3 };
inline constexpr std::size_t kCorners = 4;

struct BoardCounts {
  std::array<std::uint16_t, kCorners> corners{};
  bool has_temperature = false;
  std::uint8_t temperature = 0;
  bool has_battery = false;
  std::uint8_t battery = 0;  ///< Raw; see BoardBatteryFraction.
};

/// From the extension bytes of report 0x32 (no battery) or 0x34; none when fewer than 8.
std::optional<BoardCounts> DecodeBoard(Bytes extension);

/// 0 to 1, from byte 10: four bars begin at 0x6a, 0x78, 0x7d, 0x82, and 0xa0 is full.
double BoardBatteryFraction(std::uint8_t raw);

/// Every extension's data is six bytes; a report may carry more, which are padding.
inline constexpr std::size_t kExtensionDataBytes = 6;

struct NunchukCounts {
  std::uint8_t stick_x = 0;                     ///< Rises to the right.
  std::uint8_t stick_y = 0;                     ///< Rises to the front.
  std::array<std::uint16_t, 3> acceleration{};  ///< x, y, z of 10 bits.
  bool c = false;
  bool z = false;
};

/// None when fewer than six bytes, or all FF (the port does not answer).
std::optional<NunchukCounts> DecodeNunchuk(Bytes extension);
/// The form in which a MotionPlus passes it on: the lowest bit of each axis is lost, and 0 here.
std::optional<NunchukCounts> DecodePassedNunchuk(Bytes extension);

/// Bits of ClassicCounts::buttons: data byte 4 in bits 8 to 15, byte 5 in bits 0 to 7.
enum ClassicButton : std::uint16_t {
  kClassicRightTrigger = 0x0200,
  kClassicPlus = 0x0400,
  kClassicHome = 0x0800,
  kClassicMinus = 0x1000,
  kClassicLeftTrigger = 0x2000,
  kClassicDown = 0x4000,
  kClassicRight = 0x8000,
  kClassicUp = 0x0001,
  kClassicLeft = 0x0002,
  kClassicZr = 0x0004,
  kClassicX = 0x0008,
  kClassicA = 0x0010,
  kClassicY = 0x0020,
  kClassicB = 0x0040,
  kClassicZl = 0x0080,
};

struct ClassicCounts {
  std::uint8_t left_x = 0;  ///< 6 bits; sticks rise to the right and to the front.
  std::uint8_t left_y = 0;
  std::uint8_t right_x = 0;  ///< 5 bits.
  std::uint8_t right_y = 0;
  std::uint8_t left_trigger = 0;  ///< 5 bits; rise when pressed.
  std::uint8_t right_trigger = 0;
  std::uint16_t buttons = 0;
};

/// None when fewer than six bytes, or all FF.
std::optional<ClassicCounts> DecodeClassic(Bytes extension);
/// The form in which a MotionPlus passes it on: the lowest bits of the left stick are lost.
std::optional<ClassicCounts> DecodePassedClassic(Bytes extension);

/// What a packet of an active MotionPlus is.
enum class PassedPacket {
  kMotionPlus,
  kExtension,  ///< Of the child: Nunchuk or Classic.
  kRubbish,    ///< Short, all 00, or with the bit set that is always 0: right after activation.
};

PassedPacket PacketOf(Bytes extension);

/// Order of the axes in packets and calibration.
enum MotionPlusAxis : std::size_t { kYaw = 0, kRoll = 1, kPitch = 2 };

struct MotionPlusCounts {
  std::array<std::uint16_t, 3> counts{};  ///< In the order of MotionPlusAxis, 14 bits.
  std::array<bool, 3> slow{};             ///< The axis uses its slow (fine) range in this packet.
  bool extension_connected = false;       ///< A child is in the MotionPlus' own port.
};

/// None unless PacketOf says kMotionPlus.
std::optional<MotionPlusCounts> DecodeMotionPlus(Bytes extension);

/// Whether a child is plugged into the MotionPlus: packets of both kinds say so. None for rubbish.
std::optional<bool> ChildConnected(Bytes extension);

}  // namespace footing::reports
