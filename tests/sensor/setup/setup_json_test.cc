#include "daemon/sensor/setup/setup_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace footing::setup {
namespace {

TEST(SetupJson, ItemsReadBackAsTheyWereWritten) {
  stream::SetupItem item{"tare", "bb:02", true, 1'700'000'000'000'000'000, 0.5, "N", "cold", true};
  const auto read = ItemsFromJson(ToJson(Items{{"main", {item}}, {"other", {}}}));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->at("main").size(), 1u);
  const stream::SetupItem& one = read->at("main")[0];
  EXPECT_EQ(one.name, item.name);
  EXPECT_EQ(one.serial, item.serial);
  EXPECT_TRUE(one.passed);
  EXPECT_EQ(one.wall_time_ns, item.wall_time_ns);
  EXPECT_EQ(one.residual, item.residual);
  EXPECT_EQ(one.unit, item.unit);
  EXPECT_EQ(one.note, item.note);
  EXPECT_TRUE(one.stale);
}

TEST(SetupJson, AResidualThatIsNotFiniteIsWrittenAsZero) {
  stream::SetupItem item;
  item.residual = std::numeric_limits<double>::infinity();
  const auto read = ItemsFromJson(ToJson(Items{{"main", {item}}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->at("main").at(0).residual, 0);
}

TEST(SetupJson, TextThatIsNotUtf8IsReplaced) {
  const auto read = RolesFromJson(ToJson(Roles{{"aa:\xff", "main/left_leg"}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->begin()->first, "aa:\xef\xbf\xbd");  // U+FFFD
}

TEST(SetupJson, AMountingThatIsNotARotationIsLeftOut) {
  const auto read = MountingsFromJson(
      R"({"aa:01": {"role": "main/left_leg", "w": 1, "x": 0, "y": 0, "z": 0.5,
                    "residual_rad": 0, "slipped": false},
          "bb:02": {"role": "main/right_leg", "w": 1, "x": 0, "y": 0, "z": 0.05,
                    "residual_rad": 0, "slipped": true}})");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 1u);
  EXPECT_TRUE(read->at("bb:02").slipped);
  EXPECT_NEAR(read->at("bb:02").rotation_MS.norm(), 1, 1e-15);
}

TEST(SetupJson, AMissingKeyRefusesThePart) {
  EXPECT_FALSE(TaresFromJson(R"({"aa:01": {"top_left_n": 1}})"));
  EXPECT_FALSE(LayoutsFromJson("[1]"));
  EXPECT_FALSE(MovedBoardsFromJson(R"({"aa:01": "yes"})"));
  EXPECT_FALSE(RolesFromJson("{"));
}

TEST(SetupJson, CalibrationBytesAreWholeLowerCaseHex) {
  const auto read = CalibrationFromJson(ToJson(StoredCalibration{"aa:01", {0x10, 0x00, 0xff}}));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->serial, "aa:01");
  EXPECT_EQ(read->bytes, (std::vector<std::uint8_t>{0x10, 0x00, 0xff}));
  for (const char* hex : {"", "1", "1g", "FF"}) {
    const std::string text = R"({"serial": "aa:01", "hex": ")" + std::string(hex) + "\"}";
    EXPECT_FALSE(CalibrationFromJson(text)) << text;
  }
}

}  // namespace
}  // namespace footing::setup
