#include <algorithm>
#include <array>
#include <utility>

#include "common/base/units.h"
#include "common/virtual/devices/joycon.h"
#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

constexpr std::uint8_t kInfo = 0x02, kRead = 0x10, kSensor = 0x40, kVibration = 0x48;
constexpr std::size_t kTimerAt = 1, kAckAt = 13, kSubcommandAt = 10, kReplyAt = 14,
                      kFirstSampleAt = 13;

class JoyconOnBench : public Model {
 public:
  explicit JoyconOnBench(std::uint64_t seed,
                         virtual_devices::JoyconModel model = virtual_devices::JoyconModel::kLeft)
      : joycon(seed, model), random_(seed) {
    period_s = 0.015;
    sensors.angular_velocity_S_radps = {0, 0, 3};
    sensors.stick_x = 1;
  }
  const virtual_devices::Identity& identity() const override { return joycon.identity(); }
  std::vector<Report> HandleOutput(std::int64_t now_ns,
                                   std::span<const std::uint8_t> report) override {
    return joycon.HandleOutput(now_ns, report);
  }
  std::vector<Report> Sample(std::int64_t now_ns) override {
    virtual_devices::JoyconBurst burst;
    for (auto& one : burst) one = virtual_devices::WithNoise(sensors, random_);
    return joycon.Sample(now_ns, burst);
  }

  virtual_devices::Joycon joycon;
  virtual_devices::JoyconSensors sensors;

 private:
  noise::Random random_;
};

bool Asks(std::span<const std::uint8_t> report, std::uint8_t subcommand) {
  return report.size() > kSubcommandAt && report[0] == 0x01 && report[kSubcommandAt] == subcommand;
}

bool Answers(const Report& report, std::uint8_t subcommand) {
  return report[0] == 0x21 && report[kReplyAt] == subcommand;
}

class JoyconFault : public Fault {
 protected:
  Device& Plug(std::shared_ptr<JoyconOnBench> model) {
    return bench.Plug(std::move(model), {.driver = "nintendo"});
  }
  /// Face up, turning about the vertical with 3 rad/s, samples 5 ms apart.
  void ExpectTrue(const Device& device, std::size_t at_least, double share = 0.01) {
    EXPECT_GE(Motion(device).size(), at_least);
    for (const auto& sample : Motion(device)) {
      ASSERT_NEAR(sample.specific_force_mps2().z(), -9.80665, 0.2) << sample.ShortDebugString();
      ASSERT_TRUE(sample.has_angular_velocity_radps());
      ASSERT_NEAR(sample.angular_velocity_radps().z(), 3, 3 * share) << sample.ShortDebugString();
    }
  }
  void Start(const Device& device) {
    ASSERT_TRUE(bench.Start());
    ASSERT_TRUE(bench.UntilLive(device));
  }
  /// The next second's samples.
  void ASecond(const Device& device) {
    bench.seen().Forget();
    ASSERT_TRUE(bench.UntilSamples(device, 200));
  }
};

#define FOOTING_JOYCON_FAULT(name)    \
  class name : public JoyconFault {}; \
  TEST_F(name, IsSurvived)

FOOTING_JOYCON_FAULT(Fault66JoyconMemoryOfOnes) {
  auto model = std::make_shared<JoyconOnBench>(66);
  model->joycon.memory().clear();
  Device& device = Plug(model);
  Start(device);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
  EXPECT_NE(Status(device).note().find("typical values"), std::string::npos);
  ExpectTrue(device, 200, 0.2);  // The two kinds of gyroscope differ by 15 %.
  for (const auto& sample : Motion(device)) EXPECT_TRUE(sample.gyroscope_uncalibrated());
}

FOOTING_JOYCON_FAULT(Fault67JoyconUserBlockOfZeros) {
  auto model = std::make_shared<JoyconOnBench>(67);
  std::array<std::uint8_t, 26> block{0xb2, 0xa1};
  model->joycon.Write(0x8026, block);
  Device& device = Plug(model);
  Start(device);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE_COPY);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault68JoyconOfSixZerosForEver) {
  auto model = std::make_shared<JoyconOnBench>(68);
  Device& device = Plug(model);
  device.outgoing = [](Report report) {
    if (report[0] == 0x30) std::fill(report.begin() + kFirstSampleAt, report.end(), 0);
    return std::vector<Report>{report};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.Until(
      [&] { return Status(device).note().find("no motion sensor") != std::string::npos; }));
  ASSERT_TRUE(bench.Until([&] { return bench.seen().Nunchuk(device.serial()).size() > 60; }));
  EXPECT_TRUE(Motion(device).empty());
  EXPECT_EQ(bench.seen().Nunchuk(device.serial()).back().stick_x(), 1);
}

FOOTING_JOYCON_FAULT(Fault69JoyconSubcommandsThatGetLost) {
  auto model = std::make_shared<JoyconOnBench>(69);
  Device& device = Plug(model);
  noise::Random random(69);
  int lost = 0;
  // The first of each, and a tenth of the others in either direction.
  std::set<std::uint8_t> seen;
  device.incoming = [&](std::span<const std::uint8_t> report) {
    if (report[0] != 0x01) return false;
    const bool first = seen.insert(report[kSubcommandAt]).second;
    const bool loses = first || random.Uniform() < 0.1;
    lost += loses ? 1 : 0;
    return loses;
  };
  device.outgoing = [&](const Report& report) {
    const bool loses = report[0] == 0x21 && random.Uniform() < 0.1;
    return loses ? std::vector<Report>{} : std::vector<Report>{report};
  };
  Start(device);
  EXPECT_GE(lost, 4);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault70JoyconAttitudeInPlaceOfRates) {
  auto model = std::make_shared<JoyconOnBench>(70);
  Device& device = Plug(model);
  Start(device);
  bench.Run(0.5);
  model->joycon.set_sensor_mode(2);
  bench.Run(0.2);
  bench.seen().Forget();
  device.incoming = [](auto report) { return Asks(report, kSensor); };
  ASSERT_TRUE(bench.UntilSamples(device, 100));
  for (const auto& sample : Motion(device)) ASSERT_FALSE(sample.has_angular_velocity_radps());
  ASSERT_TRUE(bench.Until([&] { return !Status(device).note().empty(); }));
  device.incoming = nullptr;
  ASSERT_TRUE(bench.Until([&] { return model->joycon.sensor_mode() == 1; }));
  ASSERT_TRUE(bench.Until([&] { return Status(device).note().empty(); }));
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault71JoyconSimpleModeSetByAnother) {
  auto model = std::make_shared<JoyconOnBench>(71);
  Device& device = Plug(model);
  Start(device);
  for (int i = 0; i < 3; ++i) {
    bench.Run(0.3);
    model->joycon.set_mode(0x3f);
    EXPECT_TRUE(bench.Within(1, [&] { return model->joycon.mode() == 0x30; }));
  }
  ASSERT_TRUE(bench.Until([&] { return Status(device).mode_reasserts() >= 3; }));
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault72JoyconWithoutAnswerToVibration) {
  auto model = std::make_shared<JoyconOnBench>(72);
  Device& device = Plug(model);
  device.incoming = [](auto report) { return Asks(report, kVibration); };
  Start(device);
  v1::Command command;
  command.mutable_set_rumble()->set_device(Status(device).device());
  command.mutable_set_rumble()->set_on(true);
  command.mutable_set_rumble()->set_lease_ms(2000);
  ASSERT_TRUE(bench.Send(command).ok());
  bench.Run(1.5);
  EXPECT_LE(std::count_if(device.outputs().begin(), device.outputs().end(),
                          [](const auto& one) { return Asks(one.report, kVibration); }),
            5);
  v1::Command lamps;
  lamps.mutable_set_leds()->set_device(Status(device).device());
  lamps.mutable_set_leds()->set_leds(0x9);
  ASSERT_TRUE(bench.Send(lamps).ok());
  EXPECT_TRUE(bench.Until([&] { return model->joycon.leds() == 0x9; }));
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault73JoyconWhoseSensorNeedsAskingTwice) {
  auto model = std::make_shared<JoyconOnBench>(73);
  Device& device = Plug(model);
  int asked = 0;
  // Acknowledged and not done, as a copy does that wakes slowly.
  device.outgoing = [&](const Report& report) {
    if (Answers(report, kSensor) && ++asked == 1) model->joycon.set_sensor_mode(0);
    return std::vector<Report>{report};
  };
  Start(device);
  EXPECT_GE(asked, 2);
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault74JoyconThatCallsItselfAnother) {
  auto model = std::make_shared<JoyconOnBench>(74, virtual_devices::JoyconModel::kRight);
  Device& device = Plug(model);
  device.outgoing = [](Report report) {
    if (Answers(report, kInfo)) report[17] = 3;  // A Pro Controller.
    return std::vector<Report>{report};
  };
  Start(device);
  ASecond(device);
  EXPECT_EQ(Status(device).kind(), v1::DEVICE_KIND_JOY_CON_RIGHT);
  EXPECT_EQ(Status(device).role(), v1::DEVICE_ROLE_RIGHT_HAND);
  ExpectTrue(device, 200);
}

/// Times between consecutive samples, ms.
std::vector<double> StepsMs(const std::vector<v1::MotionSample>& motion) {
  std::vector<double> steps_ms;
  for (std::size_t i = 1; i < motion.size(); ++i) {
    steps_ms.push_back(1e-6 *
                       static_cast<double>(motion[i].sampled_ns() - motion[i - 1].sampled_ns()));
  }
  return steps_ms;
}

/// Share of those that hold.
template <typename Holds>
double Share(const std::vector<double>& steps_ms, const Holds& holds) {
  const auto count = std::count_if(steps_ms.begin(), steps_ms.end(), holds);
  return static_cast<double>(count) /
         static_cast<double>(std::max<std::size_t>(steps_ms.size(), 1));
}

FOOTING_JOYCON_FAULT(Fault75JoyconReportsEveryEightMilliseconds) {
  auto model = std::make_shared<JoyconOnBench>(75);
  model->period_s = 0.008;
  Device& device = Plug(model);
  Start(device);
  bench.Run(2);
  ASecond(device);
  ExpectTrue(device, 200);
  // No two samples share a time, though three samples of 5 ms are more than a report's 8.
  EXPECT_LT(Share(StepsMs(Motion(device)), [](double ms) { return ms < 0.5; }), 0.1);
}

FOOTING_JOYCON_FAULT(Fault76JoyconTimerThatStandsStill) {
  auto model = std::make_shared<JoyconOnBench>(76);
  Device& device = Plug(model);
  device.outgoing = [](Report report) {
    if (report[0] == 0x30) report[kTimerAt] = 17;
    return std::vector<Report>{report};
  };
  Start(device);
  bench.Run(2);
  ASecond(device);
  ExpectTrue(device, 200);
  EXPECT_GT(Share(StepsMs(Motion(device)), [](double ms) { return ms > 3; }), 0.8);
}

FOOTING_JOYCON_FAULT(Fault77JoyconReportsThatGetLost) {
  auto model = std::make_shared<JoyconOnBench>(77);
  Device& device = Plug(model);
  noise::Random random(77);
  Start(device);
  bench.Run(1);
  device.outgoing = [&](const Report& report) {
    const bool loses = report[0] == 0x30 && random.Uniform() < 0.4;
    return loses ? std::vector<Report>{} : std::vector<Report>{report};
  };
  bench.Run(1);
  ASecond(device);
  ExpectTrue(device, 200);
  // Between reports lie 5 ms and the 15 ms of each that was lost, by the device's own clock.
  const auto fits = [](double ms) { return std::abs(std::remainder(ms - 5, 15)) < 2.5; };
  EXPECT_GT(Share(StepsMs(Motion(device)), fits), 0.9);
}

FOOTING_JOYCON_FAULT(Fault78JoyconBurstAfterAStall) {
  auto model = std::make_shared<JoyconOnBench>(78);
  Device& device = Plug(model);
  Start(device);
  std::vector<Report> held;
  for (int i = 0; i < 3; ++i) {
    bench.Run(0.3);
    device.outgoing = [&](const Report& report) {
      held.push_back(report);
      return std::vector<Report>{};
    };
    bench.Run(0.15);
    device.outgoing = nullptr;
    for (const Report& report : std::exchange(held, {})) device.SendRaw(report);
  }
  bench.Run(0.3);
  // In order and never after its arrival: every fault test looks. All 30 samples of a stall have
  // times of their own.
  ExpectTrue(device, 200);
  const auto steps_ms = StepsMs(Motion(device));
  EXPECT_LT(std::count_if(steps_ms.begin(), steps_ms.end(), [](double ms) { return ms < 0.5; }),
            20);
  EXPECT_EQ(Status(device).queue_drops(), 0u);
  EXPECT_EQ(Status(device).mode_reasserts(), 0u);
}

FOOTING_JOYCON_FAULT(Fault79JoyconReportsCutShort) {
  auto model = std::make_shared<JoyconOnBench>(79);
  Device& device = Plug(model);
  Start(device);
  bench.Run(0.2);
  Report whole = model->Sample(clock::MonotonicNs())[0];
  for (std::size_t size = 1; size < whole.size(); ++size) {
    device.SendRaw({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
  }
  for (const std::uint8_t id : {0x00, 0x05, 0x22, 0x63, 0xff}) device.SendRaw({id, 1, 2, 3});
  ASSERT_TRUE(bench.Until([&] { return Status(device).undecodable() >= 52; }));
  EXPECT_EQ(Status(device).undecodable(), 48u + 5u);
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault80JoyconLongReports) {
  auto model = std::make_shared<JoyconOnBench>(80);
  Device& device = Plug(model);
  device.outgoing = [](Report report) {
    if (report[0] == 0x30) {
      report[0] = 0x31;  // With infrared or NFC data behind.
      report.resize(362, 0xaa);
    }
    return std::vector<Report>{report};
  };
  Start(device);
  ASecond(device);
  ExpectTrue(device, 200);
  EXPECT_EQ(Status(device).mode_reasserts(), 0u);
}

FOOTING_JOYCON_FAULT(Fault81JoyconRepliesToAnothersReads) {
  auto model = std::make_shared<JoyconOnBench>(81);
  Device& device = Plug(model);
  // The kernel's driver reads, too: before each answer comes one to another address.
  device.outgoing = [](const Report& report) {
    if (!Answers(report, kRead)) return std::vector<Report>{report};
    Report other = report;
    other[15] ^= 0x06;
    std::fill(other.begin() + 20, other.end(), 0x41);
    Report shorter = report;
    shorter[19] -= 1;
    return std::vector<Report>{other, shorter, report};
  };
  Start(device);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault82JoyconThatRefusesToBeRead) {
  auto model = std::make_shared<JoyconOnBench>(82);
  Device& device = Plug(model);
  device.outgoing = [](Report report) {
    if (Answers(report, kRead)) report[kAckAt] = 0x00;
    return std::vector<Report>{report};
  };
  const std::int64_t from_ns = clock::MonotonicNs();
  Start(device);
  // Each block is asked for once: a refusal is an answer.
  bench.Run(0.5);
  EXPECT_EQ(std::count_if(device.outputs().begin(), device.outputs().end(),
                          [](const auto& one) { return Asks(one.report, kRead); }),
            4);
  EXPECT_LT(NanosecondsToSeconds(clock::MonotonicNs() - from_ns), kPatienceS);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
  ExpectTrue(device, 200, 0.2);
}

FOOTING_JOYCON_FAULT(Fault83JoyconDoubledAndLateReplies) {
  auto model = std::make_shared<JoyconOnBench>(83);
  Device& device = Plug(model);
  std::vector<Report> late;
  device.outgoing = [&](const Report& report) {
    std::vector<Report> sent = {report};
    if (report[0] != 0x21) return sent;
    sent.push_back(report);
    late.push_back(report);
    if (late.size() > 2) sent.push_back(late[late.size() - 3]);
    return sent;
  };
  Start(device);
  ASecond(device);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  EXPECT_EQ(Status(device).undecodable(), 0u);
  ExpectTrue(device, 200);
}

v1::Command Rumble(std::uint32_t device, bool on, std::uint32_t lease_ms) {
  v1::Command command;
  command.mutable_set_rumble()->set_device(device);
  command.mutable_set_rumble()->set_on(on);
  command.mutable_set_rumble()->set_lease_ms(lease_ms);
  return command;
}

FOOTING_JOYCON_FAULT(Fault84JoyconThatRumblesForEver) {
  // It stops for nothing but the neutral bytes.
  auto model = std::make_shared<JoyconOnBench>(84);
  Device& device = Plug(model);
  Start(device);
  const std::uint32_t number = Status(device).device();
  ASSERT_TRUE(bench.Send(Rumble(number, true, 300)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->joycon.rumble(); }));
  ASSERT_TRUE(bench.Until([&] { return !model->joycon.rumble(); }, 5)) << "the lease ended";
  ASSERT_TRUE(bench.Send(Rumble(number, true, 9000)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->joycon.rumble(); }));
  bench.Disconnect();
  EXPECT_TRUE(bench.Until([&] { return !model->joycon.rumble(); }, 5)) << "its client is gone";
  ASSERT_TRUE(bench.Connect());
  ASSERT_TRUE(bench.Send(Rumble(number, true, 9000)).ok());
  ASSERT_TRUE(bench.Until([&] { return model->joycon.rumble(); }));
  EXPECT_EQ(bench.Stop(), 0);
  EXPECT_TRUE(bench.Until([&] { return !model->joycon.rumble(); }, 5)) << "footingd ended";
}

FOOTING_JOYCON_FAULT(Fault85JoyconFloodOfWrites) {
  auto model = std::make_shared<JoyconOnBench>(85);
  Device& device = Plug(model);
  ASSERT_TRUE(bench.Start({"--set", "session_messages_per_s=10000"}));
  ASSERT_TRUE(bench.UntilLive(device));
  bench.Run(0.2);
  const std::uint32_t number = Status(device).device();
  device.node().page().closest_writes_ns = 1'000'000'000;
  std::uint32_t wishes = 0;
  v1::Command lamps;
  lamps.mutable_set_leds()->set_device(number);
  bench.Within(2, [&] {
    lamps.mutable_set_leds()->set_leds(wishes % 16);
    bench.Send(lamps);
    bench.Send(Rumble(number, wishes % 2 == 0, 1000));
    ++wishes;
    return false;
  });
  EXPECT_GT(wishes, 100u);
  lamps.mutable_set_leds()->set_leds(0x9);
  bench.Send(lamps);
  EXPECT_TRUE(bench.Within(2, [&] { return model->joycon.leds() == 0x9; }));
  bench.Send(Rumble(number, false, 0));
  bench.Run(0.3);
  EXPECT_FALSE(model->joycon.rumble());
  EXPECT_GE(device.node().page().closest_writes_ns, 23'000'000) << "a report per 25 ms";
  ASecond(device);
  ExpectTrue(device, 200);
}

FOOTING_JOYCON_FAULT(Fault86JoyconsOfOneName) {
  auto first = std::make_shared<JoyconOnBench>(86), second = std::make_shared<JoyconOnBench>(8601);
  second->sensors.angular_velocity_S_radps = {0, 0, -2};
  Device& one = Plug(first);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(one));
  Device& other = Plug(second);
  ASSERT_TRUE(bench.UntilLive(other));
  ASSERT_TRUE(bench.UntilSamples(other, 60));
  ExpectTrue(one, 60);
  for (const auto& sample : Motion(other))
    ASSERT_NEAR(sample.angular_velocity_radps().z(), -2, 0.05);
  EXPECT_EQ(Status(one).role(), v1::DEVICE_ROLE_LEFT_HAND);
  EXPECT_EQ(Status(other).role(), v1::DEVICE_ROLE_RIGHT_HAND);  // The left one is taken.
  EXPECT_TRUE(bench.Until([&] { return first->joycon.leds() == 1 && second->joycon.leds() == 2; }));
}

FOOTING_JOYCON_FAULT(Fault87JoyconThatComesBack) {
  auto model = std::make_shared<JoyconOnBench>(87, virtual_devices::JoyconModel::kRight);
  Device* device = &Plug(model);
  Start(*device);
  const std::string serial = device->serial();
  for (int i = 0; i < 3; ++i) {
    bench.Unplug(*device);
    ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LOST));
    // A new connection begins in simple mode with its sensors off.
    model->joycon = virtual_devices::Joycon(87, virtual_devices::JoyconModel::kRight);
    bench.seen().Forget();
    device = &Plug(model);
    ASSERT_TRUE(bench.UntilLive(*device));
  }
  ASecond(*device);
  ExpectTrue(*device, 200);
  EXPECT_EQ(Status(*device).role(), v1::DEVICE_ROLE_RIGHT_HAND);
  EXPECT_TRUE(bench.Until([&] { return model->joycon.leds() == 2; }));
}

FOOTING_JOYCON_FAULT(Fault88JoyconSensorSwitchedOffByAnother) {
  auto model = std::make_shared<JoyconOnBench>(88);
  Device& device = Plug(model);
  Start(device);
  bench.Run(3.2);
  model->joycon.set_sensor_mode(0);
  EXPECT_TRUE(bench.Within(1, [&] { return model->joycon.sensor_mode() == 1; }));
  ASecond(device);
  ExpectTrue(device, 200);  // No zeros among them.
}

FOOTING_JOYCON_FAULT(Fault89JoyconAtTheEndOfItsRange) {
  auto model = std::make_shared<JoyconOnBench>(89);
  Device& device = Plug(model);
  Start(device);
  const auto felt = [&](double z_mps2) {
    model->sensors.specific_force_S_mps2 = {0, 0, z_mps2};
    bench.Run(0.2);
    bench.seen().Forget();
    EXPECT_TRUE(bench.UntilSamples(device, 60));
    return Motion(device).back();
  };
  const auto within = felt(-7.5 * kStandardGravityMps2);
  EXPECT_NEAR(within.specific_force_mps2().z(), -7.5 * kStandardGravityMps2, 0.2);
  EXPECT_EQ(within.clipped_axes(), 0u);
  const auto beyond = felt(-9 * kStandardGravityMps2);
  EXPECT_NEAR(beyond.specific_force_mps2().z(), -8 * kStandardGravityMps2, 0.01);
  EXPECT_EQ(beyond.clipped_axes(), 4u);
  EXPECT_GE(Status(device).clipped(), 1u);
}

FOOTING_JOYCON_FAULT(Fault90JoyconStickWithoutCalibration) {
  auto model = std::make_shared<JoyconOnBench>(90);
  for (std::uint32_t at = 0x603d; at < 0x603d + 18; ++at) model->joycon.memory().erase(at);
  Device& device = Plug(model);
  Start(device);
  ASSERT_TRUE(bench.UntilSamples(device, 60));
  const auto& newest = bench.seen().Nunchuk(device.serial()).back();
  EXPECT_TRUE(newest.uncalibrated());
  EXPECT_GT(newest.stick_x(), 0.75);
  EXPECT_LE(newest.stick_x(), 1);
  EXPECT_NEAR(newest.stick_y(), 0, 0.1);
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

}  // namespace
}  // namespace footing::device_faults
