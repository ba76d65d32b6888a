#include "common/runtime/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/common/temporary_folder.h"

namespace footing::config {
namespace {

std::string ContentOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

mode_t ModeOf(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 0777u;
}

TEST(ReadTextFile, AFolderIsNoFile) {
  const test::TemporaryFolder folder;
  const auto text = ReadTextFile(folder.Path(""), 100);
  ASSERT_FALSE(text.ok());
  EXPECT_NE(text.error().message.find("not a regular file"), std::string::npos)
      << text.error().message;
}

TEST(WriteFile, ANewFileIsForItsOwnerAlone) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(ReplaceFile(folder.Path("new"), "one").ok());
  EXPECT_EQ(ContentOf(folder.Path("new")), "one");
  EXPECT_EQ(ModeOf(folder.Path("new")), 0600u);
}

TEST(WriteFile, AReplacedFileKeepsItsModeAndItsLink) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("file"), link = folder.Path("link");
  std::ofstream(path) << "one";
  ASSERT_EQ(chmod(path.c_str(), 0664), 0);
  std::filesystem::create_symlink(path, link);
  std::ofstream(path + ".new") << "half of what was";
  ASSERT_TRUE(ReplaceFile(link, "two").ok());
  EXPECT_EQ(ContentOf(path), "two");
  EXPECT_EQ(ModeOf(path), 0664u);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
}

TEST(WriteFile, AFailureGivesTheReasonAndLeavesTheOldContent) {
  const test::TemporaryFolder folder;
  const auto missing = ReplaceFile(folder.Path("none/file"), "two");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().message, "No such file or directory");
  std::filesystem::create_directory(folder.Path("folder"));
  const auto is_folder = ReplaceFile(folder.Path("folder"), "two");
  ASSERT_FALSE(is_folder.ok());
  EXPECT_EQ(is_folder.error().message, "Is a directory");
  EXPECT_FALSE(std::filesystem::exists(folder.Path("folder.new")));
}

TEST(WriteFile, FoldersAboveAreMadeAndAnErrorNamesTheFolder) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(MakeFoldersAbove(folder.Path("a/b/file")).ok());
  EXPECT_TRUE(std::filesystem::is_directory(folder.Path("a/b")));
  EXPECT_FALSE(std::filesystem::exists(folder.Path("a/b/file")));
  EXPECT_EQ(ModeOf(folder.Path("a")), 0700u);
  std::ofstream(folder.Path("file")) << "in the way";
  const auto refused = MakeFoldersAbove(folder.Path("file/file"));
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find(folder.Path("file") + ": "), std::string::npos);
}

}  // namespace
}  // namespace footing::config
