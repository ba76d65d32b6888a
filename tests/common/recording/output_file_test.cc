#include "common/recording/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/common/temporary_folder.h"

namespace footing::recording {
namespace {

using testing::HasSubstr;

TEST(CheckCreatable, LeavesNoFileBehindAndKeepsOneThatIsThere) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("model");
  EXPECT_TRUE(CheckCreatable(path, false));
  EXPECT_FALSE(std::filesystem::exists(path));
  std::ofstream(path) << "old";
  EXPECT_TRUE(CheckCreatable(path, true));
  EXPECT_EQ(std::filesystem::file_size(path), 3u);
}

TEST(CheckCreatable, SaysWhatCreateWouldSay) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("model");
  std::ofstream(path) << "old";
  EXPECT_EQ(CheckCreatable(path, false).error().message,
            OutputFile::Create(path, false).error().message);
  EXPECT_EQ(CheckCreatable(path, false).error().kind, ErrorKind::kUsage);
  const auto nowhere = CheckCreatable(folder.Path("none/model"), true);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::kFailure);
  EXPECT_THAT(nowhere.error().message,
              HasSubstr("No such file or directory; make its folder first: mkdir -p " +
                        folder.Path("none")));
}

}  // namespace
}  // namespace footing::recording
