#include <algorithm>
#include <numbers>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

using virtual_devices::Accessory;

constexpr std::uint8_t kStatusReply = 0x20;
constexpr std::uint8_t kReadReply = 0x21;

/// Writes of this value to this register of the device.
std::size_t RegisterWrites(const Device& device, std::uint32_t address, std::uint8_t value) {
  return static_cast<std::size_t>(
      std::count_if(device.outputs().begin(), device.outputs().end(), [&](const auto& output) {
        const Report& report = output.report;
        return report.size() > 6 && report[0] == 0x16 && report[2] == address >> 16 &&
               report[3] == (address >> 8 & 0xff) && report[4] == (address & 0xff) &&
               report[6] == value;
      }));
}

class ExtensionFault : public Fault {
 protected:
  using Models = std::shared_ptr<WiimoteModel>;

  static virtual_devices::WiimoteOptions WithMotionPlus() {
    virtual_devices::WiimoteOptions options;
    options.motion_plus_inside = true;
    return options;
  }
  static virtual_devices::NunchukSensors Held() {
    virtual_devices::NunchukSensors nunchuk;
    nunchuk.stick_x = 0.5;
    nunchuk.stick_y = -0.25;
    nunchuk.c = true;
    return nunchuk;
  }
  static void ExpectHeld(const v1::NunchukSample& sample) {
    EXPECT_NEAR(sample.stick_x(), 0.5, 0.02);
    EXPECT_NEAR(sample.stick_y(), -0.25, 0.02);
    EXPECT_TRUE(sample.c());
    EXPECT_FALSE(sample.z());
    EXPECT_NEAR(sample.specific_force_mps2().x(), 0, 0.3);
    EXPECT_NEAR(sample.specific_force_mps2().y(), 0, 0.3);
    EXPECT_NEAR(sample.specific_force_mps2().z(), -9.80665, 0.3);
    EXPECT_FALSE(sample.uncalibrated());
  }
  const std::vector<v1::NunchukSample>& Nunchuk(const Device& device) {
    return bench.seen().Nunchuk(device.serial());
  }
  static void Plug(Device& device, WiimoteModel& model, Accessory accessory) {
    for (const Report& said : model.wiimote.Plug(accessory, clock::MonotonicNs())) {
      device.Send(said);
    }
  }
  static void Pull(Device& device, WiimoteModel& model) {
    for (const Report& said : model.wiimote.Pull(clock::MonotonicNs())) device.Send(said);
  }
  Device& StartWith(const Models& model) {
    Device& device = bench.Plug(model);
    EXPECT_TRUE(bench.Start());
    EXPECT_TRUE(bench.UntilLive(device));
    return device;
  }
  bool UntilExtension(const Device& device, v1::Extension extension) {
    return bench.Until([&] { return Status(device).extension() == extension; });
  }
  bool ExtensionWithin(double seconds, const Device& device, v1::Extension extension) {
    return bench.Within(seconds, [&] { return Status(device).extension() == extension; });
  }
  bool UntilNunchuk(const Device& device, std::size_t more) {
    const std::size_t wanted = Nunchuk(device).size() + more;
    return bench.Until([&] { return Nunchuk(device).size() >= wanted; });
  }
  std::size_t Turns(const Device& device) {
    return static_cast<std::size_t>(
        std::count_if(Motion(device).begin(), Motion(device).end(),
                      [](const auto& sample) { return sample.has_angular_velocity_radps(); }));
  }
  bool UntilTurns(const Device& device, std::size_t more) {
    const std::size_t wanted = Turns(device) + more;
    return bench.Until([&] { return Turns(device) >= wanted; });
  }
  /// Every angular velocity published is one that the model had within the last 30 ms.
  void ExpectTurning(const Device& device, const WiimoteModel& model, double tolerance_radps) {
    for (const auto& sample : Motion(device)) {
      if (!sample.has_angular_velocity_radps()) continue;
      const auto& told = sample.angular_velocity_radps();
      double error_radps = 1e9;
      for (std::int64_t back_ns = 0; back_ns <= 30'000'000; back_ns += 1'000'000) {
        const Eigen::Vector3d truth = model.turning(sample.received_ns() - back_ns);
        error_radps =
            std::min(error_radps,
                     (truth - Eigen::Vector3d(told.x(), told.y(), told.z())).cwiseAbs().maxCoeff());
      }
      ASSERT_LT(error_radps, tolerance_radps) << sample.ShortDebugString();
    }
  }
};

#define FOOTING_EXTENSION_FAULT(name)    \
  class name : public ExtensionFault {}; \
  TEST_F(name, IsSurvived)

FOOTING_EXTENSION_FAULT(Fault27NunchukPulledAndPluggedInTheStream) {
  auto model = std::make_shared<WiimoteModel>(27);
  model->nunchuk = Held();
  model->wiimote.Plug(Accessory::kNunchuk, 0);
  Device& device = StartWith(model);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_NUNCHUK));
  ASSERT_TRUE(UntilNunchuk(device, 20));
  EXPECT_EQ(Status(device).extension_calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  const std::uint64_t changes = Status(device).extension_changes();
  Pull(device, *model);
  ASSERT_TRUE(ExtensionWithin(2, device, v1::EXTENSION_NONE));
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 50));
  EXPECT_TRUE(Nunchuk(device).empty());
  ExpectAllAtRest(device, 50);
  Plug(device, *model, Accessory::kNunchuk);
  ASSERT_TRUE(ExtensionWithin(2, device, v1::EXTENSION_NUNCHUK));
  ASSERT_TRUE(UntilNunchuk(device, 20));
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
  ExpectAllAtRest(device, 50);
  EXPECT_EQ(Status(device).extension_changes(), changes + 2);
  EXPECT_TRUE(bench.UntilLive(device));
}

FOOTING_EXTENSION_FAULT(Fault28DeadWindowOfAnActivation) {
  auto model = std::make_shared<WiimoteModel>(28, WithMotionPlus());
  model->nunchuk = Held();
  model->wiimote.Plug(Accessory::kNunchuk, 0);
  Device& device = bench.Plug(model);
  // The port is off for some 20 ms: the status says that nothing is plugged in, then something.
  std::size_t nothing = 0;
  device.outgoing = [&nothing](const Report& report) {
    if (report[0] == kStatusReply && (report[3] & 0x02) == 0) ++nothing;
    return std::vector<Report>{report};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS_NUNCHUK));
  bench.seen().Forget();
  bench.Run(2);
  EXPECT_GE(nothing, 1u) << "the model did not do it";
  // It was switched on once, and is left in peace.
  EXPECT_EQ(RegisterWrites(device, 0xa600fe, 0x05), 1u);
  EXPECT_EQ(Status(device).extension(), v1::EXTENSION_MOTION_PLUS_NUNCHUK);
  EXPECT_LE(Status(device).extension_changes(), 1u);
  EXPECT_GE(Nunchuk(device).size(), 80u);  // Each at half the rate.
  EXPECT_GE(Turns(device), 80u);
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
  ExpectAllAtRest(device, 180);
}

FOOTING_EXTENSION_FAULT(Fault29ChildSwappedBehindAMotionPlus) {
  auto model = std::make_shared<WiimoteModel>(29, WithMotionPlus());
  model->nunchuk = Held();
  Device& device = StartWith(model);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS));
  ASSERT_TRUE(UntilTurns(device, 20));
  // Only a bit in its packets tells of what comes and goes.
  Plug(device, *model, Accessory::kNunchuk);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS_NUNCHUK));
  ASSERT_TRUE(UntilNunchuk(device, 20));
  ASSERT_TRUE(UntilTurns(device, 20));
  Pull(device, *model);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS));
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
  bench.seen().Forget();
  ASSERT_TRUE(UntilTurns(device, 20));
  EXPECT_TRUE(Nunchuk(device).empty());
  Plug(device, *model, Accessory::kClassic);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS_CLASSIC));
  ASSERT_TRUE(UntilTurns(device, 20));
  EXPECT_TRUE(Nunchuk(device).empty());
  ExpectAllAtRest(device, 40);
  for (const auto& sample : Motion(device)) {
    if (!sample.has_angular_velocity_radps()) continue;
    EXPECT_NEAR(sample.angular_velocity_radps().x(), 0, 0.1);
    EXPECT_NEAR(sample.angular_velocity_radps().z(), 0, 0.1);
  }
}

FOOTING_EXTENSION_FAULT(Fault30MotionPlusPulledWhileActive) {
  auto model = std::make_shared<WiimoteModel>(30);
  model->turning = [](std::int64_t) { return Eigen::Vector3d(0, 0, 1.5); };
  model->wiimote.Plug(Accessory::kMotionPlus, 0);
  Device& device = StartWith(model);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS));
  ASSERT_TRUE(UntilTurns(device, 20));
  EXPECT_EQ(Status(device).gyroscope_calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  Pull(device, *model);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_NONE));
  ExpectTurning(device, *model, 0.05);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 100));
  EXPECT_EQ(Turns(device), 0u);
  ExpectAllAtRest(device, 100);
  EXPECT_EQ(Status(device).gyroscope_calibration(), v1::CALIBRATION_ORIGIN_UNSPECIFIED);
  // Something else into the same port.
  model->nunchuk = Held();
  Plug(device, *model, Accessory::kNunchuk);
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_NUNCHUK));
  ASSERT_TRUE(UntilNunchuk(device, 20));
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
}

FOOTING_EXTENSION_FAULT(Fault31IdentityThatIsNotReadyAtFirst) {
  auto model = std::make_shared<WiimoteModel>(31);
  model->nunchuk = Held();
  model->wiimote.Plug(Accessory::kNunchuk, 0);
  Device& device = bench.Plug(model);
  std::size_t asked = 0;
  device.outgoing = [&asked](const Report& report) {
    Report reply = report;
    if (report[0] == kReadReply && report[4] == 0x00 && report[5] == 0xfa &&
        (report[3] & 15) == 0 && ++asked <= 2) {
      std::fill(reply.begin() + 6, reply.begin() + 12, 0xff);
    }
    return std::vector<Report>{reply};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_NUNCHUK));
  EXPECT_GE(asked, 3u);
  ASSERT_TRUE(UntilNunchuk(device, 20));
  for (const auto& sample : Nunchuk(device)) ExpectHeld(sample);
  ExpectAllAtRest(device, 20);
}

FOOTING_EXTENSION_FAULT(Fault32CloneThatAttachesAndDetachesForEver) {
  auto model = std::make_shared<WiimoteModel>(32);
  Device& device = StartWith(model);
  bench.Run(0.5);
  const std::size_t before = device.outputs().size();
  bench.seen().Forget();
  std::size_t late = 0;
  // Each time the status tells of it, as a clone's does.
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    if (round == kRounds - 10) late = device.outputs().size();
    Plug(device, *model, Accessory::kNunchuk);
    bench.Run(0.05);
    Pull(device, *model);
    bench.Run(0.05);
  }
  // At first it is looked at; then less and less often.
  EXPECT_LE(device.outputs().size() - before, 120u);
  EXPECT_LE(device.outputs().size() - late, 25u);
  // The Wiimote's own data go on in between, as far as it sends any.
  ExpectAllAtRest(device, 50);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 100, 3));
  ExpectAllAtRest(device, 100);
  EXPECT_EQ(Status(device).state(), v1::DEVICE_STATE_LIVE);
}

FOOTING_EXTENSION_FAULT(Fault33ClassicAndUnknownExtensions) {
  auto classic = std::make_shared<WiimoteModel>(33);
  auto unknown = std::make_shared<WiimoteModel>(3300);
  classic->wiimote.Plug(Accessory::kClassic, 0);
  unknown->wiimote.Plug(Accessory::kUnknown, 0);
  Device& first = bench.Plug(classic);
  Device& second = bench.Plug(unknown);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(UntilExtension(first, v1::EXTENSION_CLASSIC));
  ASSERT_TRUE(UntilExtension(second, v1::EXTENSION_UNKNOWN));
  bench.Run(0.5);
  for (Device* device : {&first, &second}) {
    const std::size_t outputs = device->outputs().size();
    ASSERT_TRUE(bench.UntilSamples(*device, 100));
    ExpectAllAtRest(*device, 100);
    EXPECT_TRUE(Nunchuk(*device).empty());
    EXPECT_EQ(Turns(*device), 0u);
    EXPECT_EQ(Status(*device).state(), v1::DEVICE_STATE_LIVE);
    EXPECT_LE(device->outputs().size(), outputs + 2);  // It is left in peace.
  }
}

FOOTING_EXTENSION_FAULT(Fault34RubbishInTheFirstPackets) {
  auto model = std::make_shared<WiimoteModel>(34, WithMotionPlus());
  model->turning = [](std::int64_t) { return Eigen::Vector3d(1, -1.5, 2); };
  Device& device = bench.Plug(model);
  // After the activation one packet of ones, and one that looks like a turn as fast as can be.
  std::size_t rubbish = 0;
  device.outgoing = [&](const Report& report) {
    Report changed = report;
    if (report[0] == 0x35 && RegisterWrites(device, 0xa600fe, 0x04) > 0 && rubbish < 2) {
      std::fill(changed.begin() + 6, changed.end(), rubbish == 0 ? 0xff : 0x00);
      if (rubbish == 1) changed[11] = 0x02;
      ++rubbish;
    }
    return std::vector<Report>{changed};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS));
  ASSERT_TRUE(UntilTurns(device, 50));
  EXPECT_EQ(rubbish, 2u);
  ExpectTurning(device, *model, 0.05);
  ExpectAllAtRest(device, 50);
}

FOOTING_EXTENSION_FAULT(Fault35RangesThatFlipInAMotion) {
  auto model = std::make_shared<WiimoteModel>(35, WithMotionPlus());
  // Up to 15 rad/s on each axis at another time; the slow range ends near 7.7 rad/s.
  model->turning = [](std::int64_t now_ns) {
    const double t = static_cast<double>(now_ns) * 1e-9 * 2 * std::numbers::pi;
    return Eigen::Vector3d(15 * std::sin(t), 15 * std::sin(1.3 * t + 1),
                           15 * std::sin(0.7 * t + 2));
  };
  Device& device = bench.Plug(model);
  std::set<int> ranges;  // The three slow bits of the packets sent.
  device.outgoing = [&ranges](const Report& report) {
    if (report[0] == 0x35 && (report[11] & 0x03) == 0x02) {
      ranges.insert((report[9] & 0x03) | (report[10] & 0x02) << 1);
    }
    return std::vector<Report>{report};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(UntilExtension(device, v1::EXTENSION_MOTION_PLUS));
  ASSERT_TRUE(UntilTurns(device, 300));
  EXPECT_GE(ranges.size(), 6u) << "the model did not flip";
  ExpectTurning(device, *model, 0.35);  // A fast count is 0.004 rad/s; 1 ms is up to 0.15.
  double largest_radps = 0;
  for (const auto& sample : Motion(device)) {
    largest_radps = std::max(largest_radps, std::abs(sample.angular_velocity_radps().x()));
  }
  EXPECT_GT(largest_radps, 13);
}

}  // namespace
}  // namespace footing::device_faults
