#include "common/recording/mcap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_records.h"
#include "tests/common/recording/sample_file.h"

namespace footing::mcap {
namespace {

using testing::ElementsAre;

TEST(McapWriter, GivesBackWhatWasAdded) {
  const Seen seen = WalkAll(SampleFile(23), WalkMode::kStrict);
  EXPECT_TRUE(seen.end.complete) << seen.end.problem;
  EXPECT_THAT(seen.topics, ElementsAre("/a", "/b"));
  EXPECT_THAT(seen.attachments, ElementsAre("config.json={\"a\": 1}"));
  EXPECT_THAT(seen.metadata, ElementsAre("session"));
  ASSERT_EQ(seen.messages.size(), 23u);
  for (int k = 0; k < 23; ++k) {
    EXPECT_EQ(seen.messages[static_cast<std::size_t>(k)], SampleText(k));
    EXPECT_EQ(seen.log_times_ns[static_cast<std::size_t>(k)], 100'000'000u * unsigned(k));
  }
}

TEST(McapWriter, SameCallsGiveTheSameBytes) { EXPECT_EQ(SampleFile(23), SampleFile(23)); }

TEST(McapWriter, CrcIsThatOfTheStandardCheckString) {
  // CRC-32/ISO-HDLC of "123456789" is 0xCBF43926 (the check value of the catalogue of CRCs).
  EXPECT_EQ(Crc32(0, "123456789"), 0xCBF43926u);
}

TEST(McapWriter, ClosesAChunkWhenItSpansTheGivenTime) {
  // Chunks of 500 ms hold messages 0..5, 6..11, 12..17, 18..22: a chunk closes once it spans 500.
  const std::string file = SampleFile(23);
  const Result<Summary> summary = ReadSummary(file);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  ASSERT_EQ(summary->chunks.size(), 4u);
  EXPECT_EQ(summary->chunks[0].start_time_ns, 0u);
  EXPECT_EQ(summary->chunks[0].end_time_ns, 500'000'000u);
  EXPECT_EQ(summary->chunks[3].end_time_ns, 2'200'000'000u);
}

TEST(McapWriter, ClosesAChunkWhenItIsFull) {
  Writer writer({"", ""}, WriterOptions{1000, ~std::uint64_t{0}});
  const std::uint16_t channel =
      writer.AddChannel(writer.AddSchema("test.Text", "protobuf", ""), "/a", "protobuf", {});
  const std::string text(300, 'x');
  for (std::uint32_t k = 0; k < 8; ++k) writer.Add(Message{channel, k, 1, 1, text});
  writer.Finish();
  // A message takes 9 + 22 + 300 = 331 bytes. Three and the records of schema and channel reach
  // 1000, then four do, and one is left over.
  EXPECT_EQ(writer.statistics().chunk_count, 3u);
}

TEST(McapWriter, SummaryCountsWhatIsThere) {
  const Result<Summary> summary = ReadSummary(SampleFile(23));
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->statistics.message_count, 23u);
  EXPECT_EQ(summary->statistics.channel_message_counts.at(1), 12u);
  EXPECT_EQ(summary->statistics.channel_message_counts.at(2), 11u);
  EXPECT_EQ(summary->statistics.attachment_count, 1u);
  EXPECT_EQ(summary->statistics.metadata_count, 1u);
  EXPECT_EQ(summary->channels.at(1).metadata.at("clock"), "server");
  EXPECT_EQ(summary->schemas.at(1).data, "schema bytes");
}

TEST(McapWriter, IndexFindsTheMessagesOfASpanOfTime) {
  const std::string file = SampleFile(23);
  const Result<Summary> summary = ReadSummary(file);
  ASSERT_TRUE(summary.ok());
  std::vector<std::string> found;
  for (const ChunkIndex& chunk : summary->chunks) {
    if (chunk.end_time_ns < 400'000'000 || chunk.start_time_ns >= 800'000'000) continue;
    ASSERT_TRUE(VisitChunk(file, chunk, [&](const Message& message) {
      if (message.log_time_ns >= 400'000'000 && message.log_time_ns < 800'000'000)
        found.emplace_back(message.data);
    }));
  }
  EXPECT_THAT(found, ElementsAre(SampleText(4), SampleText(5), SampleText(6), SampleText(7)));
}

TEST(McapWriter, AFileWithoutMessagesIsComplete) {
  const Seen seen = WalkAll(SampleFile(0), WalkMode::kStrict);
  EXPECT_TRUE(seen.end.complete) << seen.end.problem;
  EXPECT_THAT(seen.topics, ElementsAre("/a", "/b"));
}

}  // namespace
}  // namespace footing::mcap
