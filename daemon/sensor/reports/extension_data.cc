#include <algorithm>

#include "daemon/sensor/reports/extension.h"

/// The six bytes of Nunchuk, Classic and MotionPlus (WiiBrew's pages "Wiimote/Extension
/// Controllers").
namespace footing::reports {
namespace {

bool AllAre(Bytes bytes, std::uint8_t value) {
  return std::all_of(bytes.begin(), bytes.end(), [value](std::uint8_t b) { return b == value; });
}

/// The six bytes of an extension that answers, or none.
Bytes Answered(Bytes extension) {
  if (extension.size() < kExtensionDataBytes) return {};
  const Bytes bytes = extension.first(kExtensionDataBytes);
  return AllAre(bytes, 0xff) ? Bytes() : bytes;
}

std::uint16_t WithLow(int high, int low) { return static_cast<std::uint16_t>(high << 2 | low); }

std::uint8_t Small(int value) { return static_cast<std::uint8_t>(value); }

}  // namespace

std::optional<NunchukCounts> DecodeNunchuk(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  const int low = b[5];
  NunchukCounts counts;
  counts.stick_x = b[0];
  counts.stick_y = b[1];
  counts.acceleration = {WithLow(b[2], low >> 2 & 3), WithLow(b[3], low >> 4 & 3),
                         WithLow(b[4], low >> 6 & 3)};
  counts.c = (low & 0x02) == 0;
  counts.z = (low & 0x01) == 0;
  return counts;
}

std::optional<NunchukCounts> DecodePassedNunchuk(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  const int low = b[5];
  NunchukCounts counts;
  counts.stick_x = b[0];
  counts.stick_y = b[1];
  // Byte 4 has bits 9 to 3 of z above the flag of the port.
  counts.acceleration = {WithLow(b[2], (low >> 4 & 1) << 1), WithLow(b[3], (low >> 5 & 1) << 1),
                         static_cast<std::uint16_t>((b[4] & 0xfe) << 2 | (low >> 6 & 3) << 1)};
  counts.c = (low & 0x08) == 0;
  counts.z = (low & 0x04) == 0;
  return counts;
}

std::optional<ClassicCounts> DecodeClassic(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  ClassicCounts counts;
  counts.left_x = Small(b[0] & 0x3f);
  counts.left_y = Small(b[1] & 0x3f);
  counts.right_x = Small((b[0] >> 6) << 3 | (b[1] >> 6) << 1 | b[2] >> 7);
  counts.right_y = Small(b[2] & 0x1f);
  counts.left_trigger = Small((b[2] >> 5 & 3) << 3 | b[3] >> 5);
  counts.right_trigger = Small(b[3] & 0x1f);
  // 0 is pressed; bit 0 of byte 4 is unused.
  counts.buttons = static_cast<std::uint16_t>((~b[4] & 0xfe) << 8 | (~b[5] & 0xff));
  return counts;
}

std::optional<ClassicCounts> DecodePassedClassic(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty()) return std::nullopt;
  // Up and left move to where the left stick's lowest bits are otherwise.
  const std::array<std::uint8_t, kExtensionDataBytes> usual = {
      Small(b[0] & 0xfe),
      Small(b[1] & 0xfe),
      b[2],
      b[3],
      b[4],
      Small((b[5] & 0xfc) | (b[1] & 1) << 1 | (b[0] & 1))};
  return DecodeClassic(usual);
}

PassedPacket PacketOf(Bytes extension) {
  const Bytes b = Answered(extension);
  if (b.empty() || AllAre(b, 0x00) || (b[5] & 0x01) != 0) return PassedPacket::kRubbish;
  return (b[5] & 0x02) != 0 ? PassedPacket::kMotionPlus : PassedPacket::kExtension;
}

std::optional<MotionPlusCounts> DecodeMotionPlus(Bytes extension) {
  if (PacketOf(extension) != PassedPacket::kMotionPlus) return std::nullopt;
  MotionPlusCounts counts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts.counts[axis] =
        static_cast<std::uint16_t>((extension[3 + axis] & 0xfc) << 6 | extension[axis]);
  }
  counts.slow[kYaw] = extension[3] & 0x02;
  counts.slow[kPitch] = extension[3] & 0x01;
  counts.slow[kRoll] = extension[4] & 0x02;
  counts.extension_connected = extension[4] & 0x01;
  return counts;
}

std::optional<bool> ChildConnected(Bytes extension) {
  if (PacketOf(extension) == PassedPacket::kRubbish) return std::nullopt;
  return (extension[4] & 0x01) != 0;
}

}  // namespace footing::reports
