#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "tests/common/temporary_folder.h"
#include "tests/recordings/devices/replay.h"

namespace footing::recordings {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(FOOTING_SOURCE_DIR) / "tests/recordings/devices";

/// Names of all captures here, without ".report": adding a device is adding a file.
std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".report") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class DeviceRecording : public testing::TestWithParam<std::string> {
 protected:
  std::filesystem::path report() const { return kFolder / (GetParam() + ".report"); }
  std::filesystem::path expected() const { return kFolder / (GetParam() + ".expected"); }
};

TEST_P(DeviceRecording, SaysWhatItIs) {
  const auto capture = ReadCapture(report());
  ASSERT_TRUE(capture) << capture.error().message;
  for (const char* key : {"Device", "Identity", "Firmware", "Motion", "Date", "Made"}) {
    EXPECT_NE(capture.value().Header(key), "") << key;
  }
  EXPECT_FALSE(capture.value().reports.empty());
}

TEST_P(DeviceRecording, IsPublishedAsExpected) {
  const auto capture = ReadCapture(report());
  ASSERT_TRUE(capture) << capture.error().message;
  const auto content = Replay(capture.value());
  ASSERT_TRUE(content) << content.error().message;
  const std::string expected_text = TextOf(expected());
  ASSERT_NE(expected_text, "") << "write it with build/release/tests/write_device_recordings "
                                  "--expected, and read it before it is committed";
  std::istringstream expected_lines(expected_text);
  std::istringstream got_lines(Print(content.value()));
  std::string expected_line;
  std::string got_line;
  int number = 0;
  int differ = 0;
  while (std::getline(expected_lines, expected_line)) {
    ++number;
    ASSERT_TRUE(std::getline(got_lines, got_line)) << "ends before line " << number;
    if (got_line == expected_line) continue;
    ADD_FAILURE() << expected().string() << ":" << number << "\n  expected " << expected_line
                  << "\n  got      " << got_line;
    ASSERT_LT(++differ, 5) << "and so on";
  }
  EXPECT_FALSE(std::getline(got_lines, got_line)) << "more than expected: " << got_line;
}

INSTANTIATE_TEST_SUITE_P(Of, DeviceRecording, testing::ValuesIn(Names()), [](const auto& made) {
  std::string name = made.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(Capture, ReadsWhatItPrints) {
  for (const std::string& name : Names()) {
    const auto path = kFolder / (name + ".report");
    const auto capture = ReadCapture(path);
    ASSERT_TRUE(capture);
    EXPECT_EQ(Print(capture.value()), TextOf(path)) << name;
  }
}

TEST(Capture, ABadLineIsNamed) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("bad.report");
  for (const char* bad :
       {"1.0 < 12 34", "1.0 < 123", "1.0 < xy", "1.0 ! 12", "one < 12", "1.0 < 12\n0.5 < 12"}) {
    std::ofstream(path) << "# Device: x\n" << bad << "\n";
    const auto capture = ReadCapture(path);
    ASSERT_FALSE(capture) << bad;
    EXPECT_NE(capture.error().message.find("bad.report:"), std::string::npos);
  }
}

}  // namespace
}  // namespace footing::recordings
