#include "common/virtual/devices/ps_move.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/common/move_calibrations.h"

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

}  // namespace
}  // namespace footing::virtual_devices
