#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "common/runtime/log.h"

// Each test runs in a process of its own whose /run holds a journal socket of the test.
namespace footing::log {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr int kNoNamespaces = 77;  // Exit code of the child.

/// Entries at the journal's socket, one after the other, and the text on standard error.
struct Logged {
  std::string journal;
  std::string standard_error;
};

class JournalTest : public testing::Test {
 protected:
  JournalTest() {
    std::string name = testing::TempDir() + "journalXXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~JournalTest() override { std::filesystem::remove_all(folder_); }

  /// `stderr_is_journal`: whether JOURNAL_STREAM names the process's standard error.
  Logged Run(const std::function<void()>& say, bool stderr_is_journal = true) {
    const pid_t child = fork();
    if (child == 0) _exit(InChild(say, stderr_is_journal));
    int status = 0;
    waitpid(child, &status, 0);
    skipped_ = WIFEXITED(status) && WEXITSTATUS(status) == kNoNamespaces;
    EXPECT_TRUE(skipped_ || status == 0) << status;
    return {Read("journal"), Read("stderr")};
  }

  bool skipped_ = false;

 private:
  int InChild(const std::function<void()>& say, bool stderr_is_journal) {
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
      return kNoNamespaces;
    mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (mount("tmpfs", "/run", "tmpfs", 0, nullptr) != 0) return kNoNamespaces;
    std::filesystem::create_directories("/run/systemd/journal");
    const int journal = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    sockaddr_un name{AF_UNIX, "/run/systemd/journal/socket"};
    if (bind(journal, reinterpret_cast<sockaddr*>(&name), sizeof(name)) != 0) return 1;
    const int error = open((folder_ + "/stderr").c_str(), O_CREAT | O_WRONLY, 0600);
    dup2(error, STDERR_FILENO);
    struct stat own {};
    fstat(STDERR_FILENO, &own);
    const std::string inode = std::to_string(own.st_ino + (stderr_is_journal ? 0 : 1));
    setenv("JOURNAL_STREAM", (std::to_string(own.st_dev) + ":" + inode).c_str(), 1);
    say();
    std::ofstream entries(folder_ + "/journal");
    std::array<char, 4096> entry{};
    for (ssize_t size = 0; (size = recv(journal, entry.data(), entry.size(), 0)) > 0;) {
      entries.write(entry.data(), size) << "\n";
    }
    return entries.flush() ? 0 : 1;
  }

  std::string Read(const char* name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ + "/" + name).rdbuf();
    return text.str();
  }

  std::string folder_;
};

TEST_F(JournalTest, AnEntryHasItsPriorityAndItsFieldsAndNoSecondTimeStamp) {
  const Logged logged = Run([] {
    Start("footingd", false);
    Write(Level::kWarning, "device 3 (52:00) lost: it is gone", {"52:00", 0, ""});
  });
  if (skipped_) GTEST_SKIP() << "no mount namespaces here";
  EXPECT_THAT(logged.journal, StartsWith("MESSAGE=device 3 (52:00) lost: it is gone\n"));
  EXPECT_THAT(logged.journal, HasSubstr("\nPRIORITY=4\n"));
  EXPECT_THAT(logged.journal, HasSubstr("\nSYSLOG_IDENTIFIER=footingd\n"));
  EXPECT_THAT(logged.journal, HasSubstr("\nFOOTING_DEVICE=52:00\n"));
  EXPECT_THAT(logged.journal, Not(HasSubstr("FOOTING_SESSION")));
  EXPECT_THAT(logged.standard_error, IsEmpty());
}

TEST_F(JournalTest, EachLevelHasItsPriority) {
  const Logged logged = Run([] {
    Start("footingd", false);
    Info("a");
    Write(Level::kWarning, "b", {"", 7, "raw"});
    Error("c");
  });
  if (skipped_) GTEST_SKIP() << "no mount namespaces here";
  EXPECT_THAT(logged.journal, HasSubstr("MESSAGE=a\nPRIORITY=6\n"));
  EXPECT_THAT(logged.journal, HasSubstr("MESSAGE=b\nPRIORITY=4\n"));
  EXPECT_THAT(logged.journal, HasSubstr("\nFOOTING_SESSION=7\nFOOTING_CHANNEL=raw\n"));
  EXPECT_THAT(logged.journal, HasSubstr("MESSAGE=c\nPRIORITY=3\n"));
}

TEST_F(JournalTest, QuietKeepsWarningsOnly) {
  const Logged logged = Run([] {
    Start("footingd", true);
    Info("a");
    Warning("b");
  });
  if (skipped_) GTEST_SKIP() << "no mount namespaces here";
  EXPECT_THAT(logged.journal, Not(HasSubstr("MESSAGE=a")));
  EXPECT_THAT(logged.journal, HasSubstr("MESSAGE=b"));
}

TEST_F(JournalTest, StandardErrorThatIsNotTheJournalGetsTheLine) {
  const Logged logged = Run(
      [] {
        Start("footingd", false);
        Write(Level::kWarning, "a", {"52:00", 0, ""});
      },
      false);
  if (skipped_) GTEST_SKIP() << "no mount namespaces here";
  EXPECT_THAT(logged.journal, IsEmpty());
  EXPECT_THAT(logged.standard_error, HasSubstr("footingd warning: a\n"));
}

TEST_F(JournalTest, WithoutAJournalStandardErrorGetsTheLine) {
  const Logged logged = Run([] {
    std::filesystem::remove("/run/systemd/journal/socket");
    Start("footingd", false);
    Error("a");
  });
  if (skipped_) GTEST_SKIP() << "no mount namespaces here";
  EXPECT_THAT(logged.standard_error, HasSubstr("footingd error: a\n"));
}

}  // namespace
}  // namespace footing::log
