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
  kBalanceBoard,
  kOther,
};

/// From the six bytes at 0xa400fa. The first byte varies between units and does not count.
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

}  // namespace footing::reports
