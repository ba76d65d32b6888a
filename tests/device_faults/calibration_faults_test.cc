#include <zlib.h>

#include <algorithm>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

constexpr std::size_t kFirstBlock = 0x16;
constexpr std::size_t kSecondBlock = 0x20;

void Checksum(std::span<std::uint8_t> block) {
  std::uint8_t sum = 0x55;
  for (const std::uint8_t byte : block.first(9)) sum = static_cast<std::uint8_t>(sum + byte);
  block[9] = sum;
}

/// The board's corners: 0 kg, 17 kg, 34 kg from register 24 on.
void Corners(BoardModel& board, const std::function<void(std::span<std::uint8_t>)>& change) {
  change(board.board.controller().memory().extension().subspan(0x24, 24));
}

/// CRC-32 over the corners, the battery's reference and the temperature's.
void Seal(std::span<std::uint8_t> page) {
  uLong crc = crc32(0, page.data() + 0x24, 24);
  crc = crc32(crc, page.data() + 0x20, 2);
  crc = crc32(crc, page.data() + 0x60, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    page[0x3c + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
}

FOOTING_FAULT(Fault19BlocksOfOnesOrZeros) {
  auto ones = std::make_shared<WiimoteModel>(19);
  auto zeros = std::make_shared<WiimoteModel>(1900);
  auto board = std::make_shared<BoardModel>(1901);
  auto blocks = ones->wiimote.controller().memory().eeprom().subspan(kFirstBlock, 20);
  std::fill(blocks.begin(), blocks.end(), 0xff);
  blocks = zeros->wiimote.controller().memory().eeprom().subspan(kFirstBlock, 20);
  std::fill(blocks.begin(), blocks.end(), 0x00);
  Corners(*board, [](auto bytes) { std::fill(bytes.begin(), bytes.end(), 0x00); });
  Device* devices[] = {&bench.Plug(ones), &bench.Plug(zeros), &bench.Plug(board)};
  ASSERT_TRUE(bench.Start());
  for (Device* device : devices) {
    ASSERT_TRUE(bench.UntilLive(*device));
    ASSERT_TRUE(bench.UntilSamples(*device, 10));
    EXPECT_EQ(Status(*device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
    EXPECT_FALSE(Status(*device).note().empty());
    for (const auto& sample : Motion(*device)) {
      EXPECT_TRUE(sample.uncalibrated());
      EXPECT_NEAR(sample.specific_force_mps2().z(), -9.8, 3);  // Typical values fit roughly.
    }
    for (const auto& sample : Boards(*device)) EXPECT_TRUE(sample.uncalibrated());
  }
}

FOOTING_FAULT(Fault20ChecksumWrongInTheFirstBlock) {
  auto model = std::make_shared<WiimoteModel>(20);
  auto eeprom = model->wiimote.controller().memory().eeprom();
  eeprom[kFirstBlock] = static_cast<std::uint8_t>(eeprom[kFirstBlock] + 9);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE_COPY);
  ExpectAllAtRest(device, 20);
  for (const auto& sample : Motion(device)) EXPECT_FALSE(sample.uncalibrated());
}

FOOTING_FAULT(Fault21OneGEqualToZeroG) {
  auto model = std::make_shared<WiimoteModel>(21);
  auto eeprom = model->wiimote.controller().memory().eeprom();
  for (const std::size_t at : {kFirstBlock, kSecondBlock}) {
    auto block = eeprom.subspan(at, 10);
    std::copy_n(block.begin(), 4, block.begin() + 4);
    Checksum(block);  // Right, and senseless all the same.
  }
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
  for (const auto& sample : Motion(device)) {
    EXPECT_TRUE(sample.uncalibrated());
    EXPECT_NEAR(sample.specific_force_mps2().z(), -9.8, 3);
  }
}

FOOTING_FAULT(Fault22BoardPointsThatDoNotRise) {
  std::vector<Device*> devices;
  for (int kind = 0; kind < 3; ++kind) {
    auto board = std::make_shared<BoardModel>(22 + 100 * kind);
    Corners(*board, [kind](auto bytes) {
      if (kind == 0) std::copy_n(bytes.begin(), 8, bytes.begin() + 8);  // 17 kg is 0 kg.
      if (kind == 1) std::swap_ranges(bytes.begin(), bytes.begin() + 8, bytes.begin() + 16);
      if (kind == 2) std::copy_n(bytes.begin() + 8, 8, bytes.begin() + 16);  // 34 kg is 17 kg.
    });
    // The checksum is right in all of them.
    auto page = board->board.controller().memory().extension();
    Seal(page);
    devices.push_back(&bench.Plug(board));
  }
  ASSERT_TRUE(bench.Start());
  for (Device* device : devices) {
    ASSERT_TRUE(bench.UntilLive(*device));
    ASSERT_TRUE(bench.UntilSamples(*device, 10));
    EXPECT_EQ(Status(*device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
    EXPECT_FALSE(Status(*device).note().empty());
    for (const auto& sample : Boards(*device)) EXPECT_TRUE(sample.uncalibrated());
  }
}

FOOTING_FAULT(Fault23ReferenceTemperatureZeroOrFF) {
  std::vector<Device*> devices;
  for (const std::uint8_t reference : {0x00, 0xff}) {
    auto board = std::make_shared<BoardModel>(23 + reference);
    auto page = board->board.controller().memory().extension();
    page[0x60] = reference;
    Seal(page);
    devices.push_back(&bench.Plug(board));
  }
  ASSERT_TRUE(bench.Start());
  for (Device* device : devices) {
    ASSERT_TRUE(bench.UntilLive(*device));
    ASSERT_TRUE(bench.UntilSamples(*device, 10));
    // 0xff against 0x19 would be 16 % of every force.
    for (const auto& sample : Boards(*device)) EXPECT_NEAR(sample.total_n(), 660, 10);
  }
}

/// Its CRC-32 over bytes 0 to 13 and 16 to 29, upper half at 14, lower half at 30.
void Seal(virtual_devices::MotionPlusBlock& block) {
  uLong crc = crc32(0, block.data(), 14);
  crc = crc32(crc, block.data() + 16, 14);
  block[14] = static_cast<std::uint8_t>(crc >> 24);
  block[15] = static_cast<std::uint8_t>(crc >> 16);
  block[30] = static_cast<std::uint8_t>(crc >> 8);
  block[31] = static_cast<std::uint8_t>(crc);
}

FOOTING_FAULT(Fault24MotionPlusBlocksWithoutSense) {
  std::vector<Device*> devices;
  for (int kind = 0; kind < 4; ++kind) {
    auto model = std::make_shared<WiimoteModel>(24 + 100 * kind,
                                                virtual_devices::WiimoteOptions{false, true});
    model->turning = [](std::int64_t) { return Eigen::Vector3d(0, 0, 2); };
    auto block = virtual_devices::DrawMotionPlusBlock(24);
    if (kind == 1) block[3] ^= 0x10;           // One bit of a zero point.
    if (kind == 2) block[12] = block[28] = 0;  // Degrees.
    if (kind == 3) {                           // Scales that equal their zeros.
      std::copy_n(block.begin(), 6, block.begin() + 6);
      std::copy_n(block.begin() + 16, 6, block.begin() + 22);
    }
    if (kind > 1) Seal(block);  // Right, and senseless all the same.
    model->wiimote.controller().memory().SetMotionPlus(
        virtual_devices::MotionPlusPage(block, true));
    devices.push_back(&bench.Plug(model));
  }
  ASSERT_TRUE(bench.Start());
  const auto turns = [this](const Device& device) {
    std::size_t count = 0;
    for (const auto& sample : Motion(device)) count += sample.has_angular_velocity_radps() ? 1 : 0;
    return count;
  };
  for (std::size_t kind = 0; kind < devices.size(); ++kind) {
    Device& device = *devices[kind];
    ASSERT_TRUE(bench.Until([&] { return turns(device) >= 30; })) << kind;
    ASSERT_TRUE(
        bench.Until([&] { return Status(device).extension() == v1::EXTENSION_MOTION_PLUS; }));
    EXPECT_EQ(Status(device).gyroscope_calibration(),
              kind == 0 ? v1::CALIBRATION_ORIGIN_DEVICE : v1::CALIBRATION_ORIGIN_DEFAULTS);
    EXPECT_EQ(Status(device).note().find("MotionPlus") != std::string::npos, kind != 0)
        << Status(device).note();
    for (const auto& sample : Motion(device)) {
      if (!sample.has_angular_velocity_radps()) continue;
      EXPECT_EQ(sample.gyroscope_uncalibrated(), kind != 0);
      EXPECT_NEAR(sample.angular_velocity_radps().z(), 2, 0.8);  // Typical values fit roughly.
    }
    ExpectAllAtRest(device, 30);  // The accelerometer has its own block.
  }
}

}  // namespace
}  // namespace footing::device_faults
