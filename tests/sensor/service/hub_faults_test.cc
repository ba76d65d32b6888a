#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "daemon/sensor/service/service.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using stream::CalibrationOrigin;
using stream::DeviceState;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using virtual_devices::Wiimote;

std::string Serial(std::size_t number) {
  std::string serial = "serial ";
  serial += std::to_string(number);
  return serial;
}

TEST(HubFaults, RubbishFromOneDeviceIsCountedAndDisturbsNoOther) {
  Bench bench;
  const auto bad = bench.Attach(Wiimote(1), "bad");
  bench.Attach(Wiimote(2), "good");
  bench.Advance(0.5);
  std::mt19937 random(4);
  const std::uint64_t good_before = bench.StatusOf("good").reports;
  for (int tick = 0; tick < 500; ++tick) {
    for (int i = 0; i < 5; ++i) {
      std::vector<std::uint8_t> report(random() % 80);
      for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
      bench.Receive(bad, report);
    }
    bench.Advance(0.01);
  }
  EXPECT_GT(bench.StatusOf("bad").undecodable, 1000u);
  EXPECT_NEAR(static_cast<double>(bench.StatusOf("good").reports - good_before), 500, 25);
  EXPECT_EQ(bench.StatusOf("good").undecodable, 0u);
  EXPECT_EQ(bench.StatusOf("good").state, DeviceState::kLive);
  for (const auto& sample : bench.content.motion) {
    ASSERT_TRUE(sample.specific_force_mps2.allFinite());
    ASSERT_TRUE(sample.filtered_mps2.allFinite());
  }
  for (const auto& sample : bench.content.boards) ASSERT_TRUE(std::isfinite(sample.cop_x_m));
}

TEST(HubFaults, AFloodIsBoundedWithinATickAndSaidSo) {
  Bench bench;
  const auto handle = bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  bench.content = {};
  for (int i = 0; i < 100'000; ++i) bench.Receive(handle, {0x31, 0, 0, 0x80, 0x80, 0x9a});
  bench.Advance(0.3);
  EXPECT_LE(bench.content.motion.size(), kMaxSamplesPerTick + 100);
  EXPECT_LE(bench.content.raw.size(), kMaxSamplesPerTick + 100);
  EXPECT_NE(bench.StatusOf("a").note, "");
}

TEST(HubFaults, TheSameSerialAgainTakesTheOldOnesPlace) {
  Bench bench;
  const auto old_handle = bench.Attach(Wiimote(1), "a", false);
  bench.Advance(0.5);
  bench.Attach(Wiimote(1), "a", false);
  bench.Detach(old_handle);
  bench.Advance(0.5);
  EXPECT_EQ(bench.content.status.size(), 1u);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLive);
}

TEST(HubFaults, AStandInCannotTakeARealDevicesPlace) {
  Bench bench;
  bench.Attach(Wiimote(1), "a", false);
  bench.Advance(0.5);
  bench.Attach(Wiimote(2), "a", true);
  bench.Advance(0.5);
  EXPECT_EQ(bench.content.status.size(), 1u);
  EXPECT_FALSE(bench.StatusOf("a").simulated);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLive);
}

TEST(HubFaults, ASecondStandInOfOneSerialIsNotTakenAndTheFirstLivesOn) {
  Bench bench;
  bench.Attach(Wiimote(1), "a");
  bench.Advance(0.5);
  const std::uint64_t before = bench.StatusOf("a").reports;
  const auto second = bench.Attach(Wiimote(2), "a");
  ASSERT_FALSE(bench.log.empty());
  EXPECT_NE(bench.log.back().find("the first one is still there"), std::string::npos);
  bench.Advance(0.5);
  EXPECT_GT(bench.StatusOf("a").reports, before + 20) << "50, as of a status that is 0.2 s old";
  bench.Detach(second);
  bench.Advance(0.1);
  EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLive);
}

TEST(LimitedLog, AFloodOfLinesIsCutAndCounted) {
  std::vector<std::string> lines;
  LimitedLog log([&](const LogLine& line) { lines.push_back(line.text); });
  std::int64_t now_ns = 1'000'000'000;
  for (int i = 0; i < 1000; ++i) log.Say({"line"}, now_ns);
  EXPECT_EQ(lines.size(), 20u);
  log.Say({"later"}, now_ns + 2'000'000'000);
  EXPECT_EQ(lines.back(), "later (980 lines before were left out)");
}

TEST(HubFaults, EndlesslyManySerialsAreForgottenAgain) {
  Bench bench;
  bench.Attach(Wiimote(1), "stays");
  for (std::size_t i = 0; i < 300; ++i) bench.Detach(bench.Attach(Wiimote(1), Serial(i)));
  bench.Advance(0.5);
  EXPECT_LE(bench.content.status.size(), DeviceTable::kMaxDevices);
  EXPECT_EQ(bench.StatusOf("stays").state, DeviceState::kLive);
}

TEST(HubFaults, TooManyDevicesAtOnceAreRefusedWithALine) {
  Bench bench;
  for (std::size_t i = 0; i < DeviceTable::kMaxDevices + 3; ++i) {
    bench.Attach(Wiimote(i), Serial(i));
  }
  bench.Advance(0.2);
  EXPECT_EQ(bench.content.status.size(), DeviceTable::kMaxDevices);
  EXPECT_NE(bench.log.back().find("ignored"), std::string::npos);
}

TEST(HubFaults, ARealDeviceGetsAPlaceWhenStandInsHaveAll) {
  Bench bench;
  devices::DeviceHandle newest = 0;
  for (std::size_t i = 0; i < DeviceTable::kMaxDevices; ++i)
    newest = bench.Attach(Wiimote(i), Serial(i));
  bench.Attach(Wiimote(100), "real", false);
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("real").state, DeviceState::kLive);
  EXPECT_EQ(bench.content.status.size(), DeviceTable::kMaxDevices);
  EXPECT_THAT(bench.refused, ElementsAre(newest));
  EXPECT_EQ(bench.StatusOf(Serial(0)).state, DeviceState::kLive);
  EXPECT_THAT(bench.log,
              Contains(HasSubstr(Serial(DeviceTable::kMaxDevices - 1) + " is no longer taken")));
}

TEST(HubFaults, RealDevicesAreNeverDroppedForOthers) {
  Bench bench;
  for (std::size_t i = 0; i < DeviceTable::kMaxDevices; ++i)
    bench.Attach(Wiimote(i), Serial(i), false);
  bench.Attach(Wiimote(100), "stand-in", true);
  bench.Attach(Wiimote(101), "one more", false);
  bench.Advance(0.5);
  EXPECT_THAT(bench.refused, IsEmpty());
  for (const auto& status : bench.content.status) {
    EXPECT_EQ(status.state, DeviceState::kLive) << status.serial;
  }
}

TEST(HubFaults, TheStandInOfARealDevicesSerialHearsThatItIsNoLongerTaken) {
  Bench bench;
  const auto stand_in = bench.Attach(Wiimote(1), "a", true);
  bench.Advance(0.5);
  bench.Attach(Wiimote(1), "a", false);
  bench.Advance(0.5);
  EXPECT_THAT(bench.refused, ElementsAre(stand_in));
  EXPECT_FALSE(bench.StatusOf("a").simulated);
}

TEST(HubFaults, ARealDeviceGetsItsRoleBackFromAStandIn) {
  Bench bench;
  bench.wish = stream::DeviceRole::kRightHand;
  const auto real = bench.Attach(Wiimote(1), "real", false);
  bench.Advance(0.5);
  bench.Detach(real);
  bench.Attach(Wiimote(2), "stand-in", true);
  bench.Advance(0.5);
  ASSERT_EQ(bench.StatusOf("stand-in").role, stream::DeviceRole::kRightHand);
  bench.Attach(Wiimote(1), "real", false);
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("real").role, stream::DeviceRole::kRightHand);
  EXPECT_EQ(bench.StatusOf("stand-in").role, stream::DeviceRole::kLeftHand);
}

TEST(HubFaults, AnUncalibratedDeviceIsLiveAndEverySampleSaysSo) {
  Bench bench;
  Wiimote wiimote(1);
  const auto blocks = wiimote.controller().memory().eeprom().subspan(0x16, 20);
  std::fill(blocks.begin(), blocks.end(), std::uint8_t{0xff});
  bench.Attach(wiimote, "a");
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").calibration, CalibrationOrigin::kDefaults);
  EXPECT_NE(bench.StatusOf("a").note, "");
  ASSERT_FALSE(bench.content.motion.empty());
  for (const auto& sample : bench.content.motion) EXPECT_TRUE(sample.uncalibrated);
}

TEST(HubFaults, UnpluggedInTheHandshakeNothingRemains) {
  for (int ticks = 1; ticks < 12; ++ticks) {
    Bench bench;
    const auto handle = bench.Attach(Wiimote(1), "a");
    bench.Advance(0.01 * ticks);
    bench.Detach(handle);
    bench.Advance(0.3);
    EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLost);
    bench.Attach(Wiimote(1), "a");
    bench.Advance(0.5);
    EXPECT_EQ(bench.StatusOf("a").state, DeviceState::kLive);
  }
}

}  // namespace
}  // namespace footing::sensor
