#include "tests/bench/fault.h"

namespace footing::bench {
namespace {

FOOTING_FAULT(Fault01EmptyOneByteAndTruncatedReports) {
  auto model = std::make_shared<WiimoteModel>(1);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  bench.seen().Forget();
  const std::uint64_t undecodable = Status(device).undecodable();
  // Each kind of report cut at each length, with counts that would show if they were read.
  std::size_t short_ones = 0;
  for (const std::uint8_t id : {0x20, 0x21, 0x22, 0x31, 0x33, 0x35, 0x37, 0x3d, 0x3e, 0x3f}) {
    for (std::size_t size = 0; size < 6; ++size) {
      Report report(size, 0x00);
      if (size > 0) report[0] = id;
      if (size > 3) continue;
      device.SendRaw(report);
      short_ones += size > 0 && size < 3 ? 1 : 0;
      if (short_ones % 8 == 0) bench.Run(0.02);
    }
  }
  ASSERT_TRUE(bench.UntilSamples(device, 50));
  ExpectAllAtRest(device, 50);
  EXPECT_TRUE(bench.Until([&] { return Status(device).undecodable() >= undecodable + 10; }))
      << Status(device).undecodable();
  EXPECT_EQ(Status(device).state(), v1::DEVICE_STATE_LIVE);
}

}  // namespace
}  // namespace footing::bench
