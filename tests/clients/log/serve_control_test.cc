#include "clients/log/serve_control.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/common/temporary_folder.h"

namespace footing::log_client {
namespace {

using ::testing::HasSubstr;

class RecordingNameTest : public testing::Test {
 protected:
  std::string Relative() const { return std::filesystem::relative(name_.Path(), root_).string(); }
  std::string Why(const std::string& options) {
    const std::filesystem::path before = name_.Path();
    const auto set = name_.Set(options);
    EXPECT_FALSE(set.ok()) << options;
    EXPECT_EQ(name_.Path(), before);
    return set ? "" : set.error().message;
  }
  void Make(const std::string& name) {
    std::filesystem::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << "x";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path root_ = std::filesystem::canonical(folder_.Path("."));
  RecordingName name_{root_};
};

TEST_F(RecordingNameTest, TheDefaultIsThatOfLabRecordersBidsNames) {
  EXPECT_EQ(Relative(),
            "sub-P001/ses-S001/motion/sub-P001_ses-S001_task-Default_run-001_motion.mcap");
  ASSERT_TRUE(name_.Set(
      "{participant:P07} {session:2}{task:sway} {acquisition:firm} {modality:eeg} {run:12}"));
  EXPECT_EQ(Relative(), "sub-P07/ses-2/eeg/sub-P07_ses-2_task-sway_acq-firm_run-012_eeg.mcap");
}

TEST_F(RecordingNameTest, ATemplateHasLabRecordersPlaceholdersAndItsWindowsForm) {
  ASSERT_TRUE(name_.Set(
      "{template:exp%n\\%p_block_%b.xdf} {run:2} {participant:P003} {task:MemoryGuided}"));
  EXPECT_EQ(Relative(), "exp002/P003_block_MemoryGuided.mcap");
  ASSERT_TRUE(name_.Set("{root:sub/folder} {template:%p}"));
  EXPECT_EQ(Relative(), "sub/folder/P003.mcap");
}

TEST_F(RecordingNameTest, WithoutARunItIsTheFirstThatHasNoFile) {
  ASSERT_TRUE(name_.Set("{template:%p_%r.mcap}"));
  Make("P001_001.mcap");
  Make("P001_002.mcap");
  EXPECT_EQ(Relative(), "P001_003.mcap");
  ASSERT_TRUE(name_.Set("{run:1}"));
  EXPECT_EQ(Relative(), "P001_001.mcap");
}

TEST_F(RecordingNameTest, WhatLeadsOutOfTheRootOrIsNoOptionChangesNothing) {
  EXPECT_THAT(Why("{root:/etc}"), HasSubstr("is not within"));
  EXPECT_THAT(Why("{root:..}"), HasSubstr("is not within"));
  std::filesystem::create_directory_symlink("/", root_ / "link");
  EXPECT_THAT(Why("{root:link}"), HasSubstr("is not within"));
  EXPECT_THAT(Why("{root:C:\\Data\\}"), HasSubstr("folder of Windows"));
  EXPECT_THAT(Why("{template:/tmp/a.mcap}"), HasSubstr("below the root"));
  EXPECT_THAT(Why("{template:../a.mcap}"), HasSubstr("leads out"));
  EXPECT_THAT(Why("{participant:..}"), HasSubstr("leads out"));
  EXPECT_THAT(Why("{participant:../../a}"), HasSubstr("leads out"));
  EXPECT_THAT(Why("{participant:a/b}"), HasSubstr("may not have a /"));
  EXPECT_THAT(Why("{run:two}"), HasSubstr("is not a number"));
  EXPECT_THAT(Why("{subject:1}"), HasSubstr("unknown option subject; there are: root"));
  EXPECT_THAT(Why("{participant:P9} {template:s_%p.xdf {modality:eeg}"),
              HasSubstr("closing brace"));
  EXPECT_THAT(Why("participant P01"), HasSubstr("{option:value}"));
  EXPECT_THAT(Why("{task:" + std::string(300, 'a') + "}"), HasSubstr("at most 200 bytes"));
}

TEST(MarkerLine, OptionsAreAtTheEndAndOtherBracesAreText) {
  const auto plain = ParseMarker("stimulus on");
  ASSERT_TRUE(plain.ok());
  EXPECT_EQ(plain->text, "stimulus on");
  EXPECT_FALSE(plain->value || plain->time_ns);
  const auto both = ParseMarker("go {time_ns:123} {value:-2.5}");
  ASSERT_TRUE(both.ok());
  EXPECT_EQ(both->text, "go");
  EXPECT_EQ(both->value, -2.5);
  EXPECT_EQ(both->time_ns, 123);
  EXPECT_EQ(ParseMarker("{\"trial\": 3}")->text, "{\"trial\": 3}");
  for (const char* bad : {"go {value:x}", "go {value:inf}", "go {time_ns:1.5}", "", "{value:3}"}) {
    EXPECT_FALSE(ParseMarker(bad).ok()) << bad;
  }
}

TEST(LineReader, ALineThatIsTooLongIsDroppedAndTheNextOneIsRead) {
  LineReader reader;
  std::vector<std::optional<std::string>> lines;
  const auto keep = [&lines](std::optional<std::string> line) { lines.push_back(std::move(line)); };
  reader.Take("start\r\nmark", keep);
  reader.Take(" a \n", keep);
  for (int i = 0; i < 256; ++i) reader.Take(std::string(4096, 'x'), keep);  // 1 MiB.
  reader.Take("\nstop", keep);
  reader.Finish(keep);
  EXPECT_THAT(lines, testing::ElementsAre("start", "mark a", std::nullopt, "stop"));
}

}  // namespace
}  // namespace footing::log_client
