#include "daemon/sensor/service/hub.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/units.h"
#include "common/stream/product_ids.h"
#include "common/stream/roles.h"
#include "common/virtual/devices/phone.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using stream::CalibrationOrigin;
using stream::DeviceRole;
using stream::DeviceState;
using testing::HasSubstr;
using testing::Not;
using virtual_devices::BalanceBoard;
using virtual_devices::Joycon;
using virtual_devices::Wiimote;

/// One count of y and z is 9 bits: about 19 mg.
constexpr double kCountMps2 = 2 * kStandardGravityMps2 / 103;

TEST(Hub, AStillWiimoteReadsGravityInTheSensorFrame) {
  Bench bench;
  bench.Attach(Wiimote(1));
  bench.Advance(1);
  ASSERT_GT(bench.content.motion.size(), 80u);
  std::uint64_t count = 0;
  std::int64_t sampled_ns = 0;
  for (const auto& sample : bench.content.motion) {
    EXPECT_NEAR(sample.specific_force_mps2.x(), 0, kCountMps2);
    EXPECT_NEAR(sample.specific_force_mps2.y(), 0, kCountMps2);
    EXPECT_NEAR(sample.specific_force_mps2.z(), -kStandardGravityMps2, kCountMps2);
    EXPECT_TRUE(sample.simulated);
    EXPECT_FALSE(sample.uncalibrated);
    EXPECT_EQ(sample.clipped_axes, 0u);
    EXPECT_EQ(sample.report_count, ++count);
    EXPECT_LE(sample.sampled_ns, sample.received_ns);
    EXPECT_GT(sample.sampled_ns, sampled_ns);
    sampled_ns = sample.sampled_ns;
  }
}

TEST(Hub, NoSampleIsLostAndEachIsPublishedOnce) {
  Bench bench;
  const auto handle = bench.Attach(Wiimote(1));
  bench.Advance(0.5);
  const std::size_t before = bench.content.motion.size();
  // Seven reports within one tick, as after a stall.
  for (int i = 0; i < 7; ++i) bench.Receive(handle, {0x31, 0, 0, 0x80, 0x80, 0x9a});
  bench.Advance(0.01);
  EXPECT_EQ(bench.content.motion.size(), before + 8);
}

TEST(Hub, SwingingHandsHaveFrequencyPhaseAndAmplitude) {
  Bench bench;
  bench.Attach(Wiimote(1));
  bench.Attach(Wiimote(2));
  bench.force = [](double t_s) {
    return Eigen::Vector3d(0, 6 * std::sin(2 * kPi * 1.5 * t_s), -kStandardGravityMps2);
  };
  bench.Advance(5);
  ASSERT_EQ(bench.content.features.size(), 1u);
  const stream::RigFeatures& rig = bench.content.features[0];
  EXPECT_EQ(rig.rig, "main");
  ASSERT_EQ(rig.devices.size(), 2u);
  for (const auto& hand : rig.devices) {
    EXPECT_TRUE(hand.moving);
    ASSERT_TRUE(hand.frequency_valid);
    EXPECT_NEAR(hand.frequency_hz, 1.5, 0.03);
    EXPECT_NEAR(hand.amplitude_mps2, 6, 0.3);
    EXPECT_TRUE(hand.simulated);
  }
  ASSERT_EQ(rig.pairs.size(), 1u);
  EXPECT_TRUE(rig.pairs[0].phase_valid);
  EXPECT_NEAR(rig.pairs[0].phase_rad, 0, DegreesToRadians(5));
  EXPECT_EQ(rig.newest_received_ns, bench.now_ns());
  EXPECT_GE(rig.decoded_ns, rig.newest_received_ns);
  EXPECT_GE(rig.computed_ns, rig.decoded_ns);
}

TEST(Hub, FeaturesAsPrintedAreThoseOfTheSettingAndSaidInTheConfig) {
  Config paper;
  paper.features = "paper";
  Bench ours, printed(paper);
  for (Bench* bench : {&ours, &printed}) {
    bench->Attach(Wiimote(1));
    bench->Attach(Wiimote(2));
    // Along gravity the printed correlation moves with the mean, ours does not.
    bench->force = [](double t_s) {
      return Eigen::Vector3d(0, 0, 6 * std::sin(2 * kPi * 1.1 * t_s) - kStandardGravityMps2);
    };
    bench->Advance(5);
    ASSERT_EQ(bench->content.features.size(), 1u);
    ASSERT_TRUE(bench->content.features[0].devices[0].frequency_valid);
  }
  EXPECT_NEAR(ours.content.features[0].devices[0].frequency_hz, 1.1, 0.005);
  const double printed_hz = printed.content.features[0].devices[0].frequency_hz;
  EXPECT_NEAR(printed_hz, 1.1, 0.3);
  EXPECT_GT(std::abs(printed_hz - 1.1), 0.05);

  EXPECT_EQ(ours.content.config, "");
  EXPECT_EQ(FeaturesIn(printed.content.config), "paper");
  for (const char* torn : {"", "{", "7", R"({"settings":{"features":7}})"}) {
    EXPECT_EQ(FeaturesIn(torn), "best");
  }
  const auto has_config = [](const Config& config) {
    const auto channels = MakeServerOptions(config, "1", {}).channels;
    return std::any_of(channels.begin(), channels.end(),
                       [](const auto& channel) { return channel.name == "config"; });
  };
  EXPECT_FALSE(has_config({}));
  EXPECT_TRUE(has_config(paper));
}

TEST(Hub, ABoardReadsItsCornersAndTheCentreOfPressure) {
  Bench bench;
  bench.corners = {50, 250, 50, 250};  // Top left, top right, bottom left, bottom right.
  bench.Attach(BalanceBoard(1));
  bench.Advance(1);
  ASSERT_GT(bench.content.boards.size(), 50u);
  const stream::BoardSample& sample = bench.content.boards.back();
  // The coarsest count of a corner, and 0.1 % for the gravity at the factory.
  const double count_n = KilogramsToNewtons(0.0115) + 0.00105 * 250;
  EXPECT_NEAR(sample.top_left_n, 50, count_n);
  EXPECT_NEAR(sample.top_right_n, 250, count_n);
  EXPECT_NEAR(sample.bottom_left_n, 50, count_n);
  EXPECT_NEAR(sample.bottom_right_n, 250, count_n);
  EXPECT_NEAR(sample.total_n, 600, 4 * count_n);
  EXPECT_TRUE(sample.cop_valid);
  EXPECT_NEAR(sample.cop_x_m, 0.433 / 2 * (500.0 - 100.0) / 600.0, 1e-3);
  EXPECT_NEAR(sample.cop_y_m, 0, 1e-3);
  EXPECT_TRUE(sample.contact);
  EXPECT_TRUE(sample.repeated);
  EXPECT_TRUE(sample.simulated);
  const auto& status = bench.StatusOf(BalanceBoard(1).identity().serial);
  EXPECT_EQ(status.role, DeviceRole::kLeftBoard);
  EXPECT_GT(status.battery_fraction, 0.9);
}

TEST(Hub, RolesComeFromTheConfigThenTheWishThenTheOrder) {
  Config config;
  config.roles["bound"] = "second/right_leg";
  Bench bench(config);
  bench.Attach(Wiimote(1), "first");
  bench.wish = DeviceRole::kRightHand;
  bench.Attach(Wiimote(2), "wishes");
  bench.Attach(Wiimote(3), "bound");
  bench.Attach(Wiimote(4), "too late");
  bench.Advance(0.3);
  EXPECT_EQ(bench.StatusOf("first").role, DeviceRole::kLeftHand);
  EXPECT_EQ(bench.StatusOf("wishes").role, DeviceRole::kRightHand);
  EXPECT_EQ(bench.StatusOf("bound").rig, "second");
  EXPECT_EQ(bench.StatusOf("bound").role, DeviceRole::kRightLeg);
  EXPECT_EQ(bench.StatusOf("too late").role, DeviceRole::kLeftLeg);
  EXPECT_EQ(bench.content.features.size(), 2u);
}

TEST(Hub, TheLogSaysWhyARequestedRoleIsNotGiven) {
  Config config;
  config.roles["bound"] = "main/right_leg";
  Bench bench(config);
  const auto line_of = [&bench](auto model, const std::string& serial, DeviceRole wish) {
    bench.wish = wish;
    bench.Attach(model, serial);
    return bench.log.back();
  };
  EXPECT_THAT(line_of(Wiimote(1), "a", DeviceRole::kLeftHand), Not(HasSubstr("asked")));
  EXPECT_THAT(line_of(Wiimote(2), "b", DeviceRole::kLeftHand),
              HasSubstr("main/right_hand, not left_hand as it asked: that is taken"));
  EXPECT_THAT(line_of(Wiimote(3), "c", DeviceRole::kLeftBoard),
              HasSubstr("not left_board as it asked: a wiimote cannot be that"));
  EXPECT_THAT(line_of(Wiimote(4), "bound", DeviceRole::kHead),
              HasSubstr("not head as it asked: main/right_leg is assigned to it"));
}

TEST(Hub, ADeviceThatComesBackKeepsItsNumberAndRole) {
  Bench bench;
  const auto handle = bench.Attach(Wiimote(1), "a");
  bench.Attach(Wiimote(2), "b");
  bench.Advance(0.5);
  bench.Detach(handle);
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLost);
  EXPECT_EQ(bench.StatusOf("a").note, "pulled");
  EXPECT_EQ(bench.StatusOf("b").state, DeviceState::kLive);
  bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLive);
  EXPECT_EQ(bench.StatusOf("a").device, 1u);
  EXPECT_EQ(bench.StatusOf("a").role, DeviceRole::kLeftHand);
}

TEST(Hub, ADeviceWithoutDataIsStale) {
  Bench bench;
  bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  bench.silent = true;
  bench.Advance(2);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kStale);
  EXPECT_NE(bench.StatusOf("a").note, "");
  EXPECT_EQ(bench.StatusOf("a").report_rate_hz, 0);
}

TEST(Hub, AssigningATakenRoleSwapsTheTwo) {
  Bench bench;
  bench.Attach(Wiimote(1), "a");
  bench.Attach(Wiimote(2), "b");
  bench.Advance(0.3);
  ASSERT_TRUE(bench.hub().AssignRole("a", {"main", DeviceRole::kRightHand}));
  bench.Advance(0.3);
  EXPECT_EQ(bench.StatusOf("a").role, DeviceRole::kRightHand);
  EXPECT_EQ(bench.StatusOf("b").role, DeviceRole::kLeftHand);
  EXPECT_FALSE(bench.hub().AssignRole("a", {"main", DeviceRole::kLeftBoard}));
  EXPECT_FALSE(bench.hub().AssignRole("nobody", {"main", DeviceRole::kLeftHand}));
}

TEST(Hub, TheLampsShowTheRoleAlsoAfterAReturn) {
  Bench bench;
  const auto first = bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  EXPECT_EQ(bench.ModelOf<Wiimote>(first).leds(), stream::LedsOf(DeviceRole::kLeftHand));
  ASSERT_TRUE(bench.hub().AssignRole("a", {"main", DeviceRole::kRightLeg}));
  bench.Advance(0.1);
  EXPECT_EQ(bench.ModelOf<Wiimote>(first).leds(), stream::LedsOf(DeviceRole::kRightLeg));
  bench.Detach(first);
  const auto again = bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  EXPECT_EQ(bench.ModelOf<Wiimote>(again).leds(), stream::LedsOf(DeviceRole::kRightLeg));
}

TEST(Hub, TheMotorStopsWithItsLeaseItsSessionAndTheDaemon) {
  Bench bench;
  const auto handle = bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  auto& wiimote = bench.ModelOf<Wiimote>(handle);
  ASSERT_TRUE(bench.hub().SetRumble(7, 1, true, 0.3));
  bench.Advance(0.1);
  EXPECT_TRUE(wiimote.rumble());
  ASSERT_TRUE(bench.hub().SetLeds(1, 0x9));
  bench.Advance(0.1);
  EXPECT_TRUE(wiimote.rumble());  // Kept across another report.
  EXPECT_EQ(wiimote.leds(), 0x9);
  bench.Advance(0.2);
  EXPECT_FALSE(wiimote.rumble());

  ASSERT_TRUE(bench.hub().SetRumble(7, 1, true, 5));
  bench.Advance(0.1);
  bench.hub().EndSession(8);
  bench.Advance(0.1);
  EXPECT_TRUE(wiimote.rumble());
  bench.hub().EndSession(7);
  bench.Advance(0.1);
  EXPECT_FALSE(wiimote.rumble());

  ASSERT_TRUE(bench.hub().SetRumble(7, 1, true, 5));
  bench.Advance(0.1);
  bench.hub().StopMotors();
  EXPECT_FALSE(wiimote.rumble());
  EXPECT_FALSE(bench.hub().SetRumble(7, 99, true, 1));
}

TEST(Hub, SamplesThatArriveTogetherKeepTheTimesOfTheirOwnClock) {
  Bench bench;
  virtual_devices::Phone phone(3);
  devices::DeviceIdentity identity;
  identity.vendor = phone.identity().vendor;
  identity.product = phone.identity().product;
  identity.serial = "phone";
  constexpr devices::DeviceHandle kPhone = 77;
  bench.hub().OnAttach(kPhone, identity);
  // 60 events a second; every twelve arrive together, the last of them at once.
  constexpr std::int64_t kEventNs = 16'666'667;
  std::vector<std::int64_t> truth_ns;
  std::vector<virtual_devices::Report> waiting;
  while (truth_ns.size() < 600) {
    truth_ns.push_back(bench.now_ns() + static_cast<std::int64_t>(waiting.size()) * kEventNs);
    phone.Feel(truth_ns.back(), {});
    waiting.push_back(phone.Event(truth_ns.back()));
    if (waiting.size() < 12) continue;
    bench.Advance(0.2);
    for (const auto& report : waiting) bench.Receive(kPhone, report);
    waiting.clear();
  }
  bench.Advance(0.01);
  ASSERT_EQ(bench.content.motion.size(), truth_ns.size());
  for (std::size_t i = 60; i < truth_ns.size(); ++i) {
    const auto& sample = bench.content.motion[i];
    EXPECT_LE(sample.sampled_ns, sample.received_ns);
    const std::int64_t step_ns = sample.sampled_ns - bench.content.motion[i - 1].sampled_ns;
    EXPECT_NEAR(static_cast<double>(step_ns), static_cast<double>(truth_ns[i] - truth_ns[i - 1]),
                3e5);  // The browser's clock has steps of 0.1 ms.
  }
  EXPECT_GE(bench.StatusOf("phone").clock_offset_sd_ms, 0);
}

TEST(Hub, RawReportsOfBothDirectionsAreKept) {
  Bench bench;
  bench.Attach(Wiimote(1));
  bench.Advance(0.5);
  std::size_t in = 0, out = 0;
  for (const auto& raw : bench.content.raw) {
    (raw.to_device ? out : in) += 1;
    EXPECT_TRUE(raw.simulated);
  }
  EXPECT_GT(in, 40u);
  EXPECT_GE(out, 4u);  // Status, calibration, mode, LEDs.
}

TEST(Hub, LongReportsOfManySamplesAreKeptRaw) {
  // A page that sends by requests: up to 20 samples in a report of 575 bytes.
  Bench bench;
  devices::DeviceIdentity identity;
  identity.vendor = stream::kVendorFooting;
  identity.product = stream::kProductInertial;
  identity.serial = "phone";
  constexpr devices::DeviceHandle kPhone = 77;
  bench.hub().OnAttach(kPhone, identity);
  std::vector<std::uint8_t> report(15 + 20 * 28, 0);
  report[0] = 1;
  report[14] = 20;
  bench.Receive(kPhone, report);
  bench.Advance(0.01);
  ASSERT_EQ(bench.content.raw.size(), 1u);
  EXPECT_EQ(bench.content.raw[0].report, report);
  for (int i = 0; i < 1'000; ++i) bench.Receive(kPhone, report);
  bench.content = {};
  bench.Advance(0.01);
  EXPECT_EQ(bench.content.raw.size(), kMaxRawBytesPerTick / report.size());
}

TEST(Hub, WhatAWiimoteClipsAJoyConMeasuresUpToItsFeatures) {
  // Both hands swing together at 2 Hz to 6.6 g: a Wiimote ends at 4.9 g, a Joy-Con at 8 g.
  constexpr double kSwingMps2 = 65, kHz = 2;
  Bench bench;
  bench.force = [](double t_s) {
    return Eigen::Vector3d(0, kSwingMps2 * std::sin(2 * kPi * kHz * t_s), -kStandardGravityMps2);
  };
  bench.Attach(Wiimote(1), "wiimote");
  bench.Attach(Joycon(2, virtual_devices::JoyconModel::kRight), "joycon");
  bench.Advance(5);
  EXPECT_GT(bench.StatusOf("wiimote").clipped, 100u);
  EXPECT_EQ(bench.StatusOf("joycon").clipped, 0u);
  const auto amplitude_of = [&bench](const std::string& serial) {
    const auto& devices = bench.content.features.at(0).devices;
    const auto found = std::find_if(devices.begin(), devices.end(), [&](const auto& one) {
      return one.device == bench.StatusOf(serial).device;
    });
    EXPECT_TRUE(found->amplitude_valid) << serial;
    return found->amplitude_mps2;
  };
  EXPECT_NEAR(amplitude_of("joycon"), kSwingMps2, 0.02 * kSwingMps2);
  std::map<std::uint32_t, double> peak_mps2;
  for (const auto& sample : bench.content.motion) {
    double& peak = peak_mps2[sample.device];
    peak = std::max(peak, std::abs(sample.specific_force_mps2.y()));
  }
  // A Wiimote's features fill its peaks in, by a fit to what it measured below them.
  EXPECT_LT(peak_mps2[bench.StatusOf("wiimote").device], 0.8 * kSwingMps2);
  EXPECT_NEAR(peak_mps2[bench.StatusOf("joycon").device], kSwingMps2, 0.5);
  bench.content = {};
  bench.force = [](double) { return Eigen::Vector3d(0, 8.5 * kStandardGravityMps2, 0); };
  bench.Advance(0.5);
  EXPECT_GT(bench.StatusOf("joycon").clipped, 50u);
}

TEST(Hub, ClippedSamplesAreFlaggedAndCounted) {
  Bench bench;
  bench.Attach(Wiimote(1), "a");
  bench.force = [](double) { return Eigen::Vector3d(200, 0, -9.81); };
  bench.Advance(0.5);
  EXPECT_EQ(bench.content.motion.back().clipped_axes, 1u);
  EXPECT_GT(bench.StatusOf("a").clipped, 30u);
}

}  // namespace
}  // namespace footing::sensor
