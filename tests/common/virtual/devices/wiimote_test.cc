#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "common/virtual/devices/wiimote.h"
#include "tests/common/move_calibrations.h"
#include "tests/common/virtual/devices/requests.h"

namespace footing::virtual_devices {
namespace {

constexpr double kPsMoveG = 9.80665;
constexpr std::int64_t kMs = 1'000'000;
constexpr double kRpm = 2 * std::numbers::pi / 60;

PsMove Real(MoveModel model) {
  std::vector<std::uint8_t> blob;
  for (const Report& piece : model == MoveModel::kZcm1 ? test::kRealZcm1 : test::kRealZcm2) {
    blob.insert(blob.end(), piece.begin() + (blob.empty() ? 0 : 2), piece.end());
  }
  return PsMove(1, model, blob);
}

/// Three words, low byte first.
std::array<int, 3> Words(const Report& report, std::size_t at) {
  std::array<int, 3> words{};
  for (std::size_t i = 0; i < 3; ++i) words[i] = report[at + 2 * i] | report[at + 2 * i + 1] << 8;
  return words;
}

TEST(PsMove, FeatureReportsOfRealUnitsAreReproduced) {
  for (const MoveModel model : {MoveModel::kZcm1, MoveModel::kZcm2}) {
    PsMove move = Real(model);
    const auto& pieces = model == MoveModel::kZcm1 ? test::kRealZcm1 : test::kRealZcm2;
    for (int round = 0; round < 2; ++round) {
      for (const Report& piece : pieces) EXPECT_EQ(move.Feature(0x10, 49), piece);
    }
  }
}

TEST(PsMove, ARealZcm1ReadsItsOwnCalibrationWhenHeldThatWay) {
  PsMove move = Real(MoveModel::kZcm1);
  MoveSensors sensors;  // Buttons up: raw z is +1 g.
  Report report = move.Sample(0, sensors).at(0);
  ASSERT_EQ(report.size(), 49u);
  EXPECT_EQ(Words(report, 0x13)[2], 0x8fe8);
  EXPECT_EQ(Words(report, 0x1f), (std::array<int, 3>{0x8000, 0x8000, 0x8000}));
  sensors.specific_force_S_mps2 = {-kPsMoveG, kPsMoveG,
                                   kPsMoveG};  // Right up, sphere up, buttons down.
  report = move.Sample(10 * kMs, sensors).at(0);
  EXPECT_EQ(Words(report, 0x13), (std::array<int, 3>{0x9098, 0x90c9, 0x6e1a}));
  sensors.specific_force_S_mps2 = {kPsMoveG, -kPsMoveG, 0};
  report = move.Sample(20 * kMs, sensors).at(0);
  EXPECT_EQ(Words(report, 0x13)[0], 0x6e85);
  EXPECT_EQ(Words(report, 0x13)[1], 0x6ee6);
  // 80 rpm about raw x, y, z, less the bias (0x7fa5, 0x8006, 0x8180) times its factor (0.98858,
  // 1.01061, 0.96451): 5349 + 91 * 0.98858, 4566 - 6 * 1.01061, 5542 - 384 * 0.96451.
  sensors.angular_velocity_S_radps = {-80 * kRpm, 80 * kRpm, -80 * kRpm};
  report = move.Sample(30 * kMs, sensors).at(0);
  EXPECT_EQ(Words(report, 0x1f), (std::array<int, 3>{0x8000 + 5439, 0x8000 + 4560, 0x8000 + 5172}));
}

TEST(PsMove, ARealZcm2ReadsItsOwnCalibrationWhenHeldThatWay) {
  PsMove move = Real(MoveModel::kZcm2);
  MoveSensors sensors;
  sensors.specific_force_S_mps2 = {-kPsMoveG, kPsMoveG, -kPsMoveG};
  Report report = move.Sample(0, sensors).at(0);
  ASSERT_EQ(report.size(), 44u);
  EXPECT_EQ(Words(report, 0x0d), (std::array<int, 3>{0x1022, 0x1007, 0x0ffe}));
  EXPECT_EQ(Words(report, 0x0d), Words(report, 0x13));  // Sent twice.
  // Still: the bias, -5, 7 and -1.
  EXPECT_EQ(Words(report, 0x19), (std::array<int, 3>{0xfffb, 0x0007, 0xffff}));
  // 90 rpm about raw y: half of 0x1aac - 0xe563 (-6813), and the bias.
  sensors.angular_velocity_S_radps = {0, 90 * kRpm, 0};
  EXPECT_NEAR(Words(move.Sample(0, sensors).at(0), 0x19)[1], (6828 + 6813) / 2.0 + 7, 0.51);
}

TEST(PsMove, TheOlderHalfFrameOfAZcm1IsHalfWayBack) {
  PsMove move = Real(MoveModel::kZcm1);
  MoveSensors sensors;
  sensors.angular_velocity_S_radps = {0, 0, 0};
  move.Sample(0, sensors);
  sensors.angular_velocity_S_radps = {0, 80 * kRpm, 0};
  sensors.trigger = 1;
  const Report report = move.Sample(11 * kMs, sensors).at(0);
  EXPECT_EQ(Words(report, 0x19)[1], 0x8000 + 2280);
  EXPECT_EQ(Words(report, 0x1f)[1], 0x8000 + 4560);
  EXPECT_EQ(report[5], 128);
  EXPECT_EQ(report[6], 255);
}

TEST(PsMove, SequenceTimeBatteryTemperatureAndFieldHaveTheirPlaces) {
  PsMove move(7, MoveModel::kZcm1);
  move.set_battery(0xee);
  MoveSensors sensors;
  sensors.temperature_raw = 0xabc;
  sensors.magnetic_field_S_counts = {-0x123, 0x456, -0x7ff};  // Raw is the other way round.
  sensors.buttons = 1u << 19 | 1u << 16 | 1u << 11 | 1u << 4;
  const Report report = move.Sample(0x1234 * 10'000LL, sensors).at(0);
  EXPECT_EQ(Report(report.begin(), report.begin() + 5), (Report{0x01, 0x08, 0x10, 0x01, 0x40}));
  EXPECT_EQ(report[0x0b], 0x12);
  EXPECT_EQ(report[0x2b], 0x34);
  EXPECT_EQ(report[0x0c], 0xee);
  // Temperature 0xabc; field 0x123, -0x456 = 0xbaa, 0x7ff of 12 bits.
  EXPECT_EQ(Report(report.begin() + 0x25, report.begin() + 0x2b),
            (Report{0xab, 0xc1, 0x23, 0xba, 0xa7, 0xff}));
  for (int i = 1; i < 40; ++i) EXPECT_EQ(move.Sample(0, {}).at(0)[4] & 0x0f, i % 16);
  PsMove second(7, MoveModel::kZcm2);
  EXPECT_EQ(second.Sample(0x1234 * 10'000LL, {}).at(0)[0x28], 0x34);
}

TEST(PsMove, TheSphereGoesOutUnlessItsReportComesAgain) {
  PsMove move(7, MoveModel::kZcm2);
  EXPECT_EQ(move.sphere_rgb(0), 0u);
  move.HandleOutput(1000 * kMs, Report{0x06, 0, 0x12, 0x34, 0x56, 0, 0x80, 0, 0});
  EXPECT_EQ(move.sphere_rgb(5900 * kMs), 0x123456u);
  EXPECT_EQ(move.rumble(5900 * kMs), 0x80);
  EXPECT_EQ(move.sphere_rgb(6000 * kMs), 0u);
  EXPECT_EQ(move.rumble(6000 * kMs), 0);
  move.HandleOutput(7000 * kMs, Report{0x02, 0, 0, 0, 0xff, 0, 0, 0, 0});
  EXPECT_EQ(move.sphere_rgb(7001 * kMs), 0xffu);
  move.HandleOutput(7002 * kMs, Report{0x06, 0, 0x12});
  move.HandleOutput(7002 * kMs, Report{0x11, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(move.sphere_rgb(7003 * kMs), 0xffu);
}

TEST(PsMove, OtherFeaturesAreRefusedAndItsAddressComesBackwards) {
  PsMove move(7, MoveModel::kZcm1);
  EXPECT_FALSE(move.Feature(0x11, 49));
  EXPECT_EQ(move.Feature(0x10, 20)->size(), 20u);
  const Report address = move.Feature(0x04, 16).value();
  EXPECT_EQ(address[6], 0x5a);  // The serial's first byte.
}

TEST(PsMove, EndsAtTheRangeAndTakesWhatIsNotFiniteAsZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PsMove move = Real(MoveModel::kZcm1);
  MoveSensors sensors;
  sensors.specific_force_S_mps2 = {-1e9, 1e9, 1e9};
  sensors.angular_velocity_S_radps = {nan, -1e9, 0};
  sensors.trigger = nan;
  const Report report = move.Sample(0, sensors).at(0);
  EXPECT_EQ(Words(report, 0x13), (std::array<int, 3>{0xffff, 0xffff, 0x0000}));
  EXPECT_EQ(Words(report, 0x1f), (std::array<int, 3>{0x8000, 0x0000, 0x8000}));
  EXPECT_EQ(report[6], 0);
}

constexpr double kWiimoteG = 9.80665;

Report SampleOf(Wiimote& wiimote, const Eigen::Vector3d& force) {
  wiimote.HandleOutput(Report{0x12, 0x04, 0x31});
  return wiimote.Sample(force).value();
}

/// 10-bit counts of a report 0x31.
std::array<int, 3> CountsOf(const Report& report) {
  return {report[3] << 2 | (report[1] >> 5 & 3), report[4] << 2 | (report[2] >> 4 & 2),
          report[5] << 2 | (report[2] >> 5 & 2)};
}

TEST(Wiimote, ItsCalibrationHasARightChecksumInBothCopies) {
  Wiimote wiimote(7);
  for (const std::size_t at : {0x16u, 0x20u}) {
    const auto block = wiimote.controller().memory().eeprom().subspan(at, 10);
    int sum = 0x55;
    for (std::size_t i = 0; i < 9; ++i) sum += block[i];
    EXPECT_EQ(block[9], sum & 0xff);
  }
}

TEST(Wiimote, CalibrationsDifferBetweenSeedsAndRepeatForOne) {
  EXPECT_EQ(Wiimote(1).axes()[0].zero_counts, Wiimote(1).axes()[0].zero_counts);
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    if (Wiimote(seed).axes()[0].zero_counts != Wiimote(0).axes()[0].zero_counts) ++different;
    EXPECT_NE(Wiimote(seed).identity().serial, Wiimote(0).identity().serial);
  }
  EXPECT_GE(different, 15);
}

TEST(Wiimote, FaceUpAtRestReadsOneGInRawZ) {
  Wiimote wiimote(3);
  const auto counts = CountsOf(SampleOf(wiimote, {0, 0, -kWiimoteG}));
  EXPECT_EQ(counts[0], wiimote.axes()[0].zero_counts);
  EXPECT_NEAR(counts[1], wiimote.axes()[1].zero_counts, 1);
  EXPECT_NEAR(counts[2], wiimote.axes()[2].one_g_counts, 1);
}

TEST(Wiimote, LeftUpIsRawPlusXAndFrontUpIsRawMinusY) {
  Wiimote wiimote(3);
  EXPECT_EQ(CountsOf(SampleOf(wiimote, {kWiimoteG, 0, 0}))[0], wiimote.axes()[0].one_g_counts);
  const auto& y = wiimote.axes()[1];
  EXPECT_NEAR(CountsOf(SampleOf(wiimote, {0, kWiimoteG, 0}))[1], 2 * y.zero_counts - y.one_g_counts,
              1);
}

TEST(Wiimote, ClipsAtTheEndsOfTheCounts) {
  Wiimote wiimote(3);
  const auto high = CountsOf(SampleOf(wiimote, {100, -100, -100}));
  EXPECT_EQ(high, (std::array<int, 3>{1023, 1022, 1022}));
  const auto low = CountsOf(SampleOf(wiimote, {-100, 100, 100}));
  EXPECT_EQ(low, (std::array<int, 3>{0, 0, 0}));
}

TEST(Wiimote, AForceThatIsNotFiniteReadsZero) {
  Wiimote wiimote(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(CountsOf(SampleOf(wiimote, {nan, nan, nan}))[0], wiimote.axes()[0].zero_counts);
}

constexpr std::int64_t kWiimoteMs = 1'000'000;
constexpr double kWiimoteDegree = std::numbers::pi / 180;

/// Extension bit of a status report; -1 of another report.
int ExtensionBit(const Report& report) { return report.at(0) == 0x20 ? report.at(3) >> 1 & 1 : -1; }

void Key(Wiimote& wiimote, std::int64_t now_ns) {
  EXPECT_EQ(wiimote.HandleOutput(now_ns, WriteRequest(true, 0xa400f0, {0x55})).at(0)[4], 0);
  EXPECT_EQ(wiimote.HandleOutput(now_ns, WriteRequest(true, 0xa400fb, {0x00})).at(0)[4], 0);
}

void SetMode(Wiimote& wiimote, std::int64_t now_ns, std::uint8_t mode) {
  wiimote.HandleOutput(now_ns, Report{0x12, 0x04, mode});
}

/// Writes 4, 5 or 7 to the MotionPlus, waits until it is there and sets the mode.
void Activate(Wiimote& wiimote, std::int64_t now_ns, std::uint8_t way) {
  wiimote.HandleOutput(now_ns - Wiimote::kDeadNs, WriteRequest(true, 0xa600fe, {way}));
  SetMode(wiimote, now_ns, 0x35);
}

/// The six bytes of the extension in report 0x35.
ExtensionBytes PacketOf(Wiimote& wiimote, std::int64_t now_ns, const WiimoteSensors& sensors = {}) {
  const auto reports = wiimote.Sample(now_ns, sensors);
  EXPECT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports.at(0)[0], 0x35);
  ExtensionBytes packet{};
  std::copy_n(reports.at(0).begin() + 6, 6, packet.begin());
  return packet;
}

TEST(Wiimote, ARealUnitsBlockGivesTheCountsOfThatUnit) {
  // Zero 521, 521, 521; 1 g 627, 626, 632.
  const AccelerationBlock kReal = {0x82, 0x82, 0x82, 0x15, 0x9c, 0x9c, 0x9e, 0x38, 0x40, 0x3e};
  Wiimote wiimote(3, {.acceleration = kReal});
  EXPECT_EQ(CountsOf(SampleOf(wiimote, {kWiimoteG, -kWiimoteG, -kWiimoteG})),
            (std::array<int, 3>{627, 626, 632}));
  const auto still = CountsOf(SampleOf(wiimote, {0, 0, 0}));
  EXPECT_EQ(still[0], 521);
  EXPECT_NEAR(still[1], 521, 1);
  EXPECT_NEAR(still[2], 521, 1);
  const auto page = wiimote.controller().memory().eeprom();
  EXPECT_TRUE(std::equal(kReal.begin(), kReal.end(), page.begin() + 0x16));
  EXPECT_EQ(page[0x0a], 0xd3);  // A real camera block's checksum.
}

TEST(Wiimote, ATrHasItsOwnNumberAndNameAndAMotionPlusInside) {
  Wiimote wiimote(3, {.tr = true});
  EXPECT_EQ(wiimote.identity().product, 0x0330u);
  EXPECT_EQ(wiimote.identity().name, "Nintendo RVL-CNT-01-TR");
  const Report reply = wiimote.HandleOutput(0, ReadRequest(true, 0xa600fa, 6)).at(0);
  EXPECT_EQ(Report(reply.begin() + 6, reply.begin() + 12),
            (Report{0x01, 0x00, 0xa6, 0x20, 0x00, 0x05}));
  EXPECT_TRUE(wiimote.Pull(0).empty());
  EXPECT_TRUE(wiimote.has_motion_plus());
}

TEST(Wiimote, ABusyTrRefusesAsARealOneDid) {
  Wiimote wiimote(3, {.tr = true});
  wiimote.RefuseNext(2);
  EXPECT_EQ(wiimote.HandleOutput(0, Report{0x15, 0x00}).at(0), (Report{0x22, 0, 0, 0x15, 2}));
  EXPECT_EQ(wiimote.HandleOutput(0, ReadRequest(false, 0x16, 10)).at(0),
            (Report{0x22, 0, 0, 0x17, 2}));
  EXPECT_EQ(wiimote.HandleOutput(0, Report{0x15, 0x00}).at(0)[0], 0x20);
}

TEST(Wiimote, WhatComesAndGoesIsToldUnaskedAndStopsTheData) {
  Wiimote wiimote(3);
  SetMode(wiimote, 0, 0x35);
  EXPECT_EQ(wiimote.Sample(0, {}).size(), 1u);
  for (const Accessory accessory :
       {Accessory::kNunchuk, Accessory::kClassic, Accessory::kUnknown}) {
    const auto plugged = wiimote.Plug(accessory, kWiimoteMs);
    ASSERT_EQ(plugged.size(), 1u);
    EXPECT_EQ(ExtensionBit(plugged[0]), 1);
    EXPECT_TRUE(wiimote.Sample(2 * kWiimoteMs, {}).empty());
    SetMode(wiimote, 3 * kWiimoteMs, 0x35);
    EXPECT_EQ(wiimote.Sample(3 * kWiimoteMs, {}).size(), 1u);
    const auto pulled = wiimote.Pull(4 * kWiimoteMs);
    ASSERT_EQ(pulled.size(), 1u);
    EXPECT_EQ(ExtensionBit(pulled[0]), 0);
    EXPECT_TRUE(wiimote.Sample(5 * kWiimoteMs, {}).empty());
    SetMode(wiimote, 6 * kWiimoteMs, 0x35);
  }
  EXPECT_TRUE(wiimote.Pull(7 * kWiimoteMs).empty());
}

TEST(Wiimote, ANunchukSendsAfterTheKeyWasWritten) {
  Wiimote wiimote(3);
  wiimote.Plug(Accessory::kNunchuk, 0);
  SetMode(wiimote, 0, 0x35);
  EXPECT_EQ(PacketOf(wiimote, kWiimoteMs)[0], 0xff);
  Key(wiimote, 2 * kWiimoteMs);
  WiimoteSensors sensors;
  sensors.nunchuk.stick_x = 1;
  EXPECT_EQ(PacketOf(wiimote, 3 * kWiimoteMs, sensors),
            NunchukBytes(wiimote.nunchuk_block(), sensors.nunchuk));
}

TEST(Wiimote, AMotionPlusThatIsPluggedShowsOnlyAtItsOwnPage) {
  Wiimote wiimote(3);
  EXPECT_EQ(wiimote.HandleOutput(0, ReadRequest(true, 0xa600fa, 6)).at(0)[3], 0xf7);
  EXPECT_TRUE(wiimote.Plug(Accessory::kMotionPlus, 0).empty());
  const Report reply = wiimote.HandleOutput(0, ReadRequest(true, 0xa600fa, 6)).at(0);
  EXPECT_EQ(Report(reply.begin() + 6, reply.begin() + 12),
            (Report{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}));
  EXPECT_EQ(wiimote.HandleOutput(0, Report{0x15, 0x00}).at(0)[3] & 2, 0);
}

TEST(Wiimote, SwitchingTheMotionPlusOnTakesThePortAwayForTwentyMilliseconds) {
  Wiimote wiimote(3, {.motion_plus_inside = true});
  SetMode(wiimote, 0, 0x35);
  const auto answers = wiimote.HandleOutput(0, WriteRequest(true, 0xa600fe, {0x04}));
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0], (Report{0x22, 0, 0, 0x16, 0}));
  EXPECT_EQ(ExtensionBit(answers[1]), 0);
  EXPECT_TRUE(wiimote.Sample(10 * kWiimoteMs, {}).empty());
  EXPECT_EQ(wiimote.HandleOutput(19 * kWiimoteMs, ReadRequest(true, 0xa400fa, 6)).at(0)[3], 0xf7);
  EXPECT_EQ(wiimote.HandleOutput(19 * kWiimoteMs, WriteRequest(true, 0xa400f0, {0x55})).at(0)[4],
            7);
  const auto back = wiimote.Sample(20 * kWiimoteMs, {});
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(ExtensionBit(back[0]), 1);
  const Report identity =
      wiimote.HandleOutput(21 * kWiimoteMs, ReadRequest(true, 0xa400fa, 6)).at(0);
  EXPECT_EQ(Report(identity.begin() + 6, identity.begin() + 12),
            (Report{0x01, 0x00, 0xa4, 0x20, 0x04, 0x05}));
  EXPECT_TRUE(wiimote.Sample(22 * kWiimoteMs, {}).empty());  // No mode is set.
}

TEST(Wiimote, TheFirstTwoPacketsOfAMotionPlusAreRubbish) {
  Wiimote wiimote(3, {.motion_plus_inside = true});
  Activate(wiimote, 20 * kWiimoteMs, 4);
  EXPECT_EQ(PacketOf(wiimote, 30 * kWiimoteMs),
            (ExtensionBytes{0xff, 0xff, 0xff, 0xff, 0xff, 0xff}));
  EXPECT_EQ(PacketOf(wiimote, 40 * kWiimoteMs), (ExtensionBytes{}));
  EXPECT_EQ(PacketOf(wiimote, 50 * kWiimoteMs),
            MotionPlusBytes(wiimote.motion_plus_block(), {0, 0, 0}, false));
}

TEST(Wiimote, PassThroughSendsBothInTurn) {
  const struct {
    Accessory accessory;
    std::uint8_t way;
  } kWays[] = {{Accessory::kNunchuk, 5}, {Accessory::kClassic, 7}};
  for (const auto& way : kWays) {
    Wiimote wiimote(3, {.motion_plus_inside = true});
    wiimote.Plug(way.accessory, 0);
    Activate(wiimote, 20 * kWiimoteMs, way.way);
    WiimoteSensors sensors;
    sensors.nunchuk.stick_y = 0.5;
    sensors.angular_velocity_S_radps = {1, 2, 3};
    for (int i = 0; i < 2; ++i) PacketOf(wiimote, 30 * kWiimoteMs);
    int own = 0;
    std::uint8_t last = 0;
    for (int i = 0; i < 20; ++i) {
      const ExtensionBytes packet = PacketOf(wiimote, (40 + 10 * i) * kWiimoteMs, sensors);
      EXPECT_EQ(packet[5] & 1, 0);
      EXPECT_EQ(packet[4] & 1, 1);
      EXPECT_TRUE(i == 0 || (packet[5] & 2) != last);
      last = packet[5] & 2;
      if (last != 0) ++own;
    }
    EXPECT_EQ(own, 10);
  }
}

TEST(Wiimote, BehindAnActiveMotionPlusAChangeShowsInABitOnly) {
  Wiimote wiimote(3, {.motion_plus_inside = true});
  wiimote.Plug(Accessory::kNunchuk, 0);
  Activate(wiimote, 20 * kWiimoteMs, 5);
  for (int i = 0; i < 4; ++i) PacketOf(wiimote, 30 * kWiimoteMs);
  EXPECT_TRUE(wiimote.Pull(40 * kWiimoteMs).empty());
  for (int i = 0; i < 4; ++i) {
    const ExtensionBytes packet = PacketOf(wiimote, 50 * kWiimoteMs);
    EXPECT_EQ(packet[4] & 1, 0);
    EXPECT_EQ(packet[5] & 2, 2);  // There is no child to take turns with.
  }
  EXPECT_TRUE(wiimote.Plug(Accessory::kNunchuk, 60 * kWiimoteMs).empty());
  EXPECT_EQ(PacketOf(wiimote, 70 * kWiimoteMs)[4] & 1, 1);
}

TEST(Wiimote, TheKeySwitchesTheMotionPlusOffAndBeginsTheChildsInitialisation) {
  Wiimote wiimote(3, {.motion_plus_inside = true});
  wiimote.Plug(Accessory::kNunchuk, 0);
  Activate(wiimote, 20 * kWiimoteMs, 5);
  const auto answers = wiimote.HandleOutput(100 * kWiimoteMs, WriteRequest(true, 0xa400f0, {0x55}));
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(ExtensionBit(answers[1]), 0);
  EXPECT_FALSE(wiimote.motion_plus_active());
  const auto back = wiimote.Sample(120 * kWiimoteMs, {});
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(ExtensionBit(back[0]), 1);  // The Nunchuk.
  wiimote.HandleOutput(130 * kWiimoteMs, WriteRequest(true, 0xa400fb, {0x00}));
  SetMode(wiimote, 130 * kWiimoteMs, 0x35);
  EXPECT_EQ(PacketOf(wiimote, 140 * kWiimoteMs), NunchukBytes(wiimote.nunchuk_block(), {}));
}

TEST(Wiimote, AMotionPlusThatIsPulledTakesItsChildAlong) {
  Wiimote wiimote(3);
  wiimote.Plug(Accessory::kMotionPlus, 0);
  wiimote.Plug(Accessory::kNunchuk, 0);
  Activate(wiimote, 20 * kWiimoteMs, 5);
  const auto pulled = wiimote.PullMotionPlus(30 * kWiimoteMs);
  ASSERT_EQ(pulled.size(), 1u);
  EXPECT_EQ(ExtensionBit(pulled[0]), 0);
  EXPECT_FALSE(wiimote.has_motion_plus());
  EXPECT_EQ(wiimote.accessory(), Accessory::kNone);
  EXPECT_EQ(wiimote.HandleOutput(40 * kWiimoteMs, ReadRequest(true, 0xa600fa, 6)).at(0)[3], 0xf7);
}

TEST(Wiimote, TheRangeFlipsPerAxisInTheMiddleOfAMotion) {
  Wiimote wiimote(3, {.motion_plus_inside = true});
  Activate(wiimote, 20 * kWiimoteMs, 4);
  for (int i = 0; i < 2; ++i) PacketOf(wiimote, 30 * kWiimoteMs);
  WiimoteSensors sensors;
  sensors.angular_velocity_S_radps.z() = 100 * kWiimoteDegree;
  EXPECT_EQ(PacketOf(wiimote, 40 * kWiimoteMs, sensors)[3] & 3, 3);  // Yaw and pitch are slow.
  sensors.angular_velocity_S_radps.z() = 1500 * kWiimoteDegree;
  EXPECT_EQ(PacketOf(wiimote, 50 * kWiimoteMs, sensors)[3] & 3, 1);  // Pitch alone.
}

TEST(Wiimote, EveryModeThatCarriesAnExtensionHasTheSamePacket) {
  const std::pair<std::uint8_t, std::size_t> kModes[] = {{0x32, 3},  {0x34, 3},  {0x35, 6},
                                                         {0x36, 13}, {0x37, 16}, {0x3d, 1}};
  Wiimote wiimote(3);
  wiimote.Plug(Accessory::kNunchuk, 0);
  Key(wiimote, 0);
  const ExtensionBytes packet = NunchukBytes(wiimote.nunchuk_block(), {});
  for (const auto& [mode, at] : kModes) {
    SetMode(wiimote, 0, mode);
    const Report report = wiimote.Sample(kWiimoteMs, {}).at(0);
    EXPECT_TRUE(
        std::equal(packet.begin(), packet.end(), report.begin() + static_cast<std::ptrdiff_t>(at)))
        << int{mode};
  }
}

TEST(Wiimote, RubbishFromTheHostBreaksNothing) {
  std::uint32_t state = 1;
  const auto next = [&state] { return state = state * 1664525 + 1013904223; };
  Wiimote wiimote(3, {.tr = true});
  for (int trial = 0; trial < 20'000; ++trial) {
    Report report((next() >> 16) % 24);
    for (auto& byte : report) byte = static_cast<std::uint8_t>(next() >> 24);
    if (report.size() > 5 && trial % 2 == 0) {
      report[0] = static_cast<std::uint8_t>(0x16 + trial / 2 % 2);
      report[1] = 0x04;
      report[2] = static_cast<std::uint8_t>(0xa4 + (next() >> 28) % 3);
      report[3] = 0;
      report[4] = static_cast<std::uint8_t>(0xf0 | report[4]);
      report[5] = 1;
    }
    const std::int64_t now_ns = trial * kWiimoteMs;
    for (const Report& answer : wiimote.HandleOutput(now_ns, report)) {
      ASSERT_GE(answer.at(0), 0x20);
      ASSERT_LE(answer.size(), 22u);
    }
    for (const Report& answer : wiimote.Sample(now_ns, {})) ASSERT_LE(answer.size(), 22u);
    if (trial % 97 == 0) wiimote.Plug(static_cast<Accessory>((next() >> 20) % 5), now_ns);
    if (trial % 101 == 0) wiimote.Pull(now_ns);
  }
}

}  // namespace
}  // namespace footing::virtual_devices
