#include "clients/study/session/journal.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/common/temporary_folder.h"

namespace footing::study::journal {
namespace {

using nlohmann::ordered_json;
using records::EventKind;
using testing::HasSubstr;

TEST(Journal, IsNeverOverwritten) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(Journal::Create(folder.Path("j")));
  const auto again = Journal::Create(folder.Path("j"));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kUsage);
}

TEST(Journal, IsReadableByItsOwnerAlone) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(Journal::Create(folder.Path("j")));
  struct stat file {};
  ASSERT_EQ(stat(folder.Path("j").c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0600u);
}

TEST(Journal, GoesOnBehindItsLastWholeLine) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("j");
  {
    auto journal = Journal::Create(path);
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal->Append(EventKind::kSessionStarted, {{"participant", "P1"}}));
    ASSERT_TRUE(journal->Append(EventKind::kNote, {{"text", "a"}}));
  }
  std::ofstream(path, std::ios::app) << R"({"number": 3, "wall_n)";
  auto journal = Journal::Resume(path);
  ASSERT_TRUE(journal) << journal.error().message;
  EXPECT_EQ(journal->torn_bytes(), 21u);
  EXPECT_EQ(journal->events().size(), 2u);
  ASSERT_TRUE(journal->Append(EventKind::kNote, {{"text", "b"}}));
  const auto read = ReadJournal(path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->events.size(), 3u);
  EXPECT_EQ(read->events[2].Text("text"), "b");
  EXPECT_EQ(read->torn_bytes, 0u);
}

TEST(Journal, KeepsWhatWasAppendedBeforeAKill) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("j");
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();
  if (child == 0) {  // Appends and reports each append until it is killed.
    auto journal = Journal::Create(path);
    for (char i = 1; journal && journal->Append(EventKind::kNote, {{"i", i}}); ++i) {
      if (write(pipe_ends[1], &i, 1) != 1) break;
    }
    _exit(1);
  }
  char reported = 0;
  while (reported < 20 && read(pipe_ends[0], &reported, 1) == 1) {
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
  ASSERT_EQ(reported, 20);
  const auto journal = Journal::Resume(path);
  ASSERT_TRUE(journal) << journal.error().message;
  EXPECT_GE(journal->events().size(), 20u);
}

/// In a process of its own: the limit and the signal are those of a process.
TEST(Journal, StaysReadableWhenTheDiskRefusesPartOfALine) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("j");
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    auto journal = Journal::Create(path);
    bool as_expected = journal && journal->Append(EventKind::kNote, {{"text", "whole"}});
    const rlimit little{200, RLIM_INFINITY};  // Less than the first line and the next one.
    as_expected = as_expected && setrlimit(RLIMIT_FSIZE, &little) == 0;
    const ordered_json large = {{"text", std::string(300, 'x')}};
    as_expected = as_expected && !journal->Append(EventKind::kNote, large);
    const rlimit enough{RLIM_INFINITY, RLIM_INFINITY};
    as_expected = as_expected && setrlimit(RLIMIT_FSIZE, &enough) == 0;
    // The disk is there again, but what was refused is missing: nothing may follow it.
    as_expected = as_expected && !journal->Append(EventKind::kNote, {{"text", "late"}});
    _exit(as_expected ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  const auto read = ReadJournal(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->torn_bytes, 0u);
  ASSERT_EQ(read->events.size(), 1u);
  EXPECT_EQ(read->events[0].Text("text"), "whole");
  auto again = Journal::Resume(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(again->Append(EventKind::kNote, {{"text", "after"}}));
}

TEST(StudyLock, NamesItsHolderAndEndsWithIt) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("lock");
  {
    const auto held = Lock::Take(path, "the study", "anna, footing-study 4711, participant P3");
    ASSERT_TRUE(held);
    const auto second = Lock::Take(path, "the study", "ben");
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message,
                HasSubstr("the study is in use by anna, footing-study 4711, participant P3"));
  }
  EXPECT_TRUE(Lock::Take(path, "the study", "ben"));
}

TEST(DiskSpace, IsRequiredWithTheNeedStated) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(RequireSpace(folder.Path(""), 0));
  const auto refused = RequireSpace(folder.Path(""), 1e12);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("needs 1000000000000 MB"));
  EXPECT_FALSE(RequireSpace(folder.Path("missing"), 0));
}

TEST(StudyFolder, StandsBesideTheProtocol) {
  EXPECT_EQ(FolderOf("a/b.json"), "a/b.study");
  EXPECT_EQ(FolderOf("a/b"), "a/b.study");
  EXPECT_EQ(JournalPath("b.study", "P1"), "b.study/P1/journal.jsonl");
}

TEST(Journal, IsOfTheParticipantOfItsFolder) {
  const test::TemporaryFolder folder;
  auto journal = Journal::Create(folder.Path("j"));
  ASSERT_TRUE(journal);
  EXPECT_TRUE(RequireParticipant(journal->events(), "P1", "j"));
  ASSERT_TRUE(journal->Append(EventKind::kSessionStarted, {{"participant", "P1"}}));
  EXPECT_TRUE(RequireParticipant(journal->events(), "P1", "j"));
  const auto other = RequireParticipant(journal->events(), "P2", "j");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("j is the journal of participant P1, not of P2"));
}

TEST(StudyFolder, NamesThoseWithAJournal) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(MakeFolder(folder.Path("P2")));
  ASSERT_TRUE(MakeFolder(folder.Path("P1")));
  ASSERT_TRUE(MakeFolder(folder.Path("empty")));
  for (const char* code : {"P2", "P1"}) {
    ASSERT_TRUE(Journal::Create(JournalPath(folder.Path(""), code)));
  }
  EXPECT_THAT(Participants(folder.Path("")), testing::ElementsAre("P1", "P2"));
}

TEST(StudyFolder, OfAPersonIsNotOneForSimulatedSessions) {
  const test::TemporaryFolder folder;
  const std::string study = folder.Path("s");
  ASSERT_TRUE(MakeFolder(study));
  EXPECT_TRUE(RequireNoPerson(study));
  for (const char* code : {"P1", "P2", "P3"}) {
    ASSERT_TRUE(MakeFolder(ParticipantFolder(study, code)));
  }
  // A session that ended before its first event had no person in it.
  ASSERT_TRUE(Journal::Create(JournalPath(study, "P3")));
  auto simulated = Journal::Create(JournalPath(study, "P1"));
  ASSERT_TRUE(simulated && simulated->Append(EventKind::kSessionStarted,
                                             {{"participant", "P1"}, {"synthetic", true}}));
  EXPECT_TRUE(RequireNoPerson(study));
  auto other = Journal::Create(JournalPath(study, "P2"));
  ASSERT_TRUE(other && other->Append(EventKind::kSessionStarted,
                                     {{"participant", "P2"}, {"synthetic", false}}));
  const auto refused = RequireNoPerson(study);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(refused.error().message, HasSubstr("s/P2/journal.jsonl is of a person"));
}

TEST(StudyFolder, IsOfAPersonAlsoIfTheyOnlyResumedASimulatedSession) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(MakeFolder(folder.Path("P1")));
  auto journal = Journal::Create(folder.Path("P1/journal.jsonl"));
  ASSERT_TRUE(journal && journal->Append(EventKind::kSessionStarted, {{"synthetic", true}}));
  ASSERT_TRUE(journal->Append(EventKind::kSessionResumed, {{"synthetic", false}}));
  EXPECT_FALSE(RequireNoPerson(folder.Path("")));
}

TEST(StudyFolder, ComparesTheProtocolWithoutStoringIt) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(CheckProtocol(folder.Path(""), "{}"));
  EXPECT_FALSE(Exists(folder.Path("protocol.json")));
  ASSERT_TRUE(KeepProtocol(folder.Path(""), R"({"participants": ["P1"], "seed": 1})"));
  EXPECT_TRUE(CheckProtocol(folder.Path(""), R"({"participants": ["P1"], "seed": 1})"));
  EXPECT_FALSE(CheckProtocol(folder.Path(""), R"({"participants": ["P1"], "seed": 2})"));
}

TEST(StudyFolder, KeepsTheProtocolItBeganWithButForNewParticipants) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("s");
  ASSERT_TRUE(MakeFolder(path));
  ASSERT_TRUE(KeepProtocol(path, R"({"participants": ["P1"], "seed": 1})"));
  EXPECT_TRUE(KeepProtocol(path, R"({"participants": ["P1"], "seed": 1})"));
  EXPECT_TRUE(KeepProtocol(path, R"({"seed": 1, "participants": ["P1", "P2"]})"));
  for (const char* changed :
       {R"({"participants": ["P1", "P2"], "seed": 2})",
        R"({"participants": ["P2", "P1"], "seed": 1})", R"({"participants": ["P1"], "seed": 1})"}) {
    const auto refused = KeepProtocol(path, changed);
    ASSERT_FALSE(refused) << changed;
    EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  }
}

}  // namespace
}  // namespace footing::study::journal
