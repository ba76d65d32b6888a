#include "common/virtual/devices/extensions.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {
namespace {

constexpr std::size_t kPageBytes = 256;
constexpr std::size_t kBlockAt = 0x20;
constexpr std::size_t kIdentityAt = 0xfa;

std::vector<std::uint8_t> Page(std::span<const std::uint8_t> block, const ExtensionBytes& id) {
  std::vector<std::uint8_t> page(kPageBytes, 0);
  std::copy(block.begin(), block.end(), page.begin() + kBlockAt);
  std::copy(id.begin(), id.end(), page.begin() + kIdentityAt);
  return page;
}

/// Ten bits: the upper eight in one byte, two in the shared one; x at bit 4, y at 2, z at 0.
int TenBits(const NunchukBlock& block, std::size_t at, std::size_t axis) {
  return block[at + axis] << 2 | (block[at + 3] >> (4 - 2 * axis) & 3);
}

std::uint8_t StickByte(double deflection, int highest, int lowest, int middle) {
  const double share = std::clamp(FiniteOrZero(deflection), -1.0, 1.0);
  const double way = share < 0 ? middle - lowest : highest - middle;
  return static_cast<std::uint8_t>(std::clamp(std::round(middle + share * way), 0.0, 255.0));
}

int Word(const MotionPlusBlock& block, std::size_t at) { return block[at] << 8 | block[at + 1]; }

void PutWord(MotionPlusBlock& block, std::size_t at, int value) {
  block[at] = static_cast<std::uint8_t>(value >> 8);
  block[at + 1] = static_cast<std::uint8_t>(value);
}

/// Counts of 14 bits, not yet bounded; `half` 0 is the fast range, 16 the slow one.
double GyroscopeCounts(const MotionPlusBlock& block, std::size_t half, std::size_t axis,
                       double degrees_per_s) {
  const int zero = Word(block, half + 2 * axis);
  const int scale = Word(block, half + 6 + 2 * axis);
  const double range_degrees_per_s = 6.0 * block[half + 12];
  if (range_degrees_per_s == 0) return zero / 4.0;
  return (zero + degrees_per_s / range_degrees_per_s * (scale - zero)) / 4;
}

}  // namespace

NunchukBlock DrawNunchukBlock(std::uint64_t seed) {
  // One real unit: zero 500 to 504, 1 g 204 counts above, stick 33 to 231 with 124 in the middle.
  noise::Random random(seed);
  NunchukBlock block{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int zero = random.Integer(490, 520);
    const int one_g = zero + random.Integer(196, 210);
    const std::size_t shift = 4 - 2 * axis;
    block[axis] = static_cast<std::uint8_t>(zero >> 2);
    block[3] = static_cast<std::uint8_t>(block[3] | (zero & 3) << shift);
    block[4 + axis] = static_cast<std::uint8_t>(one_g >> 2);
    block[7] = static_cast<std::uint8_t>(block[7] | (one_g & 3) << shift);
  }
  for (const std::size_t at : {8u, 11u}) {
    block[at] = static_cast<std::uint8_t>(random.Integer(220, 232));
    block[at + 1] = static_cast<std::uint8_t>(random.Integer(28, 38));
    block[at + 2] = static_cast<std::uint8_t>(random.Integer(122, 134));
  }
  std::uint8_t sum = 0x55;
  for (std::size_t i = 0; i < 14; ++i) sum = static_cast<std::uint8_t>(sum + block[i]);
  block[14] = sum;
  block[15] = static_cast<std::uint8_t>(sum + 0x55);
  return block;
}

MotionPlusBlock DrawMotionPlusBlock(std::uint64_t seed) {
  // Two real units: zero 30200 to 32200; the scale 17000 to 22000 off it, below it for yaw and
  // pitch, at 1200 and at 270 degrees a second.
  noise::Random random(seed);
  MotionPlusBlock block{};
  for (const std::size_t half : {0u, 16u}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int zero = random.Integer(30200, 32200);
      const int span = half == 0 ? random.Integer(17500, 21500) : random.Integer(12500, 18000);
      PutWord(block, half + 2 * axis, zero);
      PutWord(block, half + 6 + 2 * axis, axis == 1 ? zero + span : zero - span);
    }
    block[half + 12] = half == 0 ? 0xc8 : 0x2d;
    block[half + 13] = static_cast<std::uint8_t>(random.Integer(0, 255));
  }
  PutMotionPlusChecksum(block);
  return block;
}

void PutMotionPlusChecksum(MotionPlusBlock& block) {
  uLong crc = crc32(0, block.data(), 14);
  crc = crc32(crc, block.data() + 16, 14);
  PutWord(block, 14, static_cast<int>(crc >> 16 & 0xffff));
  PutWord(block, 30, static_cast<int>(crc & 0xffff));
}

std::vector<std::uint8_t> NunchukPage(const NunchukBlock& block) {
  std::vector<std::uint8_t> page = Page(block, {0x00, 0x00, 0xa4, 0x20, 0x00, 0x00});
  std::copy(block.begin(), block.end(), page.begin() + kBlockAt + 16);  // The copy.
  return page;
}

std::vector<std::uint8_t> ClassicPage() { return Page({}, {0x00, 0x00, 0xa4, 0x20, 0x01, 0x01}); }

std::vector<std::uint8_t> UnknownPage() { return Page({}, {0x00, 0x00, 0xa4, 0x20, 0x13, 0x37}); }

std::vector<std::uint8_t> MotionPlusPage(const MotionPlusBlock& block, bool inside) {
  return Page(block, {static_cast<std::uint8_t>(inside ? 1 : 0), 0x00, 0xa6, 0x20, 0x00, 0x05});
}

ExtensionBytes NunchukBytes(const NunchukBlock& block, const NunchukSensors& sensors) {
  constexpr std::array<double, 3> kRawSigns = {+1, -1, -1};  // Raw: left, rear, up.
  ExtensionBytes out{};
  out[0] = StickByte(sensors.stick_x, block[8], block[9], block[10]);
  out[1] = StickByte(sensors.stick_y, block[11], block[12], block[13]);
  out[5] = static_cast<std::uint8_t>((sensors.c ? 0 : 2) | (sensors.z ? 0 : 1));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double force =
        kRawSigns[axis] *
        FiniteOrZero(sensors.specific_force_S_mps2[static_cast<Eigen::Index>(axis)]);
    const int zero = TenBits(block, 0, axis);
    const int one_g = TenBits(block, 4, axis);
    const int counts = static_cast<int>(
        std::clamp(std::round(zero + force / kStandardGravityMps2 * (one_g - zero)), 0.0, 1023.0));
    out[2 + axis] = static_cast<std::uint8_t>(counts >> 2);
    out[5] = static_cast<std::uint8_t>(out[5] | (counts & 3) << (2 + 2 * axis));
  }
  return out;
}

ExtensionBytes ClassicBytes(const GamepadSensors& sensors) {
  const auto stick = [](double value, int middle) {
    return static_cast<int>(
        std::clamp(std::round(middle + FiniteOrZero(value) * (middle - 1)), 0.0, 2.0 * middle - 1));
  };
  const auto trigger = [](double value) {
    return static_cast<int>(std::clamp(std::round(31 * FiniteOrZero(value)), 0.0, 31.0));
  };
  const int left_x = stick(sensors.left_x, 32), left_y = stick(sensors.left_y, 32);
  const int right_x = stick(sensors.right_x, 16), right_y = stick(sensors.right_y, 16);
  const int left = trigger(sensors.left_trigger), right = trigger(sensors.right_trigger);
  // Buttons are 0 when pressed; bit 0 of byte 4 is always 1.
  const int released = ~static_cast<int>(sensors.buttons);
  return {static_cast<std::uint8_t>((right_x >> 3) << 6 | left_x),
          static_cast<std::uint8_t>((right_x >> 1 & 3) << 6 | left_y),
          static_cast<std::uint8_t>((right_x & 1) << 7 | (left >> 3) << 5 | right_y),
          static_cast<std::uint8_t>((left & 7) << 5 | right),
          static_cast<std::uint8_t>((released >> 8 & 0xff) | 1),
          static_cast<std::uint8_t>(released & 0xff)};
}

ExtensionBytes PassedNunchuk(const ExtensionBytes& plain) {
  ExtensionBytes out = plain;
  const int x = plain[5] >> 2, y = plain[5] >> 4, z = plain[5] >> 6;
  out[4] = static_cast<std::uint8_t>((plain[4] & 0xfe) | 1);
  // z is left with nine bits, x and y too: of the two low bits of each the upper one is sent.
  const int z_low = (plain[4] & 1) << 1 | (z >> 1 & 1);
  out[5] = static_cast<std::uint8_t>(z_low << 6 | (y >> 1 & 1) << 5 | (x >> 1 & 1) << 4 |
                                     (plain[5] >> 1 & 1) << 3 | (plain[5] & 1) << 2);
  return out;
}

ExtensionBytes PassedClassic(const ExtensionBytes& plain) {
  // Up and left of the cross move to the lowest bits of the left stick.
  ExtensionBytes out = plain;
  out[0] = static_cast<std::uint8_t>((plain[0] & 0xfe) | (plain[5] & 1));
  out[1] = static_cast<std::uint8_t>((plain[1] & 0xfe) | (plain[5] >> 1 & 1));
  out[4] = static_cast<std::uint8_t>(plain[4] | 1);
  out[5] = plain[5] & 0xfc;
  return out;
}

ExtensionBytes MotionPlusBytes(const MotionPlusBlock& block,
                               const Eigen::Vector3d& angular_velocity_S_radps,
                               bool extension_connected) {
  // Real units leave the slow range near 15.8k of 16.4k counts.
  constexpr double kSlowLow = 600, kSlowHigh = 15'800, kTop = 16'383;
  const double turn_radps[] = {angular_velocity_S_radps.z(), -angular_velocity_S_radps.y(),
                               -angular_velocity_S_radps.x()};  // Yaw, roll, pitch.
  int counts[3];
  bool slow[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double degrees_per_s = FiniteOrZero(turn_radps[axis]) * 180 / kPi;
    double value = GyroscopeCounts(block, 16, axis, degrees_per_s);
    slow[axis] = value >= kSlowLow && value <= kSlowHigh;
    if (!slow[axis]) value = GyroscopeCounts(block, 0, axis, degrees_per_s);
    counts[axis] = static_cast<int>(std::clamp(std::round(value), 0.0, kTop));
  }
  ExtensionBytes out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = static_cast<std::uint8_t>(counts[axis]);
    out[3 + axis] = static_cast<std::uint8_t>(counts[axis] >> 8 << 2);
  }
  out[3] = static_cast<std::uint8_t>(out[3] | (slow[0] ? 2 : 0) | (slow[2] ? 1 : 0));
  out[4] = static_cast<std::uint8_t>(out[4] | (slow[1] ? 2 : 0) | (extension_connected ? 1 : 0));
  out[5] = static_cast<std::uint8_t>(out[5] | 2);
  return out;
}

}  // namespace footing::virtual_devices
