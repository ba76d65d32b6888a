#include "clients/stream/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

using testing::HasSubstr;

TEST(Script, EveryCarriedNameIsAScriptWithAnEnd) {
  for (const std::string& name : ScriptNames()) {
    const auto script = ScriptNamed(name);
    ASSERT_TRUE(script) << name;
    EXPECT_FALSE(script->empty()) << name;
  }
}

TEST(Script, AnUnknownNameListsWhatThereIs) {
  const auto script = ScriptNamed("dance");
  ASSERT_FALSE(script);
  EXPECT_EQ(script.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(script.error().message, HasSubstr("demo"));
}

TEST(Script, DegreesOfTheFileBecomeRadians) {
  const auto script = ParseScript(
      R"([{"duration_s": 2, "frequency_hz": 3, "phase_deg": 180, "amplitude_mps2": 5, "roll_deg": 9}])",
      "file");
  ASSERT_TRUE(script);
  EXPECT_DOUBLE_EQ(script->at(0).phase_rad, kPi);
  EXPECT_DOUBLE_EQ(script->at(0).roll_rad, kPi / 20);
  EXPECT_DOUBLE_EQ(script->at(0).frequency_hz, 3);
}

TEST(Script, WhatIsWrongIsNamedWithItsStretch) {
  const char* const kWrong[] = {R"([{"duration_s": 1}, {}])", R"([{"duration_s": 1}, 7])",
                                R"([{"duration_s": 1}, {"duration_s": 0}])",
                                R"([{"duration_s": 1}, {"duration_s": "x"}])",
                                R"([{"duration_s": 1}, {"duration_s": 1, "speed": 1}])"};
  for (const char* text : kWrong) {
    const auto script = ParseScript(text, "file");
    ASSERT_FALSE(script) << text;
    EXPECT_EQ(script.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(script.error().message, HasSubstr("stretch 2")) << text;
  }
  for (const char* text : {"", "{}", "[]", "null", "[1"}) {
    EXPECT_FALSE(ParseScript(text, "file")) << text;
  }
}

}  // namespace
}  // namespace footing::stream_client
