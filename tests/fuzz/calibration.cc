#include <cmath>
#include <initializer_list>
#include <vector>

#include "daemon/sensor/reports/board_calibration.h"
#include "daemon/sensor/reports/wiimote_calibration.h"
#include "tests/fuzz/input.h"

/// A memory block and a packet: every block is parsed, and with what came of it the packet is
/// calibrated; nothing may be NaN or infinite. Blocks with right checksums are rare among random
/// bytes, so each block is tried again with its checksum made right.
namespace footing::fuzz {
namespace {

using Block = std::vector<std::uint8_t>;

Block Padded(Bytes bytes, std::size_t size) {
  Block block(bytes.begin(), bytes.end());
  block.resize(size);
  return block;
}

void CheckAcceleration(Bytes block, const std::array<std::uint16_t, 3>& counts) {
  const auto calibration = calibration::ParseAcceleration(block);
  Expect(calibration::Calibrate(calibration, counts).specific_force_S_mps2.allFinite());
  Block right = Padded(block, calibration::kAccelerationBlockBytes);
  right.back() = calibration::SumChecksum(Bytes(right).first(right.size() - 1));
  const auto forced = calibration::ParseAcceleration(right);
  Expect(calibration::Calibrate(forced, counts).specific_force_S_mps2.allFinite());
}

void CheckNunchuk(Bytes block, const reports::NunchukCounts& counts) {
  Block right = Padded(block, calibration::kNunchukBlockBytes);
  right[14] = calibration::SumChecksum(Bytes(right).first(14));
  right[15] = static_cast<std::uint8_t>(right[14] + 0x55);
  for (const Bytes tried : {block, Bytes(right)}) {
    const auto reading = calibration::Calibrate(calibration::ParseNunchuk(tried), counts);
    Expect(reading.specific_force_S_mps2.allFinite());
    Expect(std::abs(reading.stick_x) <= 1 && std::abs(reading.stick_y) <= 1);
  }
}

void CheckMotionPlus(Bytes block, const reports::MotionPlusCounts& counts) {
  Block right = Padded(block, calibration::kMotionPlusBlockBytes);
  const std::uint32_t crc =
      calibration::Crc32({Bytes(right).first(14), Bytes(right).subspan(16, 14)});
  right[14] = static_cast<std::uint8_t>(crc >> 24);
  right[15] = static_cast<std::uint8_t>(crc >> 16);
  right[30] = static_cast<std::uint8_t>(crc >> 8);
  right[31] = static_cast<std::uint8_t>(crc);
  for (const Bytes tried : {block, Bytes(right)}) {
    const auto reading = calibration::Calibrate(calibration::ParseMotionPlus(tried), counts);
    Expect(reading.angular_velocity_S_radps.allFinite());
  }
}

void CheckBoard(Bytes block, Bytes temperature, const reports::BoardCounts& counts) {
  Block right = Padded(block, calibration::kBoardBlockBytes);
  const Block reference = Padded(temperature, calibration::kBoardTemperatureBytes);
  const std::uint32_t crc =
      calibration::Crc32({Bytes(right).subspan(4, 24), Bytes(right).first(2), Bytes(reference)});
  for (std::size_t i = 0; i < 4; ++i) {
    right[28 + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
  for (const Bytes tried : {block, Bytes(right)}) {
    const auto calibration = calibration::ParseBoard(tried, reference);
    for (const double force : calibration::CornerForces(calibration, counts)) {
      Expect(std::isfinite(force));
    }
  }
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  fuzz::Input input(bytes, size);
  const fuzz::Bytes block = input.String();
  const fuzz::Bytes temperature = input.String();
  const fuzz::Bytes packet = input.Rest();
  std::array<std::uint16_t, 3> counts{};
  for (std::size_t i = 0; i < 3 && 2 * i + 1 < packet.size(); ++i) {
    counts[i] = (packet[2 * i] << 8 | packet[2 * i + 1]) & 0x3ff;
  }
  fuzz::CheckAcceleration(block, counts);
  if (const auto nunchuk = reports::DecodeNunchuk(packet)) fuzz::CheckNunchuk(block, *nunchuk);
  if (const auto motion_plus = reports::DecodeMotionPlus(packet)) {
    fuzz::CheckMotionPlus(block, *motion_plus);
  }
  if (const auto board = reports::DecodeBoard(packet)) {
    fuzz::CheckBoard(block, temperature, *board);
  }
  calibration::GyroscopeBias bias;
  std::int64_t now_ns = 0;
  for (std::size_t at = 0; at + 6 <= packet.size(); at += 6) {
    const auto motion_plus = reports::DecodeMotionPlus(packet.subspan(at, 6));
    if (!motion_plus) continue;
    now_ns += std::int64_t{packet[at]} * 1'000'000;
    const auto reading = calibration::Calibrate({}, *motion_plus);
    bias.Take(now_ns, Eigen::Vector3d(0, 0, -9.8), reading.angular_velocity_S_radps);
    fuzz::Expect(bias.bias_radps().allFinite());
  }
  return 0;
}
