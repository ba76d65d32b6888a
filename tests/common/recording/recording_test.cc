#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/recording/mapped_file.h"
#include "common/recording/recorded_session.h"
#include "common/base/instant.h"
#include "tests/common/recording/recording_fixture.h"

namespace footing::recording {
namespace {

using testing::HasSubstr;
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
