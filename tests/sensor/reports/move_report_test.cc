#include "daemon/sensor/reports/move_report.h"

#include <gtest/gtest.h>

namespace footing::reports {
namespace {

using MoveReportReport = std::vector<std::uint8_t>;
using MoveReportAxes = std::array<std::int16_t, 3>;

// A real ZCM1's report, from the moveonpc wiki ("Input report").
const MoveReportReport kReal = {0x01, 0x00, 0x00, 0x00, 0x06, 0x00, 0x00, 0x7f, 0x7f, 0x7f,
                                0x7f, 0xc0, 0x05, 0x2d, 0x89, 0xa8, 0x7f, 0x77, 0x8d, 0x1e,
                                0x89, 0xa0, 0x7f, 0x6f, 0x8d, 0xf8, 0x7f, 0x02, 0x80, 0xfb,
                                0x7f, 0xf8, 0x7f, 0x03, 0x80, 0xfb, 0x7f, 0x7d, 0x10, 0x9e,
                                0xfa, 0x10, 0x55, 0x0a, 0x00, 0x00, 0x00, 0x00, 0x00};

TEST(Move, ReadsARealReportOfTheFirstModel) {
  const auto report = DecodeMove(MoveModel::kZcm1, kReal);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->buttons, 0u);
  EXPECT_EQ(report->sequence, 6);
  EXPECT_EQ(report->timestamp, 0xc00a);
  EXPECT_EQ(report->battery, 5);
  ASSERT_EQ(report->sample_count, 2u);
  EXPECT_EQ(report->samples[0].acceleration, (MoveReportAxes{0x092d, -0x0058, 0x0d77}));
  EXPECT_EQ(report->samples[1].acceleration, (MoveReportAxes{0x091e, -0x0060, 0x0d6f}));
  EXPECT_EQ(report->samples[0].angular_velocity, (MoveReportAxes{-8, 2, -5}));
  EXPECT_EQ(report->samples[1].angular_velocity, (MoveReportAxes{-8, 3, -5}));
  EXPECT_EQ(report->temperature, 0x7d1);
  ASSERT_TRUE(report->has_magnetic_field);
  EXPECT_EQ(report->magnetic_field, (MoveReportAxes{0x09e, 0xfa1 - 0x1000, 0x055}));
}

TEST(Move, TheSecondModelHasTwosComplementAndOneSample) {
  MoveReportReport bytes(44);
  bytes[0x00] = 0x01;
  bytes[0x05] = 0x80;
  bytes[0x0b] = 0x12;
  bytes[0x0d] = 0x22;  // x = 0x1022.
  bytes[0x0e] = 0x10;
  bytes[0x0f] = 0x1b;  // y = -0x0fe5.
  bytes[0x10] = 0xf0;
  bytes[0x1d] = 0xff;  // Angular velocity z = -1.
  bytes[0x1e] = 0xff;
  bytes[0x28] = 0x34;
  const auto report = DecodeMove(MoveModel::kZcm2, bytes);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->sample_count, 1u);
  EXPECT_EQ(report->timestamp, 0x1234);
  EXPECT_EQ(report->samples[0].acceleration, (MoveReportAxes{0x1022, -0x0fe5, 0}));
  EXPECT_EQ(report->samples[0].angular_velocity, (MoveReportAxes{0, 0, -1}));
  EXPECT_EQ(report->samples[0].trigger, 0x80);
  EXPECT_FALSE(report->has_magnetic_field);
}

TEST(Move, EachButtonHasItsBit) {
  struct Case {
    std::size_t at;
    std::uint8_t bit;
    std::uint32_t button;
  };
  for (const Case& c :
       {Case{1, 0x01, kMoveSelect}, Case{1, 0x08, kMoveStart}, Case{2, 0x10, kMoveTriangle},
        Case{2, 0x20, kMoveCircle}, Case{2, 0x40, kMoveCross}, Case{2, 0x80, kMoveSquare},
        Case{3, 0x01, kMovePs}, Case{4, 0x40, kMoveMove}, Case{4, 0x80, kMoveTrigger}}) {
    MoveReportReport bytes = kReal;
    bytes[c.at] = static_cast<std::uint8_t>(bytes[c.at] | c.bit);
    EXPECT_EQ(DecodeMove(MoveModel::kZcm1, bytes)->buttons, c.button);
  }
}

TEST(Move, RefusesWhatIsShortOrAnother) {
  for (std::size_t size = 0; size < 0x2c; ++size) {
    EXPECT_FALSE(DecodeMove(MoveModel::kZcm1, Bytes(kReal).first(size))) << size;
  }
  EXPECT_TRUE(DecodeMove(MoveModel::kZcm1, Bytes(kReal).first(0x2c)));
  MoveReportReport other = kReal;
  other[0] = 0x02;
  EXPECT_FALSE(DecodeMove(MoveModel::kZcm1, other));
}

TEST(Move, BatteryAndTemperatureAreInTheirRanges) {
  EXPECT_DOUBLE_EQ(MoveBatteryFraction(0), 0);
  EXPECT_DOUBLE_EQ(MoveBatteryFraction(5), 1);
  EXPECT_DOUBLE_EQ(MoveBatteryFraction(0xef), 1);
  EXPECT_DOUBLE_EQ(MoveBatteryFraction(0xee), -1);
  EXPECT_DOUBLE_EQ(MoveBatteryFraction(6), -1);
  EXPECT_NEAR(MoveTemperature(0x7d1), 27.2, 0.1);
  EXPECT_DOUBLE_EQ(MoveTemperature(0), -10);
  EXPECT_DOUBLE_EQ(MoveTemperature(0xfff), 69);
  for (std::uint16_t raw = 1; raw < 0x1000; ++raw) {
    EXPECT_GE(MoveTemperature(raw), MoveTemperature(static_cast<std::uint16_t>(raw - 1)));
  }
}

TEST(Move, LightsAndRumbleGoOutInOneReport) {
  EXPECT_EQ(MoveLights(0x112233, 0x44),
            (OutputReport{0x06, 0x00, 0x11, 0x22, 0x33, 0x00, 0x44, 0x00, 0x00}));
}

}  // namespace
}  // namespace footing::reports
