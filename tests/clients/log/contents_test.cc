#include "clients/log/contents.h"

#include <gmock/gmock.h>

#include "common/recording/recording_writer.h"
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
