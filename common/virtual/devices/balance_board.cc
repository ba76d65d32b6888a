#include "common/virtual/devices/balance_board.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::virtual_devices {
namespace {

constexpr double kStepKg = 17;
constexpr double kFactor = 0.99908;
constexpr double kTemperatureSlope = 0.007 / 10;  // Relative, a step of the thermometer.

std::array<BalanceBoard::Points, BalanceBoard::kCorners> DrawPoints(std::uint64_t seed) {
  // Real boards: 2800 to 8300 counts empty, 9.8 to 11.5 g a count, another slope above 17 kg.
  noise::Random random(seed);
  std::array<BalanceBoard::Points, BalanceBoard::kCorners> points;
  for (BalanceBoard::Points& corner : points) {
    corner[0] = static_cast<int>(random.Uniform(2800, 8300));
    corner[1] = corner[0] + static_cast<int>(kStepKg / random.Uniform(0.0098, 0.0108));
    corner[2] = corner[1] + static_cast<int>(kStepKg / random.Uniform(0.0100, 0.0115));
  }
  return points;
}

Memory MakeMemory(const std::array<BalanceBoard::Points, BalanceBoard::kCorners>& points) {
  Memory memory(true);
  const std::span<std::uint8_t> page = memory.extension();
  page[0x20] = 0x01;
  page[0x21] = 0x69;
  for (std::size_t i = 0; i < 3 * BalanceBoard::kCorners; ++i) {
    const int count = points[i % BalanceBoard::kCorners][i / BalanceBoard::kCorners];
    page[0x24 + 2 * i] = static_cast<std::uint8_t>(count >> 8);
    page[0x25 + 2 * i] = static_cast<std::uint8_t>(count);
  }
  page[0x60] = BalanceBoard::kReferenceTemperature;
  page[0x61] = 0x01;
  uLong crc = crc32(0, page.data() + 0x24, 24);
  crc = crc32(crc, page.data() + 0x20, 2);
  crc = crc32(crc, page.data() + 0x60, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    page[0x3c + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
  constexpr std::uint8_t kIdentity[] = {0x00, 0x00, 0xa4, 0x20, 0x04, 0x02};
  std::copy(std::begin(kIdentity), std::end(kIdentity), page.begin() + 0xfa);
  return memory;
}

/// `kg` as the cell has it, before the host's correction.
std::uint16_t Counts(const BalanceBoard::Points& points, double kg) {
  const std::size_t low = kg < kStepKg ? 0 : 1;
  const double counts = points[low] + (kg - kStepKg * static_cast<double>(low)) / kStepKg *
                                          (points[low + 1] - points[low]);
  return static_cast<std::uint16_t>(std::clamp(std::round(counts), 0.0, 65535.0));
}

}  // namespace

BalanceBoard::BalanceBoard(std::uint64_t seed) : BalanceBoard(seed, DrawPoints(seed)) {}

BalanceBoard::BalanceBoard(std::uint64_t seed, const std::array<Points, kCorners>& points)
    : points_(points), controller_(MakeMemory(points_)) {
  identity_.name = "Nintendo RVL-WBC-01";
  identity_.serial = MakeSerial(SerialOf::kBalanceBoard, seed);
}

std::optional<Report> BalanceBoard::Sample(const CornerForces& forces, bool button) {
  Readings readings;
  readings.buttons = button ? 0x0008 : 0;
  readings.extension.fill(0xff);
  if (controller_.memory().extension_plain()) {
    const double corners[kCorners] = {forces.top_right_n, forces.bottom_right_n, forces.top_left_n,
                                      forces.bottom_left_n};
    readings.extension.fill(0);
    const double correction =
        kFactor * (1 - kTemperatureSlope * (temperature_ - kReferenceTemperature));
    for (std::size_t i = 0; i < kCorners; ++i) {
      const double kg = std::isfinite(corners[i]) ? NewtonsToKilograms(corners[i]) : 0;
      const std::uint16_t counts = Counts(points_[i], kg / correction);
      readings.extension[2 * i] = static_cast<std::uint8_t>(counts >> 8);
      readings.extension[2 * i + 1] = static_cast<std::uint8_t>(counts);
    }
    readings.extension[8] = temperature_;
    readings.extension[10] = battery_;
  }
  return controller_.DataReport(readings);
}

}  // namespace footing::virtual_devices
