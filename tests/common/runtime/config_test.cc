#include "common/runtime/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/runtime/files.h"
#include "tests/common/temporary_folder.h"

namespace footing::config {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Example {
  double rate_hz = 100;
  std::int64_t sessions = 16;
  bool quiet = false;
  std::string rig = "one";
  std::vector<std::string> listen;

  void Bind(Binder& binder) {
    binder.Number("rate_hz", rate_hz, 1, 1000, "Ticks a second");
    binder.Integer("sessions", sessions, 1, 256, "Most sessions at a time");
    binder.Flag("quiet", quiet, "Only warnings");
    binder.Text("rig", rig, "Name of the rig");
    binder.TextList("listen", listen, "Addresses");
  }
};

TEST(Config, ANumberBeyondAllTypesIsOneLineToo) {
  Example example;
  Binder binder;
  example.Bind(binder);
  const auto applied = binder.ApplyText(R"({"rate_hz": 1e999})", "file");
  ASSERT_FALSE(applied.ok());
  EXPECT_THAT(applied.error().message, HasSubstr("config: file is not JSON: "));
  EXPECT_THAT(applied.error().message, Not(HasSubstr("json.exception")));
  EXPECT_FALSE(binder.ApplySetting("rate_hz=1e999"));
}

TEST(Config, ASettingThatIsNotUtf8IsOneLineToo) {
  Example example;
  Binder binder;
  example.Bind(binder);
  for (const std::string key : {"rate_hz", "rig"}) {
    const auto applied = binder.ApplySetting(key + "=\xf3");
    ASSERT_FALSE(applied.ok());
    EXPECT_THAT(applied.error().message, HasSubstr("--set " + key + ": its value is not text in"));
  }
  EXPECT_EQ(nlohmann::json::parse(binder.Print())["rig"], "one");
}

TEST(Config, DefaultsYieldToTheFileAndTheFileToSettings) {
  Example example;
  Binder binder;
  example.Bind(binder);
  ASSERT_TRUE(binder.ApplyText(R"({"rate_hz": 50, "rig": "two"} // comment)", "file"));
  ASSERT_TRUE(binder.ApplySetting("rate_hz=60"));
  ASSERT_TRUE(binder.ApplySetting(R"(listen=["unix:a"])"));
  EXPECT_EQ(example.rate_hz, 60);
  EXPECT_EQ(example.rig, "two");
  EXPECT_EQ(example.sessions, 16);
  EXPECT_THAT(example.listen, testing::ElementsAre("unix:a"));
}

TEST(Config, AnUnknownKeyIsNamedWithItsFile) {
  Example example;
  Binder binder;
  example.Bind(binder);
  const auto result = binder.ApplyText(R"({"rate": 50})", "footing.json");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(result.error().message, HasSubstr("unknown key \"rate\" in footing.json"));
}

TEST(Config, AWrongTypeOrRangeSaysWhatIsAllowed) {
  Example example;
  Binder binder;
  example.Bind(binder);
  for (const char* text : {R"({"rate_hz": 0})", R"({"rate_hz": "x"})", R"({"rate_hz": 1e9})"}) {
    const auto result = binder.ApplyText(text, "f");
    ASSERT_FALSE(result) << text;
    EXPECT_THAT(result.error().message, HasSubstr("a number from 1 to 1000"));
  }
  EXPECT_FALSE(binder.ApplyText(R"({"sessions": 1.5})", "f"));
  EXPECT_FALSE(binder.ApplyText(R"({"quiet": 1})", "f"));
  EXPECT_FALSE(binder.ApplyText(R"({"listen": [1]})", "f"));
  EXPECT_EQ(example.rate_hz, 100);
}

TEST(Config, AWrongValueOfAnObjectIsNamedWithItsReason) {
  std::map<std::string, std::string> roles;
  Binder binder;
  binder.TextMap("roles", roles, "Role of each serial", [](const std::string& text) {
    return text == "nose" ? std::string("role nose does not exist") : std::string();
  });
  EXPECT_EQ(binder.ApplySetting(R"(roles={"a": "head", "b": "nose"})").error().message,
            "config: roles in --set: 'b': role nose does not exist");
  EXPECT_THAT(binder.ApplySetting(R"(roles={"a": 1})").error().message,
              HasSubstr("it must be an object of strings"));
  EXPECT_TRUE(roles.empty());
  EXPECT_TRUE(binder.ApplySetting(R"(roles={"a": "head"})"));
  EXPECT_EQ(roles.at("a"), "head");
}

TEST(Config, TextThatIsNoObjectIsRefusedInOneLine) {
  Example example;
  Binder binder;
  example.Bind(binder);
  for (const char* text : {"", "[]", "{", "nonsense", "{\"rate_hz\": }"}) {
    const auto result = binder.ApplyText(text, "f");
    ASSERT_FALSE(result) << text;
    EXPECT_THAT(result.error().message, testing::Not(HasSubstr("\n"))) << text;
  }
}

TEST(Config, ATextKeyTakesPlainWordsFromTheCommandLine) {
  Example example;
  Binder binder;
  example.Bind(binder);
  ASSERT_TRUE(binder.ApplySetting("rig=7"));
  EXPECT_EQ(example.rig, "7");
  EXPECT_FALSE(binder.ApplySetting("rig"));
  EXPECT_FALSE(binder.ApplySetting("=7"));
}

TEST(Config, WhatIsPrintedCanBeReadBack) {
  Example example;
  Binder binder;
  example.Bind(binder);
  ASSERT_TRUE(binder.ApplySetting("rate_hz=12.5"));
  const std::string printed = binder.Print();
  Example other;
  Binder again;
  other.Bind(again);
  ASSERT_TRUE(again.ApplyText(printed, "printed"));
  EXPECT_EQ(other.rate_hz, 12.5);
}

TEST(DataFile, ThatIsNowhereNamesThePlaces) {
  const auto result = FindDataFile("none.json", "/nonexistent");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("/nonexistent"));
}

TEST(DataFile, AnUnknownNameListsTheBuiltInOnes) {
  const auto result = ReadNamedOrPath("9", "tracks");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(result.error().message, HasSubstr("tracks/9.json"));
  EXPECT_THAT(
      result.error().message,
      HasSubstr(
          "there are: 1, 2, 3, 4, build, corners, curves, endless, hills, pits, plain, straight"));
  EXPECT_TRUE(ReadNamedOrPath("straight", "tracks"));
}

TEST(DataFile, AFileOfAnyEndingIsReadUnlessItsNameIsBuiltIn) {
  const test::TemporaryFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.Path("."));
  for (const char* const name : {"track.txt", "straight"}) std::ofstream(name) << "hello";
  const auto named = ReadNamedOrPath("track.txt", "tracks");
  const auto built_in = ReadNamedOrPath("straight", "tracks");
  std::filesystem::current_path(before);
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(*named, "hello");
  ASSERT_TRUE(built_in) << built_in.error().message;
  EXPECT_NE(*built_in, "hello");
}

TEST(DataFile, WhatIsNotARegularFileIsRefusedAtOnce) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder.Path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& [path, kind] : {std::pair<std::string, std::string>{pipe, "a pipe"},
                                   {folder.Path("."), "a folder"},
                                   {"/dev/null", "a device"}}) {
    const auto read = ReadTextFile(path);  // On the pipe it would wait for a writer.
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().message,
              "cannot open " + path + ": it is " + kind + ", not a regular file");
  }
  const auto missing = ReadTextFile(folder.Path("none"));
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("No such file or directory"));
  Binder binder;
  EXPECT_THAT(binder.ApplyFile(pipe).error().message, HasSubstr("it is a pipe"));
}

TEST(DataFile, IsReadToItsEndOrRefusedIfItIsTooLong) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("text"), text(100'000, 'x');
  std::ofstream(path) << text;
  EXPECT_EQ(ReadTextFile(path).value(), text);
  const auto refused = ReadTextFile(path, 99'999);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  // Its size and the limit, in one unit and never the same number, and what to do.
  EXPECT_THAT(refused.error().message,
              HasSubstr("text is too large: it has 0.100000 MB, and at most 0.099999 MB are read; "
                        "check that this is the right file, or shorten or split it"));
  EXPECT_TRUE(ReadTextFile(path, 100'000));
  std::ofstream(path) << std::string(7'074'956, 'x');
  EXPECT_THAT(ReadTextFile(path).error().message,
              HasSubstr("it has 7.1 MB, and at most 4.2 MB are read"));
}

TEST(Config, EachValueKnowsWhereItComesFrom) {
  Example example;
  Binder binder;
  example.Bind(binder);
  const char* file =
      "// comment\n{\n\n  \"rate_hz\": 50, \"sessions\": 3,\n  /* two\n lines */ "
      "\"listen\":\n[\"unix:a\"]}";
  ASSERT_TRUE(binder.ApplyText(file, "/etc/f.json"));
  ASSERT_TRUE(binder.ApplySetting("sessions=4"));
  ASSERT_TRUE(binder.ApplySetting(R"(listen=["unix:b"])", "--listen"));
  const auto shown = nlohmann::json::parse(binder.PrintOrigins());
  EXPECT_EQ(shown["rate_hz"], (nlohmann::json{{"value", 50}, {"origin", "/etc/f.json:4"}}));
  EXPECT_EQ(shown["sessions"], (nlohmann::json{{"value", 4}, {"origin", "--set"}}));
  EXPECT_EQ(shown["quiet"], (nlohmann::json{{"value", false}, {"origin", "default"}}));
  EXPECT_EQ(shown["listen"]["origin"], "--listen");
  EXPECT_EQ(LinesOfKeys(file).at("listen"), 6);
  EXPECT_EQ(shown.size(), 5u);
}

TEST(Config, LinesAreThoseOfTheOutermostKeys) {
  const auto lines = LinesOfKeys("{\"a\": {\n\"b\": [{\"c\": 1}]},\n\"d\": 1");
  EXPECT_EQ(lines, (std::map<std::string, int>{{"a", 1}, {"d", 3}}));
}

TEST(Config, DifferencesNameTheKeysThatChanged) {
  Example before, after;
  Binder old_binder, new_binder;
  before.Bind(old_binder);
  after.Bind(new_binder);
  EXPECT_TRUE(Differences(old_binder, new_binder).empty());
  ASSERT_TRUE(new_binder.ApplyText(R"({"rate_hz": 50, "rig": "two"})", "f"));
  const auto changes = Differences(old_binder, new_binder);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].key, "rate_hz");
  EXPECT_EQ(changes[0].before, "100.0");
  EXPECT_EQ(changes[0].after, "50.0");
  EXPECT_EQ(changes[1].after, "\"two\"");
}

}  // namespace
}  // namespace footing::config
