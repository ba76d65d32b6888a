#include "daemon/sensor/reports/extension.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::reports {
namespace {

using Bytes6 = std::vector<std::uint8_t>;

TEST(Extension, IsKnownByItsIdentityWhateverTheFirstByte) {
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}), Extension::kNunchuk);
  EXPECT_EQ(IdentifyExtension(Bytes6{0xff, 0x00, 0xa4, 0x20, 0x00, 0x00}), Extension::kNunchuk);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x04, 0x02}),
            Extension::kBalanceBoard);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x01, 0x01}), Extension::kClassic);
}

TEST(Extension, RubbishMeansNotReadyRatherThanNone) {
  EXPECT_EQ(IdentifyExtension(Bytes6(6, 0xff)), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension(Bytes6{0xff, 0x00, 0xff, 0xff, 0xff, 0xff}), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x2e, 0x2e, 0x2e, 0x2e, 0x2e, 0x2e}), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension({}), Extension::kNotReady);
}

TEST(Extension, ARealBoardReport) {
  // wiiuse issue 42, after the two button bytes.
  const std::vector<std::uint8_t> bytes = {0x03, 0xd0, 0x19, 0x1a, 0x00, 0x17,
                                           0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  const auto counts = DecodeBoard(bytes);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->corners[kTopRight], 0x03d0);
  EXPECT_EQ(counts->corners[kBottomRight], 0x191a);
  EXPECT_EQ(counts->corners[kTopLeft], 0x0017);
  EXPECT_EQ(counts->corners[kBottomLeft], 0x1523);
  EXPECT_EQ(counts->temperature, 0x19);
  EXPECT_EQ(counts->battery, 0x6e);
}

TEST(Extension, AShortBoardReportLacksTemperatureAndBattery) {
  const std::vector<std::uint8_t> bytes(8, 0x11);
  const auto counts = DecodeBoard(bytes);
  ASSERT_TRUE(counts);
  EXPECT_FALSE(counts->has_temperature);
  EXPECT_FALSE(counts->has_battery);
  EXPECT_FALSE(DecodeBoard(Bytes(bytes).first(7)));
}

TEST(Extension, BoardBatteryRisesFromEmptyToFull) {
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0x00), 0);
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0x78), 0.5);
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0xff), 1);
  for (int raw = 1; raw < 256; ++raw) {
    EXPECT_GE(BoardBatteryFraction(static_cast<std::uint8_t>(raw)),
              BoardBatteryFraction(static_cast<std::uint8_t>(raw - 1)));
  }
}

}  // namespace
}  // namespace footing::reports
