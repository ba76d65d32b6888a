// Times of the hub: sampled_ns against the true device clock, and what a lossy link did.
#include <gtest/gtest.h>

#include <map>

#include "tests/sensor/reports/sampled_time_error.h"
#include "tests/sensor/service/long_run.h"

namespace footing::sensor {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

class OnALink : public testing::TestWithParam<LinkQuality> {};
INSTANTIATE_TEST_SUITE_P(Links, OnALink, testing::Values(LinkQuality::kGood, LinkQuality::kPoor));

TEST_P(OnALink, PublishedSampleTimesKeepToTheDevicesTrueClocks) {
  LongRun run(GetParam());
  run.keeps_truth = true;
  run.Add(WithNunchuk(1));
  run.Add(PortModel(PortModel::Child::kNone, false, 2));
  run.Add(BalanceBoard(3));
  std::map<std::uint32_t, link::SampledTimeError> errors;
  run.Advance(120, [&](const TickContent& content) {
    const auto take = [&](const auto& sample) {
      const auto truth = run.true_ns.find({sample.device, sample.received_ns});
      if (run.now_ns() < 10 * kSecondNs || truth == run.true_ns.end()) return;
      errors[sample.device].Add(sample.sampled_ns, truth->second);
    };
    for (const auto& sample : content.motion) take(sample);
    for (const auto& sample : content.boards) take(sample);
    run.true_ns.clear();
  });
  ASSERT_EQ(errors.size(), 3u);
  for (const auto& [device, error] : errors) {
    EXPECT_GT(error.count(), 5000u);
    RecordProperty("rms_us_of_device_" + std::to_string(device),
                   static_cast<int>(1000 * error.rms_ms()));
    RecordProperty("p99_us_of_device_" + std::to_string(device),
                   static_cast<int>(1000 * error.p99_ms()));
    EXPECT_LE(error.rms_ms(), 2) << device;
    EXPECT_LE(error.p99_ms(), 6) << device;
  }
}

TEST(StatusOfALossyLink, TellsRateRepeatsAndEveryGap) {
  LongRun run(LinkQuality::kGood);
  run.Add(PortModel(PortModel::Child::kNone, false, 1));
  run.Add(BalanceBoard(2));
  // From the tenth second on, of every second of the Wiimote's the last 0.3 s; of the board's none.
  run.loses = [](devices::DeviceHandle handle, std::int64_t at_ns) {
    return handle == 1 && at_ns > 10 * kSecondNs && at_ns % kSecondNs >= 700'000'000;
  };
  std::vector<stream::DeviceStatus> status;
  std::map<std::uint32_t, std::uint64_t> samples, repeats;
  run.Advance(60, [&](const TickContent& content) {
    const auto take = [&](const auto& sample) {
      ++samples[sample.device];
      repeats[sample.device] += sample.repeated ? 1 : 0;
    };
    for (const auto& sample : content.motion) take(sample);
    for (const auto& sample : content.boards) take(sample);
    if (content.has_status) status = content.status;
  });
  ASSERT_EQ(status.size(), 2u);
  const stream::DeviceStatus& wiimote = status[0];
  const stream::DeviceStatus& board = status[1];
  // Time runs from 1 s to 61 s: losses end at 11, 12, ... 61 s, the last with no report after it.
  EXPECT_GE(wiimote.gaps, 50u);
  EXPECT_LE(wiimote.gaps, 51u);
  EXPECT_LE(board.gaps,
            1u);  // 5 periods are 60 ms, as long as the longest interval on a good link.
  for (const auto& one : status) {
    // The status is up to 0.2 s older than the newest sample.
    EXPECT_LE(one.reports, samples[one.device]);
    EXPECT_GE(one.reports + 40, samples[one.device]);
    EXPECT_LE(one.repeats, repeats[one.device]);
    EXPECT_GE(one.repeats + 40, repeats[one.device]);
    EXPECT_GT(one.repeats, one.reports / 10);
  }
  // 9 s with 100 a second, then 70 of every 100; the handshake and the
  // link model's own rate (98.5 a second) cost some.
  EXPECT_NEAR(static_cast<double>(wiimote.reports), 9 * 100 + 51 * 70, 0.05 * (9 * 100 + 51 * 70));
  EXPECT_NEAR(static_cast<double>(board.reports), 60 * 83.6, 0.03 * 60 * 83.6);
  EXPECT_NEAR(board.report_rate_hz, 83.6, 15);  // A mean over one second: sd of 7 ms in 84.
  // Quantiles of the table: sd near 7 ms.
  EXPECT_GT(board.jitter_ms, 4);
  EXPECT_LT(board.jitter_ms, 11);
}

}  // namespace
}  // namespace footing::sensor
