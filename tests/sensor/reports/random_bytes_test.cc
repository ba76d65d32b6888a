#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/memory_read.h"

namespace footing::reports {
namespace {

TEST(RandomBytes, DecodeToSomethingWithinItsBounds) {
  std::mt19937 random(1);
  MemoryRead read(Space::kEeprom, 0, 0x1700);
  int decoded_count = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::vector<std::uint8_t> bytes(random() % 40);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    // Most ids are unknown; half of the reports get a known range.
    if (!bytes.empty() && i % 2 == 0) bytes[0] = static_cast<std::uint8_t>(0x20 + random() % 32);
    const InputReport decoded = Decode(bytes);
    ASSERT_EQ(decoded.buttons & ~0x1f9f, 0);
    if (!std::holds_alternative<Undecodable>(decoded.body)) ++decoded_count;
    if (const auto* data = std::get_if<Data>(&decoded.body)) {
      for (const std::uint16_t count : data->acceleration_counts) ASSERT_LE(count, 1023);
      ASSERT_LE(data->extension_size, 21);
      DecodeBoard(data->extension());
    }
    if (const auto* memory = std::get_if<MemoryData>(&decoded.body)) {
      ASSERT_LE(memory->size, 16);
      read.Take(*memory);
      ASSERT_LE(read.bytes().size(), 0x1700u);
    }
    IdentifyExtension(bytes);
  }
  EXPECT_GT(decoded_count, 1000);
}

}  // namespace
}  // namespace footing::reports
