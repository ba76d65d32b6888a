#include "daemon/sensor/reports/extension.h"

#include <algorithm>

namespace footing::reports {

namespace {

struct Identity {
  std::uint8_t bus;  ///< Byte 2: a4 answers data reports, a6 is a MotionPlus that is not active.
  std::uint8_t mode;
  std::uint8_t type;
  Extension extension;
};

constexpr Identity kIdentities[] = {
    // byte 2, 4, 5
    {0xa4, 0x00, 0x00, Extension::kNunchuk},
    {0xa4, 0x01, 0x01, Extension::kClassic},
    {0xa4, 0x04, 0x02, Extension::kBalanceBoard},
    {0xa4, 0x04, 0x05, Extension::kMotionPlus},
    {0xa4, 0x05, 0x05, Extension::kMotionPlusNunchuk},
    {0xa4, 0x07, 0x05, Extension::kMotionPlusClassic},
};

}  // namespace

Extension IdentifyExtension(Bytes id) {
  if (id.size() < 6 || id[3] != 0x20) return Extension::kNotReady;
  // One that was active before keeps its old mode in byte 4.
  if (id[2] == 0xa6 && id[5] == 0x05) return Extension::kMotionPlusInactive;
  if (id[2] != 0xa4) return Extension::kNotReady;
  for (const Identity& known : kIdentities) {
    if (id[4] == known.mode && id[5] == known.type) return known.extension;
  }
  return Extension::kOther;
}

std::optional<BoardCounts> DecodeBoard(Bytes extension) {
  if (extension.size() < 2 * kCorners) return std::nullopt;
  BoardCounts counts;
  for (std::size_t i = 0; i < kCorners; ++i) {
    counts.corners[i] = static_cast<std::uint16_t>(extension[2 * i] << 8 | extension[2 * i + 1]);
  }
  if (extension.size() > 8) {
    counts.has_temperature = true;
    counts.temperature = extension[8];
  }
  if (extension.size() > 10) {
    counts.has_battery = true;
    counts.battery = extension[10];
  }
  return counts;
}

double BoardBatteryFraction(std::uint8_t raw) {
  // Empty just below the first bar, full at 0xa0; the bars are not evenly spaced in volts.
  struct Point {
    double raw;
    double fraction;
  };
  constexpr Point kPoints[] = {{0x60, 0.0},  {0x6a, 0.25}, {0x78, 0.5},
                               {0x7d, 0.75}, {0x82, 0.9},  {0xa0, 1.0}};
  if (raw <= kPoints[0].raw) return 0;
  for (std::size_t i = 1; i < std::size(kPoints); ++i) {
    const Point& low = kPoints[i - 1];
    const Point& high = kPoints[i];
    if (raw <= high.raw) {
      return low.fraction + (high.fraction - low.fraction) * (raw - low.raw) / (high.raw - low.raw);
    }
  }
  return 1;
}

}  // namespace footing::reports
