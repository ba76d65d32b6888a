// Eight devices for an hour on the injected clock: what is held in memory does not grow.
#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/sensor/service/long_run.h"

extern "C" std::size_t __sanitizer_get_current_allocated_bytes() __attribute__((weak));

namespace footing::sensor {
namespace {

std::size_t AllocatedBytes() {
  if (__sanitizer_get_current_allocated_bytes != nullptr) {
    return __sanitizer_get_current_allocated_bytes();
  }
  return mallinfo2().uordblks;
}

TEST(EightDevicesForAnHour, DoNotGrow) {
  LongRun run(LinkQuality::kIdeal);
  for (std::uint64_t i = 1; i <= 6; ++i) {
    run.Add(PortModel(i % 2 == 0 ? PortModel::Child::kNunchuk : PortModel::Child::kNone, i % 3 == 0,
                      i));
  }
  run.Add(BalanceBoard(7));
  run.Add(BalanceBoard(8));
  std::uint64_t samples = 0;
  const auto count = [&samples](const TickContent& content) {
    samples += content.motion.size() + content.boards.size();
  };
  run.Advance(120, count);  // The rings of 60 s are full.
  const std::size_t before = AllocatedBytes();
  run.Advance(3480, count);
  const std::size_t after = AllocatedBytes();
  ASSERT_GT(before, 0u);
  RecordProperty("allocated_bytes_after_2_min", static_cast<int>(before));
  RecordProperty("allocated_bytes_after_60_min", static_cast<int>(after));
  EXPECT_LE(after, before + 200'000);  // Less than 1 byte in ten reports.
  // 6 Wiimotes with 100 a second and 2 boards with 60, less the handshakes.
  EXPECT_GT(samples, 0.999 * 3600 * (6 * 100 + 2 * 60));
}

}  // namespace
}  // namespace footing::sensor
