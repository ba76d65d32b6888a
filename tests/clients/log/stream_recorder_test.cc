#include "clients/log/stream_recorder.h"

#include <gmock/gmock.h>

#include "clients/log/contents.h"
#include "tests/clients/log/temporary_folder.h"

namespace footing::log_client {
namespace {

class StreamRecorderTest : public TemporaryFolder {};

TEST_F(StreamRecorderTest, TwoServersShareARecordingUnderTheirOwnTopics) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok());
  StreamRecorder first(*writer, "unix:/1", [](const std::string& id) { return id; });
  StreamRecorder second(*writer, "unix:/2", [](const std::string& id) { return id + "_2"; });
  v1::Welcome welcome;
  welcome.set_server_id("footingd");
  v1::Tick tick;
  tick.mutable_features()->add_rigs()->set_rig("main");
  for (StreamRecorder* recorder : {&first, &second}) {
    ASSERT_TRUE(recorder->OnWelcome(welcome, 1).ok());
    ASSERT_TRUE(recorder->OnTick(tick, 2).ok());
  }
  ASSERT_TRUE(writer->Finish().ok());
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok());
  ASSERT_EQ(contents->topics.size(), 2u);
  EXPECT_EQ(contents->topics[0].name, "/footingd/features");
  EXPECT_EQ(contents->topics[1].name, "/footingd_2/features");
}

TEST_F(StreamRecorderTest, StampsAreTheTicksTimeAndTheArrival) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok());
  StreamRecorder recorder(*writer, "unix:/1", [](const std::string& id) { return id; });
  v1::Welcome welcome;
  welcome.set_server_id("footing-sim");
  ASSERT_TRUE(recorder.OnWelcome(welcome, 1).ok());
  v1::Tick tick;
  tick.set_sequence((std::uint64_t{1} << 32) + 7);
  tick.set_host_ns(111);
  tick.mutable_characters()->set_step(5);
  ASSERT_TRUE(recorder.OnTick(tick, 222).ok());
  ASSERT_TRUE(writer->Finish().ok());
  int messages = 0;
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message& message) {
    ++messages;
    EXPECT_EQ(message.log_time_ns, 111u);
    EXPECT_EQ(message.publish_time_ns, 222u);
    EXPECT_EQ(message.sequence, 7u);
    EXPECT_EQ(message.data, tick.characters().SerializeAsString());
  };
  EXPECT_TRUE(mcap::Walk(Bytes(Path("a.mcap")), visitor, mcap::WalkMode::kStrict).complete);
  EXPECT_EQ(messages, 1);
}

}  // namespace
}  // namespace footing::log_client
