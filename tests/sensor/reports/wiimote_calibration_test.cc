#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/reports/board_calibration.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/move_calibration.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;
using testing::HasSubstr;
using Block = std::vector<std::uint8_t>;
using Counts = std::array<std::uint16_t, 3>;

constexpr double kG = kStandardGravityMps2;

// A real remote's block (EEPROM 0x16) and the idealised one.
const Block kReal = {0x82, 0x82, 0x82, 0x15, 0x9c, 0x9c, 0x9e, 0x38, 0x40, 0x3e};
const Block kIdeal = {0x80, 0x80, 0x80, 0x00, 0x9a, 0x9a, 0x9a, 0x00, 0x40, 0xe3};
const Block kOther = {0x85, 0x85, 0x85, 0x00, 0xa0, 0xa0, 0xa0, 0x00, 0x40, 0x04};

Block Two(const Block& first, const Block& second) {
  Block both = first;
  both.insert(both.end(), second.begin(), second.end());
  return both;
}

Block WithChecksum(Block block) {
  std::uint8_t sum = 0x55;
  for (std::size_t i = 0; i < 9; ++i) sum = static_cast<std::uint8_t>(sum + block[i]);
  block[9] = sum;
  return block;
}

TEST(AccelerationCalibration, ReadsARealBlock) {
  const auto calibration = ParseAcceleration(Two(kReal, kReal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  EXPECT_EQ(calibration.zero_counts, (std::array<int, 3>{521, 521, 521}));
  EXPECT_EQ(calibration.one_g_counts, (std::array<int, 3>{627, 626, 632}));
  EXPECT_EQ(ParseAcceleration(Two(kOther, kOther)).origin, CalibrationOrigin::kDevice);
}

TEST(AccelerationCalibration, ABadFirstBlockFallsBackToTheCopy) {
  Block bad = kReal;
  bad[9] ^= 1;
  const auto calibration = ParseAcceleration(Two(bad, kIdeal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDeviceCopy);
  EXPECT_EQ(calibration.zero_counts[0], 0x200);
  EXPECT_THAT(calibration.problem, HasSubstr("block 1: checksum is wrong"));
}

TEST(AccelerationCalibration, ImpossibleBlocksAreRefusedByName) {
  const struct {
    const char* what;
    Block block;
    const char* problem;
  } kBlocks[] = {
      {"all FF", Block(10, 0xff), "checksum is wrong"},  // 9 * FF + 55 = 4C
      {"all 00", Block(10, 0x00), "checksum is wrong"},  // 0 + 55 = 55
      {"1 g at zero", WithChecksum({0x80, 0x80, 0x80, 0, 0x80, 0x80, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"1 g below zero", WithChecksum({0x9a, 0x9a, 0x9a, 0, 0x80, 0x80, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"one axis only", WithChecksum({0x80, 0x80, 0x80, 0, 0x9a, 0x9a, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"zero far off", WithChecksum({0x10, 0x80, 0x80, 0, 0x2a, 0x9a, 0x9a, 0, 0x40, 0}),
       "zero point is impossible"},
  };
  for (const auto& [what, block, problem] : kBlocks) {
    const auto calibration = ParseAcceleration(Two(block, block));
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults) << what;
    EXPECT_THAT(calibration.problem, HasSubstr(problem)) << what;
    const auto sample = Calibrate(calibration, Counts{0x200, 0x200, 0x268});
    EXPECT_TRUE(sample.specific_force_S_mps2.allFinite()) << what;
  }
}

TEST(AccelerationCalibration, WithoutAnAnswerTypicalValuesAreUsedAndSaidSo) {
  const auto calibration = ParseAcceleration({});
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
  EXPECT_THAT(calibration.problem, HasSubstr("not read"));
  EXPECT_EQ(calibration.zero_counts[0], 0x80 << 2);
  EXPECT_EQ(calibration.one_g_counts[0], 0x9a << 2);
}

TEST(Acceleration, AtRestFaceUpPointsAlongMinusZ) {
  // Raw z reads +1 g with the buttons up; S's z points down.
  const auto sample = Calibrate(ParseAcceleration(Two(kReal, kReal)), Counts{521, 521, 632});
  EXPECT_NEAR(sample.specific_force_S_mps2.x(), 0, 1e-12);
  EXPECT_NEAR(sample.specific_force_S_mps2.y(), 0, 1e-12);
  EXPECT_NEAR(sample.specific_force_S_mps2.z(), -kG, 1e-12);
  EXPECT_EQ(sample.clipped_axes, 0u);
}

TEST(Acceleration, LeftSideUpIsPlusXAndPortUpIsMinusY) {
  const auto calibration = ParseAcceleration(Two(kReal, kReal));
  const auto left_up = Calibrate(calibration, Counts{627, 521, 521});
  EXPECT_NEAR(left_up.specific_force_S_mps2.x(), kG, 1e-12);
  const auto port_up = Calibrate(calibration, Counts{521, 626, 521});
  EXPECT_NEAR(port_up.specific_force_S_mps2.y(), -kG, 1e-12);
}

TEST(Acceleration, OnlyTheEndsOfTheCountRangeAreClipped) {
  const auto calibration = ParseAcceleration(Two(kIdeal, kIdeal));
  EXPECT_EQ(Calibrate(calibration, Counts{0, 512, 512}).clipped_axes, 1u);
  EXPECT_EQ(Calibrate(calibration, Counts{512, 1022, 512}).clipped_axes, 2u);
  EXPECT_EQ(Calibrate(calibration, Counts{512, 512, 1020}).clipped_axes, 4u);
  EXPECT_EQ(Calibrate(calibration, Counts{1023, 0, 1022}).clipped_axes, 7u);
  // 4 g is beyond the sensor's nominal range, yet a reading of it is no end of the counts.
  EXPECT_EQ(Calibrate(calibration, Counts{512 + 4 * 104, 512, 512}).clipped_axes, 0u);
}

}  // namespace

/// Real packets and blocks that the other tests of this folder do not have already; each with where
/// it was published.
namespace {

using GoldenVectorsBytes = std::vector<std::uint8_t>;

TEST(GoldenVectors, AccelerationBlocksOfThreeRemotesEndInTheirChecksum) {
  // Dolphin's old default (a real remote), the idealised one, rnconrad/WiimoteEmulator.
  for (const GoldenVectorsBytes& block :
       {GoldenVectorsBytes{0x82, 0x82, 0x82, 0x15, 0x9c, 0x9c, 0x9e, 0x38, 0x40, 0x3e},
        GoldenVectorsBytes{0x80, 0x80, 0x80, 0x00, 0x9a, 0x9a, 0x9a, 0x00, 0x40, 0xe3},
        GoldenVectorsBytes{0x85, 0x85, 0x85, 0x00, 0xa0, 0xa0, 0xa0, 0x00, 0x40, 0x04}}) {
    EXPECT_TRUE(EndsInSumChecksum(block));
    EXPECT_EQ(ParseAcceleration(block).origin, stream::CalibrationOrigin::kDevice);
  }
}

TEST(GoldenVectors, TheCamerasBlockEndsInItsChecksum) {
  GoldenVectorsBytes block = {0xa1, 0xaa, 0x8b, 0x99, 0xae, 0x9e, 0x78, 0x30, 0xa7, 0x74, 0xd3};
  EXPECT_TRUE(EndsInSumChecksum(block));
  block[4] ^= 0x01;
  EXPECT_FALSE(EndsInSumChecksum(block));
  EXPECT_FALSE(EndsInSumChecksum({}));
}

TEST(GoldenVectors, ABoardsReport) {
  // wiiuse issue 42.
  GoldenVectorsBytes report = {0x34, 0x00, 0x00, 0x03, 0xd0, 0x19, 0x1a, 0x00,
                               0x17, 0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  report.resize(22);
  const auto decoded = reports::Decode(report);
  EXPECT_EQ(decoded.buttons, 0);
  const auto counts = reports::DecodeBoard(std::get<reports::Data>(decoded.body).extension());
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->corners, (std::array<std::uint16_t, 4>{0x03d0, 0x191a, 0x0017, 0x1523}));
  EXPECT_EQ(counts->temperature, 0x19);
  EXPECT_EQ(counts->battery, 0x6e);
}

TEST(GoldenVectors, ABoardsStatus) {
  // takeru/Wiimote issue 2, without the Bluetooth header.
  const auto decoded =
      reports::Decode(GoldenVectorsBytes{0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0xd5});
  const auto& status = std::get<reports::Status>(decoded.body);
  EXPECT_EQ(status.leds, 0);
  EXPECT_TRUE(status.extension);
  EXPECT_FALSE(status.battery_low);
  EXPECT_FALSE(status.ir_camera);
  EXPECT_EQ(status.battery, 0xd5);
}

TEST(GoldenVectors, ACorruptBoardBlockIsRefused) {
  // alxn1/wjoy issue 35: points that do not rise.
  const int points[] = {26880, 0,     56076, 10761, 26902, 26630,
                        23315, 55311, 61212, 28941, 60953, 36630};
  GoldenVectorsBytes block(32);
  for (std::size_t i = 0; i < 12; ++i) {
    block[4 + 2 * i] = static_cast<std::uint8_t>(points[i] >> 8);
    block[5 + 2 * i] = static_cast<std::uint8_t>(points[i]);
  }
  const auto calibration = ParseBoard(block, GoldenVectorsBytes{0x19, 0x01});
  EXPECT_EQ(calibration.origin, stream::CalibrationOrigin::kDefaults);
  EXPECT_NE(calibration.problem.find("rise"), std::string::npos);
}

TEST(GoldenVectors, AnEmptyBoardsOffsetsAreReadFarApart) {
  // wiiuse issue 104: offsets of an empty board; not clamped, whatever the typical values make of
  // it.
  reports::BoardCounts counts;
  counts.corners = {2779, 4163, 8300, 7056};
  const auto forces = CornerForces(DefaultBoard(), counts);
  EXPECT_LT(forces[reports::kTopRight], 0);
  EXPECT_LT(forces[reports::kBottomRight], 0);
  EXPECT_GT(forces[reports::kTopLeft], 0);
  EXPECT_GT(forces[reports::kBottomLeft], 0);
}

TEST(GoldenVectors, ABlockOfFfFromAnUnlockedMotionPlusIsRefused) {
  // wiiuse issue 32.
  EXPECT_EQ(ParseMotionPlus(GoldenVectorsBytes(32, 0xff)).origin,
            stream::CalibrationOrigin::kDefaults);
}

TEST(GoldenVectors, ASilentPortIsNotReady) {
  EXPECT_EQ(reports::IdentifyExtension(GoldenVectorsBytes{0xff, 0x00, 0xff, 0xff, 0xff, 0xff}),
            reports::Extension::kNotReady);
  EXPECT_EQ(reports::IdentifyExtension(GoldenVectorsBytes(6, 0xff)), reports::Extension::kNotReady);
}

TEST(GoldenVectors, ErrorTwoIsARefusalAndNoData) {
  // wiiuse issue 105, a -TR: 0x15 and 0x17 refused.
  for (const std::uint8_t refused : {0x15, 0x17}) {
    const auto decoded = reports::Decode(GoldenVectorsBytes{0x22, 0x00, 0x00, refused, 0x02});
    const auto& acknowledgement = std::get<reports::Acknowledgement>(decoded.body);
    EXPECT_EQ(acknowledgement.report, refused);
    EXPECT_EQ(acknowledgement.error, 2);
  }
}

const Eigen::Vector3d kRest(0, 0, -kStandardGravityMps2);
const Eigen::Vector3d kBias(0.05, -0.12, 0.2);
constexpr std::int64_t kStepNs = 10'000'000;

struct Rig {
  GyroscopeBias bias;
  std::int64_t now_ns = 0;
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0, 0.003};

  Eigen::Vector3d Noise() { return {noise(random), noise(random), noise(random)}; }
  /// Samples at 100 Hz.
  template <typename Motion>
  void Run(double seconds, Motion motion) {
    for (int i = 0; i < seconds * 100; ++i, now_ns += kStepNs) {
      const auto [force, velocity] = motion(NanosecondsToSeconds(now_ns));
      bias.Take(now_ns, force, velocity + Noise());
    }
  }
};

TEST(GyroscopeBias, IsFoundInASecondOfRest) {
  Rig rig;
  rig.Run(0.9, [](double) { return std::pair(kRest, kBias); });
  EXPECT_FALSE(rig.bias.known());
  EXPECT_EQ(rig.bias.bias_radps(), Eigen::Vector3d::Zero());
  rig.Run(0.2, [](double) { return std::pair(kRest, kBias); });
  ASSERT_TRUE(rig.bias.known());
  // The mean of 101 samples of 0.003: five deviations.
  EXPECT_LT((rig.bias.bias_radps() - kBias).cwiseAbs().maxCoeff(), 5 * 0.003 / 10);
}

TEST(GyroscopeBias, StaysWhileTheDeviceMoves) {
  Rig rig;
  rig.Run(1.1, [](double) { return std::pair(kRest, kBias); });
  const Eigen::Vector3d found = rig.bias.bias_radps();
  // Turned to and fro without being shaken: 1 g all along, the velocity varies.
  rig.Run(5, [](double t) {
    return std::pair(kRest, Eigen::Vector3d(kBias + Eigen::Vector3d(0, 0, 0.3 * std::sin(6 * t))));
  });
  EXPECT_EQ(rig.bias.bias_radps(), found);
  // Shaken without being turned.
  rig.Run(5, [](double t) {
    return std::pair(Eigen::Vector3d(kRest * (1 + 0.5 * std::sin(20 * t))),
                     Eigen::Vector3d(kBias * 2));
  });
  EXPECT_EQ(rig.bias.bias_radps(), found);
  // Turned fast and evenly.
  rig.Run(5, [](double) { return std::pair(kRest, Eigen::Vector3d(0, 0, 2)); });
  EXPECT_EQ(rig.bias.bias_radps(), found);
}

TEST(GyroscopeBias, FollowsADriftFromRestToRest) {
  Rig rig;
  rig.Run(1.1, [](double) { return std::pair(kRest, kBias); });
  rig.Run(2, [](double) { return std::pair(kRest, Eigen::Vector3d(0, 0, 3)); });
  const Eigen::Vector3d warm = kBias + Eigen::Vector3d(0.02, 0, -0.01);
  rig.Run(1.1, [&](double) { return std::pair(kRest, warm); });
  EXPECT_LT((rig.bias.bias_radps() - warm).cwiseAbs().maxCoeff(), 5 * 0.003 / 10);
}

TEST(GyroscopeBias, RestMustBeWhole) {
  Rig rig;
  for (int i = 0; i < 10; ++i) {
    rig.Run(0.6, [](double) { return std::pair(kRest, kBias); });
    rig.now_ns += SecondsToNanoseconds(0.4);  // Silence longer than the largest gap.
  }
  EXPECT_FALSE(rig.bias.known());
}

TEST(GyroscopeBias, NeverTakesWhatIsNoNumber) {
  Rig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rig.Run(3, [&](double t) {
    const bool bad = std::fmod(t, 0.5) < 0.01;
    return std::pair(kRest, bad ? Eigen::Vector3d(nan, 0, 0) : kBias);
  });
  rig.Run(3, [&](double) { return std::pair(Eigen::Vector3d(nan, nan, nan), kBias); });
  EXPECT_FALSE(rig.bias.known());
  EXPECT_TRUE(rig.bias.bias_radps().allFinite());
}

using MotionPlusBlock = std::vector<std::uint8_t>;

// Four real units: two of Dolphin's old sources, two of a thread of the WiiBrew forum (2009).
const MotionPlusBlock kA = {0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e,
                            0xa8, 0xc8, 0x77, 0x5e, 0x02, 0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b,
                            0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};
const MotionPlusBlock kB = {0x79, 0xbe, 0x77, 0x5a, 0x77, 0x38, 0x2f, 0x90, 0xcd, 0x3b, 0x2f,
                            0xfd, 0xc8, 0x29, 0x9c, 0x75, 0x7d, 0xd4, 0x78, 0xef, 0x78, 0x8a,
                            0x35, 0xa6, 0xc9, 0x9b, 0x33, 0x50, 0x2d, 0x00, 0xbd, 0x23};
const MotionPlusBlock kC = {0x79, 0x83, 0x73, 0x54, 0x72, 0xe8, 0x30, 0xc3, 0xcc, 0x4a, 0x34,
                            0xfc, 0xc8, 0x4f, 0xcc, 0x5b, 0x77, 0x49, 0x75, 0xa4, 0x73, 0x9a,
                            0x35, 0x52, 0xca, 0x22, 0x37, 0x26, 0x2d, 0xe5, 0xb5, 0xa2};
const MotionPlusBlock kD = {0x78, 0xd9, 0x78, 0x38, 0x77, 0x9d, 0x2f, 0x0c, 0xcf, 0xf0, 0x31,
                            0xad, 0xc8, 0x0b, 0x5e, 0x39, 0x6f, 0x81, 0x7b, 0x89, 0x78, 0x51,
                            0x33, 0x60, 0xc9, 0xf5, 0x37, 0xc1, 0x2d, 0xe9, 0x15, 0x8d};

MotionPlusBlock MotionPlusWithChecksum(MotionPlusBlock block) {
  uLong crc = crc32(crc32(0, nullptr, 0), block.data(), 14);
  crc = crc32(crc, block.data() + 16, 14);
  block[14] = static_cast<std::uint8_t>(crc >> 24);
  block[15] = static_cast<std::uint8_t>(crc >> 16);
  block[30] = static_cast<std::uint8_t>(crc >> 8);
  block[31] = static_cast<std::uint8_t>(crc);
  return block;
}

TEST(MotionPlusCalibration, ReadsFourRealBlocks) {
  for (const MotionPlusBlock& block : {kA, kB, kC, kD}) {
    const auto calibration = ParseMotionPlus(block);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
    EXPECT_EQ(calibration.problem, "");
    EXPECT_DOUBLE_EQ(calibration.fast.degrees_per_s, 1200);
    EXPECT_DOUBLE_EQ(calibration.slow.degrees_per_s, 270);
  }
  const auto a = ParseMotionPlus(kA);
  EXPECT_EQ(a.fast.zero, (std::array<int, 3>{0x7bec, 0x76ca, 0x762c}));
  EXPECT_EQ(a.fast.scale, (std::array<int, 3>{0x32dc, 0xccd7, 0x2ea8}));
  EXPECT_EQ(a.slow.zero, (std::array<int, 3>{0x760f, 0x793d, 0x779b}));
  EXPECT_EQ(a.slow.scale, (std::array<int, 3>{0x3943, 0xcaa8, 0x31c8}));
}

TEST(MotionPlusCalibration, UnusableBlocksGiveTypicalValuesAndTheReason) {
  const auto refuse = [](const MotionPlusBlock& block, const char* why) {
    const auto calibration = ParseMotionPlus(block);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
    EXPECT_THAT(calibration.problem, HasSubstr(why));
    EXPECT_EQ(calibration.fast.zero[0], 0x8000);
  };
  MotionPlusBlock flipped = kA;
  flipped[3] ^= 0x10;
  refuse(flipped, "checksum");
  MotionPlusBlock still = kA;
  still[28] = 0;  // Degrees of the slow range.
  refuse(MotionPlusWithChecksum(still), "degrees are 0");
  MotionPlusBlock flat = kA;
  flat[6] = flat[0];  // Scale of yaw at its zero.
  flat[7] = flat[1];
  refuse(MotionPlusWithChecksum(flat), "scale is at its zero");
  refuse(MotionPlusBlock(32, 0xff), "all FF");
  refuse(MotionPlusBlock(32, 0x00), "all 00");
  refuse(MotionPlusBlock(kA.begin(), kA.begin() + 31), "not read");
  refuse({}, "not read");
}

reports::MotionPlusCounts CountsOf16(int yaw, int roll, int pitch, bool slow) {
  reports::MotionPlusCounts counts;
  counts.counts = {static_cast<std::uint16_t>(yaw / 4), static_cast<std::uint16_t>(roll / 4),
                   static_cast<std::uint16_t>(pitch / 4)};
  counts.slow = {slow, slow, slow};
  return counts;
}

TEST(MotionPlus, ReadsDegreesOfTheBlockAtItsScale) {
  const auto calibration = ParseMotionPlus(kA);
  // A quarter of a count is lost by the packet's 14 bits: 3 of 14000 counts are 0.06 degrees/s
  // slow.
  const auto slow = Calibrate(calibration, CountsOf16(0x3943, 0xcaa8, 0x31c8, true));
  EXPECT_NEAR(slow.angular_velocity_S_radps.z(), DegreesToRadians(270), 2e-3) << "yaw right";
  EXPECT_NEAR(slow.angular_velocity_S_radps.y(), -DegreesToRadians(270), 2e-3) << "roll";
  EXPECT_NEAR(slow.angular_velocity_S_radps.x(), -DegreesToRadians(270), 2e-3) << "pitch";
  const auto fast = Calibrate(calibration, CountsOf16(0x32dc, 0xccd7, 0x2ea8, false));
  EXPECT_NEAR(fast.angular_velocity_S_radps.z(), DegreesToRadians(1200), 8e-3);
}

TEST(MotionPlus, EachAxisHasItsOwnRange) {
  const auto calibration = ParseMotionPlus(kA);
  // All at the slow zeros, so the fast axis is off by the difference of the zeros only.
  auto counts = CountsOf16(0x760f, 0x793d, 0x779b, true);
  counts.slow[reports::kYaw] = false;
  const auto reading = Calibrate(calibration, counts);
  EXPECT_NEAR(reading.angular_velocity_S_radps.x(), 0, 2e-3);
  EXPECT_NEAR(reading.angular_velocity_S_radps.y(), 0, 2e-3);
  const double yaw = DegreesToRadians(1200.0 * (0x760f / 4 * 4 - 0x7bec) / (0x32dc - 0x7bec));
  EXPECT_NEAR(reading.angular_velocity_S_radps.z(), yaw, 1e-9);
}

TEST(MotionPlus, ATurnGoesThroughTheChangeOfRangeWithoutAJump) {
  // The same velocity in both ranges, with the typical values.
  const MotionPlusCalibration calibration;
  const double radps = DegreesToRadians(400);
  reports::MotionPlusCounts counts;
  for (const bool slow : {true, false}) {
    const double full_deg = slow ? 440 : 2000;
    counts.counts = {static_cast<std::uint16_t>(std::lround(8192 - 8192 * 400 / full_deg)), 8192,
                     8192};
    counts.slow = {slow, slow, slow};
    EXPECT_NEAR(Calibrate(calibration, counts).angular_velocity_S_radps.z(), radps, 5e-3) << slow;
  }
}

TEST(MotionPlus, TellsTheEndOfItsRange) {
  EXPECT_FALSE(Calibrate({}, CountsOf16(0x8000, 0x8000, 0x8000, false)).clipped);
  EXPECT_TRUE(Calibrate({}, CountsOf16(0xffff, 0x8000, 0x8000, false)).clipped);
  EXPECT_TRUE(Calibrate({}, CountsOf16(0x8000, 0x8000, 0, false)).clipped);
}

constexpr double kNunchukG = kStandardGravityMps2;

// A real Nunchuk's (Adafruit_CircuitPython_Nunchuk issue 12).
const Block kNunchukReal = {0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf, 0xb1, 0x12,
                            0xe5, 0x21, 0x7c, 0xe7, 0x23, 0x7a, 0xfc, 0x51};

Block WithChecksums(Block block) {
  std::uint8_t sum = 0x55;
  for (std::size_t i = 0; i < 14; ++i) sum = static_cast<std::uint8_t>(sum + block[i]);
  block[14] = sum;
  block[15] = static_cast<std::uint8_t>(sum + 0x55);
  return block;
}

reports::NunchukCounts CountsOfNunchuk(std::uint16_t x, std::uint16_t y, std::uint16_t z) {
  reports::NunchukCounts counts;
  counts.stick_x = 0x7c;
  counts.stick_y = 0x7a;
  counts.acceleration = {x, y, z};
  return counts;
}

TEST(NunchukCalibration, ReadsARealBlock) {
  const auto calibration = ParseNunchuk(Two(kNunchukReal, kNunchukReal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  // 0x0a = 00'10'10: x 0, y 2, z 2; 0x12 = 01'00'10: x 1, y 0, z 2.
  EXPECT_EQ(calibration.zero_counts, (std::array<int, 3>{500, 490, 506}));
  EXPECT_EQ(calibration.one_g_counts, (std::array<int, 3>{705, 700, 710}));
  EXPECT_EQ(calibration.stick_x.low, 0x21);
  EXPECT_EQ(calibration.stick_x.middle, 0x7c);
  EXPECT_EQ(calibration.stick_x.high, 0xe5);
  EXPECT_EQ(calibration.stick_y.low, 0x23);
  EXPECT_EQ(calibration.stick_y.middle, 0x7a);
  EXPECT_EQ(calibration.stick_y.high, 0xe7);
}

TEST(NunchukCalibration, TheMotionPlusCopyHasOneBlock) {
  EXPECT_EQ(ParseNunchuk(kNunchukReal).origin, CalibrationOrigin::kDevice);
}

TEST(NunchukCalibration, EitherChecksumCounts) {
  for (const std::size_t at : {14u, 15u}) {
    Block bad = kNunchukReal;
    bad[at] ^= 1;
    const auto calibration = ParseNunchuk(Two(bad, kNunchukReal));
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDeviceCopy);
    EXPECT_THAT(calibration.problem, HasSubstr("checksum"));
  }
}

TEST(NunchukCalibration, UnusableBlocksGiveTypicalValues) {
  Block equal = kNunchukReal;
  for (std::size_t i = 0; i < 4; ++i) equal[4 + i] = equal[i];  // 1 g == 0 g.
  for (const Block& bad : {Block(32, 0x00), Block(32, 0xff), Block{}, Block(15, 0x80),
                           Two(WithChecksums(equal), WithChecksums(equal))}) {
    const auto calibration = ParseNunchuk(bad);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
    EXPECT_NE(calibration.problem, "");
    EXPECT_EQ(calibration.zero_counts[0], 0x200);
    EXPECT_EQ(calibration.one_g_counts[0], 0x2cc);
    EXPECT_EQ(calibration.stick_x.middle, 128);
  }
}

TEST(NunchukCalibration, AnImpossibleStickLeavesTheAccelerometer) {
  Block bad = kNunchukReal;
  bad[8] = bad[10];  // Upper end at the middle.
  const auto calibration = ParseNunchuk(WithChecksums(bad));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_THAT(calibration.problem, HasSubstr("stick"));
  EXPECT_EQ(calibration.zero_counts[0], 500);
  EXPECT_EQ(calibration.stick_x.high, 224);
}

TEST(Nunchuk, AccelerationIsInTheSensorFrame) {
  const auto calibration = ParseNunchuk(kNunchukReal);
  // Held still, stick up; then left side up; then rear up.
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(500, 490, 710))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(0, 0, -kNunchukG)));
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(705, 490, 506))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(kNunchukG, 0, 0)));
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(500, 700, 506))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(0, -kNunchukG, 0)));
}

TEST(Nunchuk, StickReachesOneAtItsEndsAndNotBeyond) {
  const auto calibration = ParseNunchuk(kNunchukReal);
  auto counts = CountsOfNunchuk(500, 490, 506);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 0);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, 0);
  counts.stick_x = 0xe5;
  counts.stick_y = 0x23;
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 1);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, -1);
  counts.stick_x = 0xff;
  counts.stick_y = 0x00;
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 1);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, -1);
}

TEST(Nunchuk, TellsClippedAxes) {
  EXPECT_EQ(Calibrate(ParseNunchuk(kNunchukReal), CountsOfNunchuk(1023, 490, 2)).clipped_axes,
            0b101u);
}

}  // namespace

// Inputs of a device model come back out of the decoders: two readings of the same tables, made
// apart from each other, with calibrations of real units and many drawn ones.
namespace {

using virtual_devices::Report;

constexpr double kRoundTripG = kStandardGravityMps2;
constexpr int kUnits = 40;
constexpr int kMotions = 50;

double Draw(std::mt19937& random, double bound) {
  return std::uniform_real_distribution<double>(-bound, bound)(random);
}
Eigen::Vector3d DrawVector(std::mt19937& random, double bound) {
  return {Draw(random, bound), Draw(random, bound), Draw(random, bound)};
}

reports::Data DataOf(const Report& report) {
  return std::get<reports::Data>(reports::Decode(report).body);
}

std::vector<std::uint8_t> RoundTripBytes(std::span<const std::uint8_t> page, std::size_t at,
                                         std::size_t size) {
  return {page.begin() + static_cast<std::ptrdiff_t>(at),
          page.begin() + static_cast<std::ptrdiff_t>(at + size)};
}

TEST(RoundTrip, WiimoteAccelerationComesBackWithinACount) {
  std::mt19937 random(1);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    virtual_devices::Wiimote wiimote(seed);
    const auto calibration =
        ParseAcceleration(RoundTripBytes(wiimote.controller().memory().eeprom(), 0x16, 20));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (const std::uint8_t mode : {0x31, 0x33, 0x35, 0x37, 0x3e}) {
      wiimote.HandleOutput(0, Report{0x12, 0x04, mode});
      for (int i = 0; i < kMotions; ++i) {
        virtual_devices::WiimoteSensors sensors;
        sensors.specific_force_S_mps2 = DrawVector(random, 3.5 * kRoundTripG);
        reports::Interleaver interleaver;
        std::optional<reports::Data> data;
        while (!data) data = interleaver.Take(DataOf(wiimote.Sample(0, sensors).at(0)));
        const auto back = Calibrate(calibration, data->acceleration_counts);
        // Half of 2 counts; of an interleaved pair all of 4. A g has at least 103.
        const double bound = (mode == 0x3e ? 4.0 : 1.0) / 103 * kRoundTripG;
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            bound + 1e-9);
      }
    }
  }
}

TEST(RoundTrip, CameraPointsComeBackInEveryFormat) {
  virtual_devices::Wiimote wiimote(1);
  const auto write = [&](std::uint8_t at, std::uint8_t value) {
    Report report(22, 0);
    report[0] = 0x16;
    report[1] = 0x04;
    report[2] = 0xb0;
    report[4] = at;
    report[5] = 1;
    report[6] = value;
    wiimote.HandleOutput(0, report);
  };
  wiimote.HandleOutput(0, Report{0x13, 0x04});
  wiimote.HandleOutput(0, Report{0x1a, 0x04});
  write(0x30, 0x08);
  std::mt19937 random(2);
  const std::pair<std::uint8_t, std::uint8_t> kModes[] = {
      {0x36, 1}, {0x37, 1}, {0x33, 3}, {0x3e, 5}};
  for (const auto& [mode, format] : kModes) {
    write(0x33, format);
    wiimote.HandleOutput(0, Report{0x12, 0x04, mode});
    for (int i = 0; i < kMotions; ++i) {
      virtual_devices::WiimoteSensors sensors;
      for (auto& point : sensors.camera) {
        if (random() % 4 == 0) continue;
        point = virtual_devices::CameraPoint{static_cast<int>(random() % 1023),
                                             static_cast<int>(random() % 768),
                                             static_cast<int>(random() % 15)};
      }
      reports::Interleaver interleaver;
      std::optional<reports::Data> data;
      while (!data) data = interleaver.Take(DataOf(wiimote.Sample(0, sensors).at(0)));
      const auto back = reports::DecodeCamera(data->camera());
      std::size_t seen = 0;
      for (const auto& point : sensors.camera) {
        if (!point) continue;
        ASSERT_LT(seen, back.size()) << int{mode};
        EXPECT_EQ(back[seen].x, point->x);
        EXPECT_EQ(back[seen].y, point->y);
        EXPECT_TRUE(format == 1 || back[seen].size == static_cast<unsigned>(point->size));
        ++seen;
      }
      EXPECT_EQ(seen, back.size());
    }
  }
}

TEST(RoundTrip, NunchukComesBackWithinACountAlsoThroughAMotionPlus) {
  std::mt19937 random(3);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto block = virtual_devices::DrawNunchukBlock(seed);
    const auto page = virtual_devices::NunchukPage(block);
    const auto calibration = ParseNunchuk(RoundTripBytes(page, 0x20, 32));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      virtual_devices::NunchukSensors sensors;
      sensors.specific_force_S_mps2 = DrawVector(random, 2 * kRoundTripG);
      sensors.stick_x = Draw(random, 1);
      sensors.stick_y = Draw(random, 1);
      sensors.c = random() % 2;
      sensors.z = random() % 2;
      const auto plain = virtual_devices::NunchukBytes(block, sensors);
      const auto passed = virtual_devices::PassedNunchuk(plain);
      for (const bool through : {false, true}) {
        const auto counts =
            through ? reports::DecodePassedNunchuk(passed) : reports::DecodeNunchuk(plain);
        ASSERT_TRUE(counts);
        const auto back = Calibrate(calibration, *counts);
        EXPECT_EQ(counts->c, sensors.c);
        EXPECT_EQ(counts->z, sensors.z);
        EXPECT_NEAR(back.stick_x, sensors.stick_x, 0.51 / 80);
        EXPECT_NEAR(back.stick_y, sensors.stick_y, 0.51 / 80);
        // Half a count, and the lowest bit when it is lost; a g has at least 196.
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            (through ? 1.5 : 0.5) / 196 * kRoundTripG + 1e-9);
      }
    }
  }
}

TEST(RoundTrip, MotionPlusComesBackWithinACountOfItsRange) {
  constexpr double kDegree = std::numbers::pi / 180;
  std::mt19937 random(4);
  int fast = 0;
  int slow = 0;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto block = virtual_devices::DrawMotionPlusBlock(seed);
    const auto calibration = ParseMotionPlus(block);
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      // Mixed: each axis crosses the border of its range at another time.
      const Eigen::Vector3d turn = DrawVector(random, 1200 * kDegree);
      const auto counts =
          reports::DecodeMotionPlus(virtual_devices::MotionPlusBytes(block, turn, i % 2));
      ASSERT_TRUE(counts);
      EXPECT_EQ(counts->extension_connected, i % 2 == 1);
      const Eigen::Vector3d back = Calibrate(calibration, *counts).angular_velocity_S_radps;
      const std::size_t kAxisOf[] = {reports::kPitch, reports::kRoll, reports::kYaw};
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_slow = counts->slow[kAxisOf[axis]];
        ++(is_slow ? slow : fast);
        // Half a count is 2 of the block's 16 bits.
        const double bound = is_slow ? 2 * 270 / 12500.0 : 2 * 1200 / 17500.0;
        EXPECT_NEAR(back[axis], turn[axis], bound * kDegree + 1e-9);
      }
    }
  }
  EXPECT_GT(slow, 500);
  EXPECT_GT(fast, 500);
}

TEST(RoundTrip, BoardForcesComeBackWithinACountInWarmAndCold) {
  std::mt19937 random(5);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    virtual_devices::BalanceBoard board(seed);
    auto& memory = board.controller().memory();
    (void)memory.Write(true, 0xa400f0, {{0x55}});
    (void)memory.Write(true, 0xa400fb, {{0x00}});
    board.HandleOutput(Report{0x12, 0x04, 0x34});
    const auto calibration = ParseBoard(RoundTripBytes(memory.extension(), 0x20, 32),
                                        RoundTripBytes(memory.extension(), 0x60, 2));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      board.set_temperature(static_cast<std::uint8_t>(1 + random() % 60));
      board.set_battery(static_cast<std::uint8_t>(0x60 + random() % 0x40));
      virtual_devices::CornerForces forces;
      for (double* corner : {&forces.top_right_n, &forces.bottom_right_n, &forces.top_left_n,
                             &forces.bottom_left_n}) {
        *corner = 250 + Draw(random, 300);  // From -5 to 56 kg.
      }
      const auto counts = reports::DecodeBoard(DataOf(board.Sample(forces).value()).extension());
      ASSERT_TRUE(counts);
      const auto back = CornerForces(calibration, *counts);
      const double bound_n =
          0.5 * 0.0116 * kRoundTripG * 1.05;  // Half of a count of at most 11.6 g.
      EXPECT_NEAR(back[reports::kTopRight], forces.top_right_n, bound_n);
      EXPECT_NEAR(back[reports::kBottomRight], forces.bottom_right_n, bound_n);
      EXPECT_NEAR(back[reports::kTopLeft], forces.top_left_n, bound_n);
      EXPECT_NEAR(back[reports::kBottomLeft], forces.bottom_left_n, bound_n);
    }
  }
}

TEST(RoundTrip, SixtyKilogramsAreSixtyAtTheEquator) {
  virtual_devices::BalanceBoard board(3);
  auto& memory = board.controller().memory();
  (void)memory.Write(true, 0xa400f0, {{0x55}});
  (void)memory.Write(true, 0xa400fb, {{0x00}});
  board.HandleOutput(Report{0x12, 0x04, 0x34});
  const auto calibration = ParseBoard(RoundTripBytes(memory.extension(), 0x20, 32),
                                      RoundTripBytes(memory.extension(), 0x60, 2));
  constexpr double kEquatorMps2 = 9.780;
  const double corner_n = 15 * kEquatorMps2;
  const auto counts = reports::DecodeBoard(
      DataOf(board.Sample({corner_n, corner_n, corner_n, corner_n}).value()).extension());
  double sum_n = 0;
  for (const double force_n : CornerForces(calibration, *counts, kEquatorMps2)) sum_n += force_n;
  EXPECT_NEAR(sum_n / kRoundTripG, 60, 4 * 0.006);
}

TEST(RoundTrip, MoveComesBackWithinACountInBothHalves) {
  std::mt19937 random(6);
  for (const auto model : {reports::MoveModel::kZcm1, reports::MoveModel::kZcm2}) {
    const bool first = model == reports::MoveModel::kZcm1;
    for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
      virtual_devices::PsMove move(
          seed, first ? virtual_devices::MoveModel::kZcm1 : virtual_devices::MoveModel::kZcm2);
      MoveBlob blob(model);
      move.Feature(0x10, 49);  // The first that the host sees need not be the first piece.
      for (int piece = 0; piece < 3; ++piece) EXPECT_TRUE(blob.Take(*move.Feature(0x10, 49)));
      ASSERT_TRUE(blob.complete());
      EXPECT_EQ(blob.bytes(), move.blob());
      const auto calibration = ParseMove(model, blob.bytes());
      ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
      std::optional<virtual_devices::MoveSensors> last;
      for (int i = 0; i < kMotions; ++i) {
        virtual_devices::MoveSensors sensors;
        sensors.specific_force_S_mps2 = DrawVector(random, 4 * kRoundTripG);
        sensors.angular_velocity_S_radps = DrawVector(random, 20);
        sensors.magnetic_field_S_counts = DrawVector(random, 2000);
        sensors.trigger = std::abs(Draw(random, 1));
        sensors.buttons = random() & 0x1909f0;
        sensors.temperature_raw = static_cast<std::uint16_t>(random() % 4096);
        const auto report = reports::DecodeMove(model, move.Sample(i * 11'000'000, sensors).at(0));
        ASSERT_TRUE(report);
        EXPECT_EQ(report->buttons, sensors.buttons);
        EXPECT_EQ(report->sequence, i % 16);
        EXPECT_EQ(report->timestamp, i * 1100 & 0xffff);
        EXPECT_EQ(report->temperature, sensors.temperature_raw);
        ASSERT_EQ(report->sample_count, first ? 2u : 1u);
        const std::size_t newest = report->sample_count - 1;
        const auto back = Calibrate(calibration, *report, newest);
        const double force_bound = 0.5 / 4060 * kRoundTripG + 1e-9;
        // A ZCM1's 80 rpm have at least 5170 counts, a ZCM2's 90 rpm 6600.
        const double turn_bound = 0.5 / (first ? 5150 / 8.378 : 6600 / 9.425);
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            force_bound);
        EXPECT_LE((back.angular_velocity_S_radps - sensors.angular_velocity_S_radps)
                      .cwiseAbs()
                      .maxCoeff(),
                  turn_bound);
        EXPECT_NEAR(back.trigger, sensors.trigger, 0.5 / 255 + 1e-9);
        if (first) {
          EXPECT_LE(
              (MagneticField(*report) - sensors.magnetic_field_S_counts).cwiseAbs().maxCoeff(),
              0.5 + 1e-9);
          const auto& before = last.value_or(sensors);
          const Eigen::Vector3d half_way =
              (before.angular_velocity_S_radps + sensors.angular_velocity_S_radps) / 2;
          EXPECT_LE((Calibrate(calibration, *report, 0).angular_velocity_S_radps - half_way)
                        .cwiseAbs()
                        .maxCoeff(),
                    turn_bound);
        }
        last = sensors;
      }
    }
  }
}

}  // namespace
}  // namespace footing::calibration
