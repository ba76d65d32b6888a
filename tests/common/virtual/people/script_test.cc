#include "common/virtual/people/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::choreography {
namespace {

using testing::HasSubstr;

TEST(Script, EveryCarriedNameIsAScriptThatBeginsAndEndsInTheTPose) {
  EXPECT_THAT(BuiltInScriptNames(), testing::ElementsAre("demo", "own_motion", "quiet"));
  for (const std::string& name : BuiltInScriptNames()) {
    const auto script = BuiltInScript(name);
    ASSERT_TRUE(script) << script.error().message;
    EXPECT_NEAR(script->duration_s(), name == "own_motion" ? 120 : 60, 6) << name;
    EXPECT_EQ(script->keys.front().values, Values{}) << name;
    EXPECT_GE(script->keys.front().seconds, 6) << name;  // Long enough to calibrate in.
    EXPECT_EQ(script->keys.back().values, Values{}) << name;
  }
  const auto none = BuiltInScript("dance");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(none.error().message, HasSubstr("demo own_motion quiet"));
}

TEST(Script, ChannelsStayUntilTheyAreSetAgainAndRepeatsAreWrittenOut) {
  const auto script = ParseScript(
      R"({"sway_mm": 3, "keys": [{"seconds": 1, "bow_deg": 90, "both_elbow_deg": 18},
          {"repeat": 2, "keys": [{"seconds": 2, "left_elbow_deg": 0}, {"seconds": 1}]}]})",
      "file");
  ASSERT_TRUE(script) << script.error().message;
  ASSERT_EQ(script->keys.size(), 5u);
  EXPECT_DOUBLE_EQ(script->duration_s(), 7);
  EXPECT_DOUBLE_EQ(script->sway_m, 0.003);
  EXPECT_DOUBLE_EQ(At(script->keys[4].values, Channel::kBow), kPi / 2);
  EXPECT_DOUBLE_EQ(At(script->keys[4].values, Channel::kRightElbow), kPi / 10);
  EXPECT_DOUBLE_EQ(At(script->keys[4].values, Channel::kLeftElbow), 0);
}

TEST(Script, WhatIsWrongIsNamedWithItsKey) {
  const char* const kWrong[] = {
      R"({})",
      R"({"seconds": 0})",
      R"({"seconds": "x"})",
      R"({"seconds": 1, "bow": 1})",
      R"({"seconds": 1, "bow_deg": 91})",
      R"({"seconds": 1, "middle_raise_deg": 1})",
      R"(7)",
      R"({"repeat": 0, "keys": [{"seconds": 1}]})",
      R"({"repeat": 2, "keys": []})",
      R"({"repeat": 2, "keys": [{"repeat": 2, "keys": [{"seconds": 1}]}]})",
  };
  for (const char* key : kWrong) {
    const auto script =
        ParseScript(R"({"keys": [{"seconds": 1}, )" + std::string(key) + "]}", "file");
    ASSERT_FALSE(script) << key;
    EXPECT_EQ(script.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(script.error().message, HasSubstr("file, key 2")) << key;
  }
  for (const char* text :
       {"", "{}", "[]", R"({"keys": []})", R"({"keys": [{"seconds": 1}], "sway_mm": 99})",
        R"({"keys": [{"seconds": 1}], "speed": 1})"}) {
    EXPECT_FALSE(ParseScript(text, "file")) << text;
  }
}

TEST(Script, AFootThatCarriesMustNotLeaveTheGround) {
  for (const char* lift : {"left_lift_m", "left_step_m", "left_out_m"}) {
    const std::string moves = R"({"seconds": 1, ")" + std::string(lift) + R"(": 0.1})";
    EXPECT_FALSE(ParseScript(R"({"keys": [{"seconds": 1, "weight": 0}, )" + moves + "]}", "f"));
    EXPECT_FALSE(ParseScript(R"({"keys": [{"seconds": 1, "weight": 1}, )" + moves + "]}", "f"));
    EXPECT_TRUE(ParseScript(R"({"keys": [{"seconds": 1, "weight": -1}, )" + moves + "]}", "f"));
  }
}

TEST(Script, HipsMustNotFallFasterThanABodyDoes) {
  const auto parsed = [](const std::string& keys) {
    return ParseScript(R"({"keys": [{"seconds": 1}, )" + keys + "]}", "f");
  };
  const auto fast = parsed(R"({"seconds": 0.5, "crouch_m": 0.45})");
  ASSERT_FALSE(fast);
  EXPECT_THAT(fast.error().message, HasSubstr("f, key 2: crouch_m changes by 0.45 m in 0.50 s"));
  EXPECT_THAT(fast.error().message, HasSubstr("give it 0.55 s or more"));
  EXPECT_TRUE(parsed(R"({"seconds": 0.55, "crouch_m": 0.45})"));
  EXPECT_FALSE(parsed(R"({"seconds": 1, "crouch_m": 0.45}, {"seconds": 0.3, "crouch_m": 0})"));
}

TEST(Script, OneThatEndsInTheTPoseCanBePerformedAgain) {
  const auto ends = [](const char* keys) {
    return ParseScript(R"({"keys": )" + std::string(keys) + "}", "f")->EndsInTPose();
  };
  EXPECT_TRUE(ends(R"([{"seconds": 1, "bow_deg": 30}, {"seconds": 2, "bow_deg": 0}])"));
  EXPECT_FALSE(ends(R"([{"seconds": 1}, {"seconds": 1, "both_raise_deg": -75}])"));
  for (const std::string& name : BuiltInScriptNames()) {
    EXPECT_TRUE(BuiltInScript(name)->EndsInTPose()) << name;
  }
}

TEST(Course, BlendsWithoutAJumpAndMeetsEveryKey) {
  const auto script = ParseScript(
      R"({"keys": [{"seconds": 1, "bow_deg": 30}, {"seconds": 2, "bow_deg": 0}]})", "f");
  ASSERT_TRUE(script);
  const auto course = Sample(*script, 100);
  ASSERT_EQ(course.size(), 301u);
  EXPECT_EQ(At(course[0], Channel::kBow), 0);
  EXPECT_NEAR(At(course[50], Channel::kBow), kPi / 12, 1e-12);  // Half way.
  EXPECT_NEAR(At(course[100], Channel::kBow), kPi / 6, 1e-12);
  EXPECT_NEAR(At(course[300], Channel::kBow), 0, 1e-12);
  for (std::size_t i = 1; i < course.size(); ++i)  // 1.875 is the quintic's steepest slope.
    EXPECT_LT(std::abs(At(course[i], Channel::kBow) - At(course[i - 1], Channel::kBow)),
              1.876 * kPi / 6 / 100);
}

TEST(Course, AFootThatStepsGoesUpBeforeItGoesOver) {
  const auto script = ParseScript(
      R"({"keys": [{"seconds": 1, "weight": -1}, {"seconds": 1, "left_step_m": 0.1}]})", "f");
  ASSERT_TRUE(script);
  double highest = 0;
  for (const Values& values : Sample(*script, 100)) {
    const double step = At(values, Channel::kLeftStep), lift = At(values, Channel::kLeftLift);
    highest = std::max(highest, lift);
    if (step > 0.001 && step < 0.099) {
      EXPECT_GT(lift, 0.01);
    }
    EXPECT_EQ(At(values, Channel::kRightLift), 0);
  }
  EXPECT_NEAR(highest, 0.05, 1e-6);
}

}  // namespace
}  // namespace footing::choreography
