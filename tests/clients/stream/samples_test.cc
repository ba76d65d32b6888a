#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/stream/plan.h"
#include "clients/stream/samples.h"
#include "common/base/units.h"
#include "common/virtual/motion/bvh.h"
#include "tests/common/temporary_folder.h"

namespace footing::stream_client {
namespace {

class Samples : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { files_ = SampleFiles().value(); }
  static const std::string& Text(const std::string& name) {
    const auto found = std::find_if(files_.begin(), files_.end(),
                                    [&](const SampleFile& file) { return file.name == name; });
    EXPECT_NE(found, files_.end()) << name;
    return found->text;
  }
  inline static std::vector<SampleFile> files_;
};

TEST_F(Samples, AccelerationsAreTablesOfThreeAxes) {
  for (const char* name : {"left.csv", "right.csv"}) {
    const auto table = ParseTable(Text(name), 3, name);
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_GT(table->rows.size(), 1000u);  // More than 10 s at 100 Hz.
  }
  EXPECT_NE(Text("left.csv"), Text("right.csv"));
}

TEST_F(Samples, TheCornersCarryAPersonOfSeventyKilograms) {
  const auto table = ParseTable(Text("corners.csv"), 5, "corners.csv");
  ASSERT_TRUE(table) << table.error().message;
  for (const auto& row : table->rows) {
    EXPECT_NEAR(row[1] + row[2] + row[3] + row[4], 70, 0.2);
  }
}

TEST_F(Samples, TheClipIsAMotionThatBeginsInATPose) {
  const auto motion = motion::ParseBvh(Text("clip.bvh"), "clip.bvh");
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_GT(motion->duration_s(), 10);
  EXPECT_LT(Text("clip.bvh").size(), 1u << 20);
}

TEST_F(Samples, TheImuFeelsOneGAndTurnsAsItsAttitudeSays) {
  const auto table = ParseTable(Text("imu.csv"), 11, "imu.csv");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->rows.size(), 2000u);
  double turned_rad = 0;
  for (const auto& row : table->rows) {
    EXPECT_NEAR(std::hypot(row[3], row[4], row[5]), 9.80665, 1e-4);
    EXPECT_NEAR(2 * std::atan2(row[7], row[6]), turned_rad, 0.02);
    turned_rad += row[0] / 100;
  }
}

TEST_F(Samples, TheTrainingTableHasTwentyInputsAndOneOutput) {
  const auto table = ParseTable(Text("sway.csv"), 21, "sway.csv");
  EXPECT_TRUE(table) << table.error().message;
}

TEST_F(Samples, StudyTablesHaveFifteenSubjectsWithFourInterfaces) {
  for (const char* name : {"ratings.csv", "oscillation.csv", "failures.csv"}) {
    const std::string& text = Text(name);
    EXPECT_TRUE(text.starts_with("subject,group_index,group,value\np01,0,joystick,")) << name;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 15 * 4) << name;
  }
  // Counts and ratings are whole numbers.
  EXPECT_EQ(Text("ratings.csv").find('.'), std::string::npos);
  EXPECT_EQ(Text("failures.csv").find('.'), std::string::npos);
}

TEST_F(Samples, FilesOfSomebodyElseStay) {
  const test::TemporaryFolder folder;
  const std::string own = folder.Path("p07.json");
  ASSERT_TRUE(WriteSampleFiles(folder.Path(""), false));
  ASSERT_TRUE(WriteSampleFiles(folder.Path(""), false));  // The same files may be there.
  std::filesystem::remove(folder.Path("clip.bvh"));
  std::ofstream(own) << "{\"code\": \"p07\", \"height_m\": 1.81}\n";
  const auto refused = WriteSampleFiles(folder.Path(""), false);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("p07.json"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.Path("clip.bvh")));  // Nothing was written.
  ASSERT_TRUE(WriteSampleFiles(folder.Path(""), true));
  std::ostringstream text;
  text << std::ifstream(own).rdbuf();
  EXPECT_EQ(text.str(), Text("p07.json"));
}

TEST_F(Samples, AFolderThatCannotBeMadeIsNamed) {
  const auto written = WriteSampleFiles("/proc/nowhere", false);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("/proc/nowhere"), std::string::npos);
}

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
