#include "common/device_models/wiimote.h"

#include <algorithm>
#include <cmath>

#include "common/synthetic/random.h"
#include "common/units/units.h"

namespace footing::device_models {
namespace {

/// Raw axes point left, rear and up; S has left, front and down.
constexpr std::array<double, 3> kRawSigns = {+1, -1, -1};

/// In low..high, both included.
int Integer(synthetic::Random& random, int low, int high) {
  return low + static_cast<int>(random.Uniform() * (high - low + 1));
}

std::array<Wiimote::Axis, 3> DrawAxes(std::uint64_t seed) {
  // Around what real units have: zero near 521 and 532, 1 g 105 to 111 above it.
  synthetic::Random random(seed);
  std::array<Wiimote::Axis, 3> axes;
  for (Wiimote::Axis& axis : axes) {
    axis.zero_counts = Integer(random, 505, 535);
    axis.one_g_counts = axis.zero_counts + Integer(random, 103, 112);
  }
  return axes;
}

/// Upper bytes of x, y, z, then their low bits in one byte.
void PutTenBits(std::span<std::uint8_t> out, int x, int y, int z) {
  out[0] = static_cast<std::uint8_t>(x >> 2);
  out[1] = static_cast<std::uint8_t>(y >> 2);
  out[2] = static_cast<std::uint8_t>(z >> 2);
  out[3] = static_cast<std::uint8_t>((x & 3) << 4 | (y & 3) << 2 | (z & 3));
}

/// The last byte of a block: the sum of the others and 0x55.
void PutChecksum(std::span<std::uint8_t> block) {
  std::uint8_t sum = 0x55;
  for (const std::uint8_t byte : block.first(block.size() - 1)) {
    sum = static_cast<std::uint8_t>(sum + byte);
  }
  block.back() = sum;
}

Memory MakeMemory(const std::array<Wiimote::Axis, 3>& axes) {
  Memory memory(false);
  // Camera calibration: plausible positions; two copies.
  constexpr std::uint8_t kCamera[] = {0xa1, 0xaa, 0x8b, 0x99, 0xae, 0x9e, 0x78, 0x30, 0xa7, 0x74};
  for (const std::size_t at : {0x00u, 0x0bu}) {
    const auto block = memory.eeprom().subspan(at, 11);
    std::copy(std::begin(kCamera), std::end(kCamera), block.begin());
    PutChecksum(block);
  }
  for (const std::size_t at : {0x16u, 0x20u}) {
    const auto block = memory.eeprom().subspan(at, 10);
    PutTenBits(block, axes[0].zero_counts, axes[1].zero_counts, axes[2].zero_counts);
    PutTenBits(block.subspan(4), axes[0].one_g_counts, axes[1].one_g_counts, axes[2].one_g_counts);
    block[8] = 0x40;  // Speaker volume.
    PutChecksum(block);
  }
  return memory;
}

}  // namespace

Wiimote::Wiimote(std::uint64_t seed) : axes_(DrawAxes(seed)), controller_(MakeMemory(axes_)) {
  identity_.name = "Nintendo RVL-CNT-01";
  identity_.serial = MakeSerial(seed);
}

std::optional<Report> Wiimote::Sample(const Eigen::Vector3d& specific_force_S_mps2,
                                      std::uint16_t buttons) {
  Readings readings;
  readings.buttons = buttons;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = kRawSigns[i] * specific_force_S_mps2[static_cast<Eigen::Index>(i)];
    const double g = std::isfinite(force) ? force / kStandardGravityMps2 : 0;
    const double counts = axes_[i].zero_counts + g * (axes_[i].one_g_counts - axes_[i].zero_counts);
    // y and z are sent with 9 bits: their counts are even.
    const double step = i == 0 ? 1 : 2;
    const double rounded = step * std::round(counts / step);
    readings.acceleration_counts[i] =
        static_cast<std::uint16_t>(std::clamp(rounded, 0.0, i == 0 ? 1023.0 : 1022.0));
  }
  readings.extension.fill(0xff);
  return controller_.DataReport(readings);
}

}  // namespace footing::device_models
