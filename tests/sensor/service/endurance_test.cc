// Long runs on the injected clock: a poor link for ten minutes, a suspension of an hour.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/sensor/service/long_run.h"

namespace footing::sensor {
namespace {

/// Conditions on every sample of a device's stream, and on the gaps in it.
class Stream {
 public:
  explicit Stream(double period_s = 0.01) : period_s_(period_s) {}

  template <typename Sample>
  void Take(const Sample& sample) {
    EXPECT_GE(sample.received_ns, received_ns_);
    EXPECT_GE(sample.sampled_ns, sampled_ns_);
    EXPECT_LE(sample.sampled_ns, sample.received_ns);
    EXPECT_GT(sample.report_count, count_);
    const double interval_s = static_cast<double>(sample.received_ns - received_ns_) * 1e-9;
    if (count_ > 0 && interval_s > 5 * period_s_) ++gaps_;
    received_ns_ = sample.received_ns;
    sampled_ns_ = sample.sampled_ns;
    count_ = sample.report_count;
  }
  std::uint64_t gaps() const { return gaps_; }
  std::uint64_t count() const { return count_; }

 private:
  double period_s_;
  std::int64_t received_ns_ = 0;
  std::int64_t sampled_ns_ = 0;
  std::uint64_t count_ = 0;
  std::uint64_t gaps_ = 0;
};

TEST(PoorLinkForTenMinutes, EveryGapIsToldAndNothingIsReorderedOrNaN) {
  LongRun run(LinkQuality::kPoor);
  run.Add(WithNunchuk(1));
  run.Add(WithNunchuk(2));
  run.Add(BalanceBoard(3));
  run.Add(BalanceBoard(4));
  std::map<std::uint32_t, Stream> streams = {
      {1, Stream()}, {2, Stream()}, {3, Stream(1 / 83.6)}, {4, Stream(1 / 83.6)}};
  std::map<std::uint32_t, std::int64_t> nunchuk_ns;
  std::vector<stream::DeviceStatus> status;
  std::uint64_t moving_ticks = 0;
  std::uint64_t moving_without_news = 0;
  run.moves_until_s = 540;  // The last minute all lies still: nothing but repeats.
  const std::int64_t still_ns = 541'000'000'000 + 3'000'000'000;
  run.Advance(600, [&](const TickContent& content) {
    for (const auto& sample : content.motion) {
      streams.at(sample.device).Take(sample);
      ASSERT_TRUE(sample.specific_force_mps2.allFinite() && sample.filtered_mps2.allFinite());
      ASSERT_TRUE(sample.angular_velocity_radps.allFinite());
    }
    for (const auto& sample : content.boards) {
      streams.at(sample.device).Take(sample);
      ASSERT_TRUE(std::isfinite(sample.total_n) && std::isfinite(sample.cop_x_m) &&
                  std::isfinite(sample.cop_y_m));
    }
    for (const auto& sample : content.nunchuks) {
      ASSERT_TRUE(sample.specific_force_mps2.allFinite() && std::isfinite(sample.stick_x));
      ASSERT_GE(sample.sampled_ns, nunchuk_ns[sample.device]);
      nunchuk_ns[sample.device] = sample.sampled_ns;
    }
    for (const auto& rig : content.features) {
      for (const auto& one : rig.devices) {
        moving_ticks += one.moving ? 1 : 0;
        moving_without_news += one.moving && run.now_ns() > still_ns ? 1 : 0;
        ASSERT_TRUE(std::isfinite(one.frequency_hz) && std::isfinite(one.amplitude_mps2));
      }
    }
    if (content.has_status) status = content.status;
  });
  ASSERT_EQ(status.size(), 4u);
  std::uint64_t gaps = 0;
  for (const auto& one : status) {
    EXPECT_EQ(one.gaps, streams.at(one.device).gaps()) << one.device;
    EXPECT_GT(streams.at(one.device).count(), 20'000u);
    gaps += one.gaps;
  }
  EXPECT_GT(gaps, 20u);              // The poor link did its worst ...
  EXPECT_GT(moving_ticks, 60'000u);  // ... and the hands were seen to move: 2 x 540 s.
  EXPECT_EQ(moving_without_news, 0u);
  EXPECT_FALSE(nunchuk_ns.empty());
}

TEST(AnHourThatPassesUnseen, IsOneGapAndTheDevicesAreLiveAgain) {
  LongRun run(LinkQuality::kIdeal);
  run.Add(WithNunchuk(1));
  run.Add(BalanceBoard(2));
  std::vector<stream::DeviceStatus> status;
  std::map<std::uint32_t, Stream> streams = {{1, Stream()}, {2, Stream(1 / 83.6)}};
  const auto take = [&](const TickContent& content) {
    for (const auto& sample : content.motion) streams.at(sample.device).Take(sample);
    for (const auto& sample : content.boards) streams.at(sample.device).Take(sample);
    if (content.has_status) status = content.status;
  };
  run.Advance(30, take);
  const auto before = status;
  EXPECT_EQ(before[0].note, "");
  EXPECT_EQ(before[1].note.find("one board alone"), 0u);
  run.Jump(3600);
  run.Advance(1, take);
  ASSERT_EQ(status.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(status[i].state, stream::DeviceState::kLive);
    EXPECT_EQ(status[i].gaps, before[i].gaps + 1);
    EXPECT_EQ(status[i].gaps, streams.at(status[i].device).gaps());
    EXPECT_EQ(status[i].note, before[i].note);
  }
  EXPECT_EQ(status[0].extension, stream::Extension::kNunchuk);
}

}  // namespace
}  // namespace footing::sensor
