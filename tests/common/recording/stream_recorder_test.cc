#include "common/recording/stream_recorder.h"

#include <gtest/gtest.h>

#include "common/recording/recorded_session.h"
#include "tests/common/temporary_folder.h"

namespace footing::recording {
namespace {

v1::Welcome WelcomeOf(const std::string& server_id, std::uint64_t epoch) {
  v1::Welcome welcome;
  welcome.set_server_id(server_id);
  welcome.set_epoch(epoch);
  return welcome;
}

v1::Tick FeaturesTick(std::uint64_t sequence, std::int64_t host_ns, const std::string& rig) {
  v1::Tick tick;
  tick.set_sequence(sequence);
  tick.set_host_ns(host_ns);
  tick.mutable_features()->add_rigs()->set_rig(rig);
  return tick;
}

class StreamRecorderTest : public testing::Test {
 protected:
  StreamRecorderTest()
      : path_(folder_.Path("a.mcap")),
        writer_(RecordingWriter::Create(path_, {"test", false, {}})) {}

  RecordedSession Read() {
    EXPECT_TRUE(writer_->Finish().ok());
    auto session = RecordedSession::Open(path_);
    EXPECT_TRUE(session.ok());
    return std::move(session).value();
  }

  test::TemporaryFolder folder_;
  std::string path_;
  Result<RecordingWriter> writer_;
};

TEST_F(StreamRecorderTest, TwoServersShareARecordingUnderTheirOwnTopics) {
  StreamRecorder first(*writer_, "unix:/1", [](const std::string& id) { return id; });
  StreamRecorder second(*writer_, "unix:/2", [](const std::string& id) { return id + "_2"; });
  for (StreamRecorder* recorder : {&first, &second}) {
    ASSERT_TRUE(recorder->OnWelcome(WelcomeOf("footingd", 5), 1).ok());
    ASSERT_TRUE(recorder->OnTick(FeaturesTick(1, 10, "main"), 2).ok());
  }
  const RecordedSession session = Read();
  ASSERT_EQ(session.servers().size(), 2u);
  EXPECT_EQ(session.servers()[0].name, "footingd");
  EXPECT_EQ(session.servers()[1].name, "footingd_2");
  EXPECT_EQ(session.servers()[1].server_id, "footingd");
}

TEST(ServerNames, NumberTheServersOfOneId) {
  ServerNames names;
  EXPECT_EQ(names.Of("footing-sim", "unix:a"), "footing-sim");
  EXPECT_EQ(names.Of("footing-sim", "unix:b"), "footing-sim_2");
  EXPECT_EQ(names.Of("footingd", "unix:c"), "footingd");
  EXPECT_EQ(names.Of("footing-sim", "unix:a"), "footing-sim");  // It came back.
  EXPECT_EQ(names.Of("footing-sim", "unix:b"), "footing-sim_2");
}

TEST_F(StreamRecorderTest, StampsAreTheTicksTimeAndTheArrival) {
  StreamRecorder recorder(*writer_, "unix:/1", [](const std::string& id) { return id; });
  ASSERT_TRUE(recorder.OnWelcome(WelcomeOf("footing-sim", 5), 1).ok());
  const std::uint64_t sequence = (std::uint64_t{1} << 32) + 7;
  const v1::Tick tick = FeaturesTick(sequence, 111, "main");
  ASSERT_TRUE(recorder.OnTick(tick, 222).ok());
  ASSERT_TRUE(writer_->Finish().ok());
  int messages = 0;
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message& message) {
    ++messages;
    EXPECT_EQ(message.log_time_ns, 111u);
    EXPECT_EQ(message.publish_time_ns, 222u);
    EXPECT_EQ(message.sequence, 7u);
    EXPECT_EQ(message.data, tick.features().SerializeAsString());
  };
  auto file = MappedFile::Open(path_);
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(mcap::Walk(file->bytes(), visitor, mcap::WalkMode::kStrict).complete);
  EXPECT_EQ(messages, 1);
}

TEST_F(StreamRecorderTest, ANoticeIsAMetadataRecord) {
  StreamRecorder recorder(*writer_, "unix:/1", [](const std::string& id) { return id; });
  ASSERT_TRUE(recorder.OnWelcome(WelcomeOf("footingd", 5), 1).ok());
  v1::Notice notice;
  notice.set_kind(v1::Notice::KIND_TICKS_LATE);
  notice.set_text("12 ticks left out");
  notice.set_count(12);
  ASSERT_TRUE(recorder.OnNotice(notice, 3).ok());
  EXPECT_EQ(recorder.notice(), "12 ticks left out");
  const RecordedSession session = Read();
  for (const mcap::Metadata& record : session.metadata()) {
    if (record.name != "notice") continue;
    EXPECT_EQ(record.values.at("kind"), "KIND_TICKS_LATE");
    EXPECT_EQ(record.values.at("text"), "12 ticks left out");
    EXPECT_EQ(record.values.at("count"), "12");
    return;
  }
  FAIL() << "no record \"notice\"";
}

TEST_F(StreamRecorderTest, TicksComeBackInOrderWithTheChannelsAskedFor) {
  StreamRecorder recorder(*writer_, "unix:/1", [](const std::string& id) { return id; });
  ASSERT_TRUE(recorder.OnWelcome(WelcomeOf("footingd", 5), 1).ok());
  v1::Tick both = FeaturesTick(1, 10, "main");
  both.mutable_status()->add_devices()->set_device(3);
  ASSERT_TRUE(recorder.OnTick(FeaturesTick(2, 20, "main"), 2).ok());
  ASSERT_TRUE(recorder.OnTick(both, 3).ok());
  const RecordedSession session = Read();
  const RecordedServer* server = session.Find("footingd");
  ASSERT_NE(server, nullptr);
  EXPECT_EQ(session.Find("footing-sim"), nullptr);
  const auto all = ReadTicks(*server);
  ASSERT_TRUE(all.ok());
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0].SerializeAsString(), both.SerializeAsString());
  EXPECT_EQ((*all)[1].sequence(), 2u);
  const auto status = ReadTick(server->ticks[0], {v1::Tick::kStatusFieldNumber});
  ASSERT_TRUE(status.ok());
  EXPECT_TRUE(status->has_status());
  EXPECT_FALSE(status->has_features());
}

TEST_F(StreamRecorderTest, ASnapshotDoesNotMixWithTheTickOfItsSequence) {
  StreamRecorder recorder(*writer_, "unix:/1", [](const std::string& id) { return id; });
  ASSERT_TRUE(recorder.OnWelcome(WelcomeOf("footingd", 5), 1).ok());
  ASSERT_TRUE(recorder.OnTick(FeaturesTick(1, 10, "main"), 2).ok());
  v1::Tick snapshot;
  snapshot.set_sequence(1);
  snapshot.set_host_ns(15);
  snapshot.set_snapshot(true);
  snapshot.mutable_status()->add_devices()->set_device(3);
  ASSERT_TRUE(recorder.OnTick(snapshot, 3).ok());
  const RecordedSession session = Read();
  ASSERT_EQ(session.servers()[0].ticks.size(), 1u);
  EXPECT_EQ(session.servers()[0].ticks[0].channels.size(), 1u);
}

TEST_F(StreamRecorderTest, AServerThatStartsAgainIsAnEntryOfItsOwn) {
  StreamRecorder recorder(*writer_, "unix:/1", [](const std::string& id) { return id; });
  for (const std::uint64_t epoch : {5u, 6u}) {
    ASSERT_TRUE(recorder.OnWelcome(WelcomeOf("footingd", epoch), 1).ok());
    const auto host_ns = static_cast<std::int64_t>(100 * epoch);
    ASSERT_TRUE(recorder.OnTick(FeaturesTick(1, host_ns, "main"), 2).ok());
    ASSERT_TRUE(recorder.OnTick(FeaturesTick(2, host_ns + 10, "main"), 2).ok());
  }
  const RecordedSession session = Read();
  ASSERT_EQ(session.servers().size(), 2u);
  for (const RecordedServer& server : session.servers()) {
    ASSERT_EQ(server.ticks.size(), 2u);
    EXPECT_EQ(server.ticks[0].host_ns, static_cast<std::int64_t>(100 * server.epoch));
  }
}

TEST_F(StreamRecorderTest, AMessageThatDoesNotParseIsNamed) {
  RecordedTick tick;
  tick.sequence = 9;
  tick.channels.push_back({v1::Tick::kStatusFieldNumber, "\xff"});
  const auto read = ReadTick(tick);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(read.error().message.find("status"), std::string::npos);
}

TEST_F(StreamRecorderTest, ACutRecordingNamesItsRepair) {
  ASSERT_TRUE(writer_->Write("/footingd/gaps", v1::Gap(), {0, 0, 0}).ok());
  const auto session = RecordedSession::Open(path_);  // Not finished.
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(session.error().message.find("footing-log repair"), std::string::npos);
}

}  // namespace
}  // namespace footing::recording
