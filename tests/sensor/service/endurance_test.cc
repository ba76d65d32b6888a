// Long runs on the injected clock: a poor link for ten minutes, eight devices for an hour, a
// suspension of an hour.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <map>
#include <variant>

#include "common/device_models/balance_board.h"
#include "common/device_models/link_model.h"
#include "common/units/units.h"
#include "daemon/sensor/service/hub.h"
#include "tests/sensor/handshake/port_model.h"

extern "C" std::size_t __sanitizer_get_current_allocated_bytes() __attribute__((weak));

namespace footing::sensor {
namespace {

using device_models::BalanceBoard;
using device_models::LinkModel;
using device_models::LinkQuality;
using device_models::Report;
using handshake::PortModel;

constexpr std::int64_t kTickNs = 10'000'000;

std::size_t AllocatedBytes() {
  if (__sanitizer_get_current_allocated_bytes != nullptr) {
    return __sanitizer_get_current_allocated_bytes();
  }
  return mallinfo2().uordblks;
}

/// A hub, devices behind a link model, and a clock that runs faster than time.
class LongRun {
 public:
  explicit LongRun(LinkQuality quality) : quality_(quality) {}

  void Add(std::variant<PortModel, BalanceBoard> model) {
    const bool board = std::holds_alternative<BalanceBoard>(model);
    const auto seed = static_cast<std::uint64_t>(devices_.size() + 1);
    const LinkModel link(board ? device_models::BoardLink(quality_, seed)
                               : device_models::WiimoteLink(quality_, seed),
                         now_ns_);
    const auto& own = std::visit(
        [](const auto& one) -> const auto& { return one.identity(); }, model);
    devices::DeviceIdentity identity;
    identity.name = own.name;
    identity.serial = own.serial;
    const devices::DeviceHandle handle = devices_.size() + 1;
    auto& device = devices_.emplace(handle, Simulated{std::move(model), link, {}, {}}).first->second;
    device.next = device.link.Next();
    hub_.OnAttach(handle, identity);
  }

  /// Runs ticks; each one's content goes to `on_tick`.
  template <typename OnTick>
  void Advance(double seconds, OnTick on_tick) {
    const auto end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9);
    while (now_ns_ < end_ns) {
      const std::int64_t tick_ns = now_ns_ + kTickNs;
      for (auto& [handle, device] : devices_) {
        Deliver(handle, std::exchange(device.answers, {}));
        while (device.next.arrives_ns <= tick_ns) {
          now_ns_ = std::max(now_ns_, device.next.arrives_ns);
          if (const auto report = Sample(device)) {
            hub_.OnReport(handle, {device.next.arrives_ns, *report, 0});
          }
          device.next = device.link.Next();
        }
        now_ns_ = tick_ns - kTickNs;
      }
      now_ns_ = tick_ns;
      on_tick(hub_.Tick(now_ns_));
    }
  }
  void Jump(double seconds) {
    const auto jump_ns = static_cast<std::int64_t>(seconds * 1e9);
    now_ns_ += jump_ns;
    for (auto& [handle, device] : devices_) {
      while (device.next.arrives_ns < now_ns_) device.next = device.link.Next();
    }
  }

  std::int64_t now_ns() const { return now_ns_; }
  /// Hands swing with 1.5 Hz and 6 m/s² until then.
  double moves_until_s = 1e9;

 private:
  struct Simulated {
    std::variant<PortModel, BalanceBoard> model;
    LinkModel link;
    LinkModel::Arrival next;
    std::vector<Report> answers;
  };

  void Deliver(devices::DeviceHandle handle, const std::vector<Report>& reports) {
    for (const Report& report : reports) hub_.OnReport(handle, {now_ns_, report, 0});
  }

  std::optional<Report> Sample(Simulated& device) {
    const double t_s = static_cast<double>(device.next.sampled_ns) * 1e-9;
    const double swing = t_s < moves_until_s ? 6 * std::sin(2 * kPi * 1.5 * t_s) : 0;
    if (auto* wiimote = std::get_if<PortModel>(&device.model)) {
      return wiimote->Sample({0, swing, -kStandardGravityMps2});
    }
    return std::get<BalanceBoard>(device.model)
        .Sample({150 + swing, 150 + 0.5 * swing, 150 - swing, 150 - 0.5 * swing});
  }

  void Answer(devices::DeviceHandle handle, const reports::OutputReport& report) {
    Simulated& device = devices_.at(handle);
    auto answers =
        std::visit([&report](auto& one) { return one.HandleOutput(report); }, device.model);
    device.answers.insert(device.answers.end(), answers.begin(), answers.end());
  }

  LinkQuality quality_;
  std::int64_t now_ns_ = 1'000'000'000;
  std::map<devices::DeviceHandle, Simulated> devices_;
  Hub hub_{Config(),
           {[this](devices::DeviceHandle handle, const reports::OutputReport& report) {
              Answer(handle, report);
            },
            [](const std::string&) {}, [this] { return now_ns_; }}};
};

PortModel WithNunchuk(std::uint64_t seed) {
  return PortModel(PortModel::Child::kNunchuk, false, seed);
}

/// What must hold of every sample of a device's stream, and the gaps in it.
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
  std::map<std::uint32_t, Stream> streams = {{1, Stream()},
                                             {2, Stream()},
                                             {3, Stream(1 / 83.6)},
                                             {4, Stream(1 / 83.6)}};
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
  EXPECT_GT(gaps, 20u);             // The poor link did its worst ...
  EXPECT_GT(moving_ticks, 60'000u);  // ... and the hands were seen to move: 2 x 540 s.
  EXPECT_EQ(moving_without_news, 0u);
  EXPECT_FALSE(nunchuk_ns.empty());
}

TEST(Fault64EightDevicesForAnHour, DoNotGrow) {
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
