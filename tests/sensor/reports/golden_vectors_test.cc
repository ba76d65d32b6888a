#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "daemon/sensor/reports/acceleration.h"
#include "daemon/sensor/reports/board.h"
#include "daemon/sensor/reports/checksum.h"
#include "daemon/sensor/reports/calibration_motion_plus.h"
#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"

/// Real packets and blocks that the other tests of this folder do not have already; each with where
/// it was published.
namespace footing::calibration {
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

}  // namespace
}  // namespace footing::calibration
