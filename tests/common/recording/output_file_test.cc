#include "common/recording/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

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

std::string Contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(OutputFile, KeepsAnExistingFileUntilTheFirstWrite) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("table");
  std::ofstream(path) << "an old table";
  {
    const auto unused = OutputFile::Create(path, true);
    ASSERT_TRUE(unused);
  }
  EXPECT_EQ(Contents(path), "an old table");
  auto file = OutputFile::Create(path, true);
  ASSERT_TRUE(file);
  EXPECT_EQ(Contents(path), "an old table");
  ASSERT_TRUE(file->Write("new"));
  ASSERT_TRUE(file->Write(" one"));
  EXPECT_EQ(Contents(path), "new one");
}

TEST(OutputFile, LeavesNothingWhereNothingWasWritten) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("table");
  {
    auto file = OutputFile::Create(path, false);
    ASSERT_TRUE(file);
    const OutputFile moved = std::move(*file);
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(OutputFile::Create(path, false)->Write(""));
  EXPECT_TRUE(std::filesystem::exists(path)) << "an empty file was asked for";
}

TEST(OutputFile, LeavesNothingWhereNoByteCouldBeWritten) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("table");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &none), 0);
  {
    auto file = OutputFile::Create(path, false);
    EXPECT_FALSE(file->Write("x"));
    EXPECT_TRUE(file->empty());
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
}

TEST(OutputFile, LeavesAloneWhatTookItsPlace) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("table");
  {
    const auto file = OutputFile::Create(path, false);
    ASSERT_TRUE(file);
    std::filesystem::remove(path);
    std::ofstream(path) << "another's";
  }
  EXPECT_EQ(Contents(path), "another's");
}

}  // namespace
}  // namespace footing::recording
