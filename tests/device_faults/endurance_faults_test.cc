#include "common/stream/sensor.h"
#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

#ifdef FOOTING_SANITIZED
// Freed memory stays in AddressSanitizer's quarantine, so its size says nothing there; a leak shows
// at footingd's end instead, and does so after any number of seconds.
constexpr bool kMemoryCounts = false;
constexpr int kSeconds = 15;
#else
constexpr bool kMemoryCounts = true;
constexpr int kSeconds = 55;
#endif

FOOTING_FAULT(Fault64EightDevicesForAMinute) {
  constexpr std::size_t kWiimotes = 6, kBoards = 2;
  std::vector<Device*> devices;
  for (std::size_t i = 0; i < kWiimotes; ++i) {
    devices.push_back(&bench.Plug(std::make_shared<WiimoteModel>(640 + i)));
  }
  for (std::size_t i = 0; i < kBoards; ++i) {
    devices.push_back(&bench.Plug(std::make_shared<BoardModel>(646 + i)));
  }
  ASSERT_TRUE(bench.Start());
  for (Device* device : devices) ASSERT_TRUE(bench.UntilLive(*device));
  bench.Run(5);  // The ring of ticks is full by then.
  const std::int64_t before = bench.MemoryBytes();
  const std::size_t descriptors = bench.Descriptors();
  const std::int64_t from_ns = clock::MonotonicNs();
  std::vector<std::uint64_t> reports;
  for (Device* device : devices) reports.push_back(Status(*device).reports());
  std::vector<std::size_t> samples(devices.size());
  bench.seen().Forget();
  for (int second = 0; second < kSeconds; ++second) {
    bench.Run(1);
    for (std::size_t i = 0; i < devices.size(); ++i) samples[i] += bench.Samples(*devices[i]);
    bench.seen().Forget();
  }
  const double seconds = static_cast<double>(clock::MonotonicNs() - from_ns) * 1e-9;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& status = Status(*devices[i]);
    EXPECT_EQ(status.state(), v1::DEVICE_STATE_LIVE);
    EXPECT_NEAR(static_cast<double>(status.reports() - reports[i]) / seconds, 100, 2);
    EXPECT_NEAR(static_cast<double>(samples[i]) / seconds, 100, 2);
    EXPECT_EQ(status.queue_drops(), 0u);
  }
  EXPECT_TRUE(bench.gaps().empty());
  // Looking for devices opens some for a moment.
  EXPECT_TRUE(bench.Until([&] { return bench.Descriptors() <= descriptors; }));
  // Each device keeps the newest 60 s of its samples, at 100 a second, and that is all that grows,
  // with what its queue's blocks of 512 bytes leave free: 5 MiB more would be 119 bytes a report.
  const std::size_t history = kWiimotes * sizeof(stream::MotionSample) +  //
                              kBoards * sizeof(stream::BoardSample);
  const auto grown = bench.MemoryBytes() - before;
  RecordProperty("grown_bytes", std::to_string(grown));
  if (kMemoryCounts) {
    EXPECT_LT(grown, static_cast<std::int64_t>(history * 100 * kSeconds) + (5 << 20));
  }
}

}  // namespace
}  // namespace footing::device_faults
