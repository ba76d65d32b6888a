#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "common/base/units.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "tests/common/recording/recording_fixture.h"
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

using testing::Not;

TEST_F(Recording, MessagesComeBackThroughTheSchemaInside) {
  WriteMotion(Path("a.mcap"), 5);
  EXPECT_THAT(Read(Bytes(Path("a.mcap"))), testing::ElementsAre(0, 0.25, 0.5, 0.75, 1));
}

TEST_F(Recording, SchemaHoldsItsImportsBeforeItself) {
  google::protobuf::FileDescriptorSet files;
  ASSERT_TRUE(files.ParseFromString(DescribeWithImports(*v1::Tick::descriptor())));
  std::vector<std::string> names;
  for (const auto& file : files.file()) {
    for (const std::string& import : file.dependency()) {
      EXPECT_THAT(names, testing::Contains(import)) << "imported by " << file.name();
    }
    names.push_back(file.name());
  }
  EXPECT_EQ(names.back(), "footing/v1/session.proto");
}

TEST_F(Recording, NeverOverwritesUnlessTold) {
  WriteMotion(Path("a.mcap"), 1);
  const Result<RecordingWriter> again =
      RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(again.error().message, HasSubstr("--force"));
  EXPECT_TRUE(RecordingWriter::Create(Path("a.mcap"), {"test", true, {}}).ok());
}

TEST_F(Recording, ReplacesAnExistingOneAtItsFirstMessage) {
  WriteMotion(Path("a.mcap"), 100);
  const auto old_bytes = std::filesystem::file_size(Path("a.mcap"));
  auto writer = RecordingWriter::Create(Path("a.mcap"), {"test", true, {}});
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->AddMetadata("session", {{"server", "footingd"}}).ok());
  ASSERT_TRUE(writer->Attach("config.json", "application/json", "{}", 0).ok());
  ASSERT_TRUE(writer->Flush().ok());
  EXPECT_EQ(std::filesystem::file_size(Path("a.mcap")), old_bytes);
  ASSERT_TRUE(writer->Write("/footingd/gaps", v1::Gap(), {0, 0, 0}).ok());
  ASSERT_TRUE(writer->Finish().ok());
  const auto session = RecordedSession::Open(Path("a.mcap"));
  ASSERT_TRUE(session.ok());
  ASSERT_EQ(session->metadata().size(), 1u);
  EXPECT_EQ(session->metadata()[0].name, "session") << "of before the first message";
}

TEST_F(Recording, IsReadableByItsOwnerAlone) {
  WriteMotion(Path("a.mcap"), 1);
  EXPECT_EQ(std::filesystem::status(Path("a.mcap")).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(Recording, AnUnfinishedOneIsOnDiskUpToItsLastFlush) {
  Result<RecordingWriter> writer = RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok());
  // A message every 10 ms: the chunk that spans 1 s closes at the 101st.
  for (int k = 0; k <= 100; ++k) {
    ASSERT_TRUE(writer->Write("/t", v1::Gap(), {std::int64_t{10'000'000} * k, 0, 0}).ok());
    EXPECT_EQ(writer->pending(), k < 100);
  }
  int on_disk = 0;
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message&) { ++on_disk; };
  const mcap::WalkEnd end = mcap::Walk(Bytes(Path("a.mcap")), visitor, mcap::WalkMode::kSalvage);
  EXPECT_TRUE(end.cut);
  EXPECT_EQ(on_disk, 101);
}

TEST_F(Recording, ATextFileIsNoCaseForRepair) {
  Save(Path("notes.txt"), "day 1\n");
  const auto session = RecordedSession::Open(Path("notes.txt"));
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(session.error().message, HasSubstr("notes.txt is not a recording"));
  EXPECT_THAT(session.error().message, Not(HasSubstr("repair")));
}

TEST_F(Recording, ARateThatNoServerHasIsTheUsualOne) {
  const std::pair<const char*, double> rates[] = {{"50", 50},      {"0", 100},   {"-5", 100},
                                                  {"1e-300", 100}, {"inf", 100}, {"nan", 100}};
  for (const auto& [written, read] : rates) {
    const std::string path = Path(std::string(written) + ".mcap");
    auto writer = RecordingWriter::Create(path, {"test", false, {}});
    ASSERT_TRUE(
        writer->AddMetadata("session", {{"server", "footingd"}, {"tick_rate_hz", written}}).ok());
    ASSERT_TRUE(writer->Finish().ok());
    const auto session = RecordedSession::Open(path);
    ASSERT_TRUE(session.ok());
    EXPECT_EQ(session->servers()[0].tick_rate_hz, read) << written;
  }
}

TEST_F(Recording, ATimeToWhichNoClockComesIsRefused) {
  for (const std::int64_t time_ns : {kMostInstantNs + 1, std::int64_t{-1}}) {
    auto writer = RecordingWriter::Create(Path("a.mcap"), {"test", true, {}});
    ASSERT_TRUE(writer->Write("/footingd/motion", v1::MotionSamples(), {time_ns, 0, 1}).ok());
    ASSERT_TRUE(writer->Finish().ok());
    const auto session = RecordedSession::Open(Path("a.mcap"));
    ASSERT_FALSE(session.ok());
    EXPECT_EQ(session.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(session.error().message, HasSubstr("no clock of a host"));
  }
}

TEST_F(Recording, SchemasThatMakeNoSenseAreRefused) {
  SchemaPool pool;
  const auto encoding = pool.Add({1, "a.B", "ros2msg", ""});
  ASSERT_FALSE(encoding.ok());
  EXPECT_THAT(encoding.error().message, HasSubstr("ros2msg"));
  EXPECT_FALSE(pool.Add({1, "a.B", "protobuf", "\xFF\xFF garbage"}).ok());
  EXPECT_FALSE(pool.Add({1, "a.B", "protobuf", ""}).ok());
  EXPECT_EQ(pool.Parse(1, ""), nullptr);
}

}  // namespace
}  // namespace footing::recording
