#include "daemon/sensor/reports/extension.h"

#include <algorithm>

namespace footing::reports {

Extension IdentifyExtension(Bytes id) {
  if (id.size() < 6 || id[2] != 0xa4 || id[3] != 0x20) return Extension::kNotReady;
  if (id[4] == 0x00 && id[5] == 0x00) return Extension::kNunchuk;
  if (id[4] == 0x04 && id[5] == 0x02) return Extension::kBalanceBoard;
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
