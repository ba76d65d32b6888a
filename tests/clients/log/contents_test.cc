#include "clients/log/contents.h"

#include <gmock/gmock.h>

#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

class ContentsTest : public TemporaryFolder {};

TEST_F(ContentsTest, TopicsCountsRatesAndGapsAreThoseRecorded) {
  WriteSampleRecording(Path("a.mcap"), true);
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_TRUE(contents->end.complete) << contents->end.problem;
  EXPECT_FALSE(Incomplete("a", contents->end).has_value());
  ASSERT_EQ(contents->topics.size(), 3u);
  EXPECT_EQ(contents->topics[0].name, "/footingd/gaps");
  EXPECT_EQ(contents->topics[1].name, "/footingd/motion");
  EXPECT_EQ(contents->topics[1].schema, "footing.v1.MotionSamples");
  EXPECT_EQ(contents->topics[1].messages, 300u);
  EXPECT_NEAR(contents->topics[1].RateHz(), 100, 1e-9);
  EXPECT_EQ(contents->topics[2].messages, 6u);  // Ticks 0, 50, ... 250.
  EXPECT_EQ(contents->end_ns - contents->start_ns, 2'990'000'000u);
  EXPECT_EQ(contents->gaps, 1u);
  EXPECT_EQ(contents->missing_ticks, 5u);
  ASSERT_EQ(contents->attachments.size(), 1u);
  EXPECT_EQ(contents->attachments[0].name, "config.json");
}

TEST_F(ContentsTest, SaysWhetherDevicesWereSimulated) {
  WriteSampleRecording(Path("made.mcap"), true);
  WriteSampleRecording(Path("real.mcap"), false);
  EXPECT_EQ(ReadContents(Path("made.mcap")).value().simulated, true);
  EXPECT_EQ(ReadContents(Path("real.mcap")).value().simulated, false);
}

TEST_F(ContentsTest, ARestartOfAServerIsCountedApart) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  v1::Gap gap;
  gap.set_from_sequence(450);
  gap.set_reason(v1::Gap::REASON_NEW_EPOCH);  // Nobody knows how many: to_sequence is 0.
  ASSERT_TRUE(writer->Write("/footingd/gaps", gap, {0, 0, 0}).ok());
  ASSERT_TRUE(writer->Finish().ok());
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->gaps, 1u);
  EXPECT_EQ(contents->missing_ticks, 0u);
  EXPECT_EQ(contents->restarts, 1u);
}

TEST_F(ContentsTest, TellsHowLongTheTicksAreMissing) {
  auto writer = recording::RecordingWriter::Create(Path("a.mcap"), {"test", false, {}});
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  recording::StreamRecorder recorder(*writer, "unix:/x", [](const std::string& id) { return id; });
  v1::Welcome welcome;
  welcome.set_server_id("footingd");
  ASSERT_TRUE(recorder.OnWelcome(welcome, 0).ok());
  const auto tick_at = [&](std::uint64_t sequence, std::int64_t ms) {
    v1::Tick tick;
    tick.set_sequence(sequence);
    tick.set_host_ns(ms * 1'000'000);
    tick.mutable_motion();
    ASSERT_TRUE(recorder.OnTick(tick, tick.host_ns()).ok());
  };
  v1::Gap dropped;
  dropped.set_from_sequence(3);
  dropped.set_to_sequence(22);
  v1::Gap restarted;
  restarted.set_from_sequence(25);
  restarted.set_reason(v1::Gap::REASON_NEW_EPOCH);
  tick_at(1, 1000);
  tick_at(2, 1010);
  ASSERT_TRUE(recorder.OnGap(dropped, 0).ok());
  tick_at(23, 1220);  // 20 ticks of 10 ms in between.
  tick_at(24, 1230);
  // After a restart: a snapshot of the present, the gap, and the first ticks out of the ring.
  tick_at(31, 4000);
  ASSERT_TRUE(recorder.OnGap(restarted, 0).ok());
  tick_at(1, 3700);
  tick_at(2, 3710);
  tick_at(32, 4010);
  ASSERT_TRUE(writer->Finish().ok());
  const auto contents = ReadContents(Path("a.mcap"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->missing_ticks, 20u);
  EXPECT_NEAR(contents->missing_s, 20 * 0.010, 1e-9);
  EXPECT_EQ(contents->restarts, 1u);
  EXPECT_NEAR(contents->restart_s, 3.700 - 1.230, 1e-9);
}

TEST_F(ContentsTest, TheSameStreamGivesTheSameBytes) {
  WriteSampleRecording(Path("a.mcap"), true);
  WriteSampleRecording(Path("b.mcap"), true);
  EXPECT_EQ(Bytes(Path("a.mcap")), Bytes(Path("b.mcap")));
}

TEST_F(ContentsTest, ACutRecordingNamesItsPlaceAndTheRepair) {
  WriteSampleRecording(Path("a.mcap"), true);
  const std::string whole = Bytes(Path("a.mcap"));
  Save(Path("cut.mcap"), whole.substr(0, whole.size() / 2));
  const auto contents = ReadContents(Path("cut.mcap"));
  ASSERT_TRUE(contents.ok());
  EXPECT_GT(contents->messages, 0u);
  const auto error = Incomplete(Path("cut.mcap"), contents->end);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->kind, ErrorKind::kInvalidData);
  EXPECT_THAT(error->message, HasSubstr("cut short at byte"));
  EXPECT_THAT(error->message, HasSubstr("footing-log repair"));
}

TEST_F(ContentsTest, SomethingElseIsNoRecording) {
  Save(Path("text.mcap"), "hello");
  Save(Path("empty.mcap"), "");
  EXPECT_EQ(ReadContents(Path("text.mcap")).error().kind, ErrorKind::kInvalidData);
  EXPECT_EQ(ReadContents(Path("empty.mcap")).error().kind, ErrorKind::kInvalidData);
  EXPECT_EQ(ReadContents(Path("none.mcap")).error().kind, ErrorKind::kFailure);
}

}  // namespace
}  // namespace footing::log_client
