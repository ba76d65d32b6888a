#include "daemon/sensor/service/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/common/temporary_folder.h"

namespace footing::sensor {
namespace {

using testing::HasSubstr;

struct Parsed {
  bool starts = false;
  int exit_code = 0;
  std::string errors;
};

Parsed Parse(std::vector<std::string> words) {
  words.insert(words.begin(), "footingd");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  Parsed parsed;
  testing::internal::CaptureStderr();
  parsed.starts =
      ParseCommandLine(static_cast<int>(arguments.size()), arguments.data(), parsed.exit_code)
          .has_value();
  parsed.errors = testing::internal::GetCapturedStderr();
  return parsed;
}

TEST(CommandLine, CheckConfigReadsTheFilesAndEndsAsTheStartWould) {
  const test::TemporaryFolder folder;
  const std::string none = folder.Path("none");
  EXPECT_EQ(Parse({"--check-config"}).exit_code, 0);
  for (const std::string key : {"token_file", "clients_file"}) {
    const Parsed parsed = Parse({"--check-config", "--set", key + "=" + none});
    EXPECT_EQ(parsed.exit_code, 1);
    EXPECT_THAT(parsed.errors, HasSubstr(none));
  }
  const Parsed metrics = Parse({"--check-config", "--metrics", "tcp:0.0.0.0:9100"});
  EXPECT_EQ(metrics.exit_code, 2);
  EXPECT_THAT(metrics.errors, HasSubstr("they stay on this host"));
}

TEST(CommandLine, OriginNeedsPrintConfig) {
  const Parsed parsed = Parse({"--origin"});
  EXPECT_FALSE(parsed.starts);
  EXPECT_EQ(parsed.exit_code, 2);
  EXPECT_THAT(parsed.errors, HasSubstr("--print-config"));
  EXPECT_TRUE(Parse({}).starts);
}

TEST(CommandLine, AWrongRoleOrRigIsNamed) {
  EXPECT_THAT(
      Parse({"--set", R"(roles={"x": "main/nose"})"}).errors,
      HasSubstr("config: roles in --set: 'x': role 'nose' does not exist; there are left_"));
  EXPECT_THAT(Parse({"--set", "roles={\"x\": \"" + std::string(65, 'r') + "/head\"}"}).errors,
              HasSubstr("must be 1 to 64 bytes"));
  EXPECT_THAT(Parse({"--set", "default_rig=" + std::string(65, 'r')}).errors,
              HasSubstr("default_rig: the rig's name"));
}

TEST(CommandLine, ReadAgainAnErrorIsReturnedAndNothingIsPrinted) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Path("footingd.json");
  std::ofstream(file) << R"({"stale_after_s": 2})";
  std::string words[] = {"footingd", "--config", file};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data()};
  EXPECT_EQ(ReadConfigAgain(3, arguments)->stale_after_s, 2);
  std::ofstream(file) << R"({"stale_afer_s": 3})";
  testing::internal::CaptureStderr();
  const auto again = ReadConfigAgain(3, arguments);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("unknown key \"stale_afer_s\""));
}

}  // namespace
}  // namespace footing::sensor
