#include "common/recording/mcap_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/common/recording/sample_file.h"

namespace footing::mcap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The texts of one channel over all chunks.
std::vector<std::string> TextsOf(const std::string& file, const Summary& summary,
                                 std::uint16_t channel) {
  std::vector<std::string> texts;
  for (const ChunkIndex& chunk : summary.chunks) {
    const Result<void> visited = VisitChannel(
        file, chunk, channel, [&](const Message& message) { texts.emplace_back(message.data); });
    EXPECT_TRUE(visited.ok()) << visited.error().message;
  }
  return texts;
}

std::vector<std::string> EverySecond(int from, int messages) {
  std::vector<std::string> texts;
  for (int k = from; k < messages; k += 2) texts.push_back(SampleText(k));
  return texts;
}

TEST(McapSeek, AChannelIsReadThroughTheMessageIndex) {
  const std::string file = SampleFile(23);
  const Result<Summary> summary = ReadSummary(file);
  ASSERT_TRUE(summary.ok());
  ASSERT_GT(summary->chunks.size(), 3u);
  EXPECT_EQ(TextsOf(file, *summary, 1), EverySecond(0, 23));
  EXPECT_EQ(TextsOf(file, *summary, 2), EverySecond(1, 23));
  EXPECT_THAT(TextsOf(file, *summary, 3), ElementsAre());
}

TEST(McapSeek, ARebuiltIndexFindsTheSame) {
  const std::string file = SampleFile(23);
  const Result<RebuiltIndex> rebuilt = RebuildIndex(file, 100);
  ASSERT_TRUE(rebuilt.ok());
  EXPECT_EQ(rebuilt->problem, "");
  const Summary summary = *ReadSummary(file);
  ASSERT_EQ(rebuilt->summary.chunks.size(), summary.chunks.size());
  for (std::size_t i = 0; i < summary.chunks.size(); ++i) {
    EXPECT_EQ(rebuilt->summary.chunks[i].chunk_offset, summary.chunks[i].chunk_offset);
    EXPECT_EQ(rebuilt->summary.chunks[i].chunk_length, summary.chunks[i].chunk_length);
    EXPECT_EQ(rebuilt->summary.chunks[i].start_time_ns, summary.chunks[i].start_time_ns);
    EXPECT_EQ(rebuilt->summary.chunks[i].end_time_ns, summary.chunks[i].end_time_ns);
  }
  EXPECT_EQ(rebuilt->summary.channels, summary.channels);
  EXPECT_EQ(rebuilt->summary.schemas, summary.schemas);
  ASSERT_EQ(rebuilt->summary.metadata.size(), 1u);
  EXPECT_EQ(rebuilt->summary.metadata[0].offset, summary.metadata[0].offset);
  EXPECT_EQ(TextsOf(file, rebuilt->summary, 2), EverySecond(1, 23));
}

TEST(McapSeek, EveryCutLeavesTheChunksBeforeIt) {
  const std::string file = SampleFile(23);
  const Summary summary = *ReadSummary(file);
  for (std::size_t size = kMagic.size(); size < file.size(); size += 7) {
    const std::string cut = file.substr(0, size);
    const Result<RebuiltIndex> rebuilt = RebuildIndex(cut, 100);
    ASSERT_TRUE(rebuilt.ok()) << size;
    std::size_t whole = 0;
    for (const ChunkIndex& chunk : summary.chunks) {
      whole += chunk.chunk_offset + chunk.chunk_length <= size ? 1 : 0;
    }
    EXPECT_EQ(rebuilt->summary.chunks.size(), whole) << size;
    EXPECT_LE(rebuilt->end_offset, size);
    if (whole < summary.chunks.size()) {
      EXPECT_THAT(rebuilt->problem, HasSubstr("cut at byte")) << size;
    }
  }
}

TEST(McapSeek, ADamagedChunkIsLeftOutAndCounted) {
  std::string file = SampleFile(23);
  const Summary summary = *ReadSummary(file);
  const ChunkIndex& second = summary.chunks[1];
  file[second.chunk_offset + second.chunk_length - 1] ^= 1;
  const Result<RebuiltIndex> rebuilt = RebuildIndex(file, 100);
  ASSERT_TRUE(rebuilt.ok());
  EXPECT_EQ(rebuilt->summary.chunks.size(), summary.chunks.size() - 1);
  EXPECT_THAT(rebuilt->problem, HasSubstr("1 damaged chunks"));
  EXPECT_FALSE(CheckChunk(file, second).ok());
  EXPECT_TRUE(CheckChunk(file, summary.chunks[2]).ok());
}

/// Opcode and length; then of the index the channel (u16), the entries' size (u32) and per entry
/// the log time and the offset (u64 each).
constexpr std::uint64_t kSecondEntryOffset = kRecordHeadBytes + 6 + 16 + 8;

TEST(McapSeek, ADamagedMessageIndexDoesNotHideItsChunk) {
  const std::string whole = SampleFile(23);
  const Summary summary = *ReadSummary(whole);
  const std::uint64_t index = summary.chunks[0].message_index_offsets.at(1);
  // No index; one of another channel; entries that name the wrong messages, the first one right.
  for (const std::uint64_t at : {index, index + kRecordHeadBytes, index + kSecondEntryOffset}) {
    std::string file = whole;
    file[at] ^= 3;
    EXPECT_EQ(TextsOf(file, summary, 1), EverySecond(0, 23)) << at - index;
  }
}

TEST(McapSeek, ADamagedRecordWithinAChunkYieldsNothingOfIt) {
  std::string file = SampleFile(23);
  const ChunkIndex chunk = ReadSummary(file)->chunks[1];
  // Its last message is longer than the chunk.
  const std::size_t last = file.rfind(SampleText(9), chunk.chunk_offset + chunk.chunk_length);
  ASSERT_NE(last, std::string::npos);
  constexpr std::size_t kMessageHeadBytes = 22;
  file[last - kMessageHeadBytes - 1] ^= 1;
  int visited = 0;
  EXPECT_FALSE(CheckChunk(file, chunk).ok());
  EXPECT_FALSE(VisitChunk(file, chunk, [&](const Message&) { ++visited; }).ok());
  EXPECT_EQ(visited, 0);
}

TEST(McapSeek, LimitsAreCheckedBeforeMemoryIsTaken) {
  const std::string file = SampleFile(23);
  EXPECT_FALSE(RebuildIndex(file, 2).ok());
  EXPECT_FALSE(ReadSummary(file, 100).ok());
  EXPECT_FALSE(RebuildIndex("no MCAP file", 2).ok());
}

TEST(McapSeek, ARebuiltIndexOfManyDefinitionsOrMetadataIsRefused) {
  constexpr std::uint64_t kMostBytes = 4000;
  ASSERT_TRUE(RebuildIndex(SampleFile(23), 100, kMostBytes).ok());
  Writer channels({"", "test 1"}, {}), metadata({"", "test 1"}, {});
  for (std::uint16_t k = 0; k < 200; ++k) {
    const std::uint16_t channel = channels.AddChannel(0, "/" + std::to_string(k), "protobuf", {});
    channels.Add(Message{channel, 0, 0, 0, ""});
    metadata.Add(Metadata{"session", {}});
  }
  for (Writer* const writer : {&channels, &metadata}) {
    writer->Finish();
    const std::string file = writer->Take();
    EXPECT_TRUE(RebuildIndex(file, 100, 20 * kMostBytes).ok());
    const Result<RebuiltIndex> refused = RebuildIndex(file, 100, kMostBytes);
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error().message, HasSubstr("an index of more than 4000 bytes"));
  }
}

TEST(McapSeek, AnIndexThatPointsAnywhereIsRefused) {
  const std::string file = SampleFile(23);
  const Summary summary = *ReadSummary(file);
  for (std::uint64_t offset = 1; offset < file.size() + 20; offset += 3) {
    ChunkIndex wrong = summary.chunks[0];
    wrong.message_index_offsets[1] = offset;
    // Never a crash; where it is no index of that channel, an error or nothing.
    (void)VisitChannel(file, wrong, 1, [](const Message& message) {
      EXPECT_EQ(message.channel_id, 1);
    }).ok();
    wrong = summary.chunks[0];
    wrong.chunk_offset = offset;
    if (offset == summary.chunks[0].chunk_offset) continue;
    (void)VisitChunk(file, wrong, [](const Message&) {}).ok();
  }
}

}  // namespace
}  // namespace footing::mcap
