#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_records.h"
#include "tests/common/recording/sample_file.h"

namespace footing::mcap {
namespace {

/// Where each message's record ends in the file, found by its own bytes.
std::vector<std::size_t> MessageEnds(const std::string& file, int messages) {
  std::vector<std::size_t> ends;
  for (int k = 0; k < messages; ++k) {
    const std::string text = SampleText(k);
    const std::uint64_t time = static_cast<std::uint64_t>(k) * 100'000'000;
    std::string record;
    Encode(Message{static_cast<std::uint16_t>(k % 2 + 1), static_cast<std::uint32_t>(k), time,
                   time + 5, text},
           record);
    ends.push_back(file.find(record) + record.size());
  }
  return ends;
}

TEST(McapCut, EveryCompleteMessageBeforeTheCutIsRecoveredAtEveryByte) {
  constexpr int kMessages = 23;
  const std::string file = SampleFile(kMessages);
  const std::vector<std::size_t> ends = MessageEnds(file, kMessages);
  for (std::size_t cut = 0; cut <= file.size(); ++cut) {
    const Seen seen = WalkAll(file.substr(0, cut), WalkMode::kSalvage);
    std::size_t whole = 0;
    while (whole < ends.size() && ends[whole] <= cut) ++whole;
    ASSERT_EQ(seen.messages.size(), whole) << "cut at " << cut;
    for (std::size_t k = 0; k < whole; ++k) {
      ASSERT_EQ(seen.messages[k], SampleText(static_cast<int>(k))) << "cut at " << cut;
    }
    ASSERT_EQ(seen.end.complete, cut == file.size()) << "cut at " << cut;
    ASSERT_EQ(seen.end.cut, cut < file.size()) << "cut at " << cut << ": " << seen.end.problem;
    ASSERT_LE(seen.end.end_offset, std::max<std::size_t>(cut, 8));
  }
}

TEST(McapCut, StrictReadingSaysWhereItStops) {
  const std::string file = SampleFile(23);
  for (std::size_t cut = 0; cut < file.size(); ++cut) {
    const Seen seen = WalkAll(file.substr(0, cut), WalkMode::kStrict);
    ASSERT_FALSE(seen.end.complete) << "cut at " << cut;
    ASSERT_FALSE(seen.end.problem.empty());
    ASSERT_LE(seen.end.problem_offset, cut);
  }
}

TEST(McapCut, BytesBehindTheEndAreAProblem) {
  const Seen seen = WalkAll(SampleFile(3) + "x", WalkMode::kStrict);
  EXPECT_FALSE(seen.end.complete);
  EXPECT_FALSE(seen.end.cut);
  EXPECT_EQ(seen.messages.size(), 3u);
}

using testing::HasSubstr;

/// A file of four chunks of 6, 6, 6 and 5 messages.
constexpr int kMessages = 23;

std::string Damaged(std::size_t offset, char to) {
  std::string file = SampleFile(kMessages);
  file[offset] = to;
  return file;
}

TEST(McapDamage, AChunkOfWrongCrcIsLeftOutAndTheOthersAreKept) {
  const std::string file = SampleFile(kMessages);
  const std::string damaged = Damaged(file.find("message 2") + 8, 'X');
  const Seen strict = WalkAll(damaged, WalkMode::kStrict);
  EXPECT_THAT(strict.end.problem, HasSubstr("CRC"));
  EXPECT_TRUE(strict.messages.empty());
  const Seen kept = WalkAll(damaged, WalkMode::kSalvage);
  EXPECT_EQ(kept.end.damaged_chunks, 1u);
  EXPECT_FALSE(kept.end.cut);
  ASSERT_EQ(kept.messages.size(), 17u);  // 23 less the first chunk's 6.
  EXPECT_EQ(kept.messages[0], SampleText(6));
  EXPECT_EQ(kept.topics.size(), 2u);  // From the summary: the first chunk held the channels.
}

TEST(McapDamage, AnAttachmentOfWrongCrcIsLeftOut) {
  const std::string file = SampleFile(kMessages);
  const Seen kept = WalkAll(Damaged(file.find("{\"a\"") + 1, 'X'), WalkMode::kSalvage);
  EXPECT_TRUE(kept.attachments.empty());
  EXPECT_EQ(kept.end.damaged_records, 1u);
  EXPECT_EQ(kept.messages.size(), 23u);
}

TEST(McapDamage, AWrongByteInTheSummaryIsNoticed) {
  const std::string file = SampleFile(kMessages);
  const std::size_t offset = file.rfind("/b");
  EXPECT_FALSE(WalkAll(Damaged(offset, 'X'), WalkMode::kStrict).end.complete);
  const Result<Summary> summary = ReadSummary(Damaged(offset, 'X'));
  ASSERT_FALSE(summary.ok());
  EXPECT_EQ(summary.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(summary.error().message, HasSubstr("CRC"));
}

TEST(McapDamage, LengthsBeyondTheFileAreRefusedWithTheirOffset) {
  std::string file = SampleFile(kMessages);
  const std::size_t header_length = kMagic.size() + 1;
  for (std::size_t i = 0; i < 8; ++i) file[header_length + i] = '\xFF';
  const Seen seen = WalkAll(file, WalkMode::kStrict);
  EXPECT_TRUE(seen.messages.empty());
  EXPECT_EQ(seen.end.problem_offset, kMagic.size());
  EXPECT_THAT(seen.end.problem, HasSubstr("18446744073709551615 bytes"));
  EXPECT_EQ(WalkAll(file, WalkMode::kSalvage).messages.size(), 23u) << "all chunks are whole";
}

TEST(McapDamage, BehindAHoleTheNextWholeChunkIsFound) {
  const std::string file = SampleFile(kMessages);
  const std::size_t second = file.find("message 8");
  // A block of zeros over a boundary of chunks; bytes that are gone; bytes that are too many.
  std::string zeros = file, gone = file, more = file;
  zeros.replace(file.find("message 10"), 120, std::string(120, '\0'));
  gone.erase(second, 40);
  more.insert(second, 1000, '\x05');
  for (const std::string* damaged : {&zeros, &gone, &more}) {
    const Seen kept = WalkAll(*damaged, WalkMode::kSalvage);
    EXPECT_GE(kept.messages.size(), 11u) << "the two chunks that were not touched";
    EXPECT_EQ(kept.messages.back(), SampleText(kMessages - 1));
    EXPECT_FALSE(kept.end.complete || kept.end.cut);
    EXPECT_FALSE(WalkAll(*damaged, WalkMode::kStrict).end.complete);
  }
  EXPECT_GT(WalkAll(gone, WalkMode::kSalvage).messages.size(), 16u) << "one chunk alone is lost";
}

TEST(McapDamage, NoSingleWrongByteBreaksTheWalkOrInventsMessages) {
  const std::string file = SampleFile(kMessages);
  for (std::size_t offset = 0; offset < file.size(); ++offset) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      const auto to = static_cast<char>(file[offset] ^ flip);
      const Seen seen = WalkAll(Damaged(offset, to), WalkMode::kSalvage);
      ASSERT_LE(seen.messages.size(), 23u) << offset;
      ASSERT_FALSE(seen.end.complete) << "a wrong byte at " << offset << " went unnoticed";
    }
  }
}

TEST(McapDamage, SomethingElseIsNotAnMcapFile) {
  const Seen seen = WalkAll("time_s,x_mm,y_mm\n0,0,0\n", WalkMode::kStrict);
  EXPECT_THAT(seen.end.problem, HasSubstr("not an MCAP file"));
  EXPECT_FALSE(seen.end.cut);
}

TEST(McapDamage, MapsAndTextsLongerThanTheirRecordAreRefused) {
  // Metadata: name of 0xFFFFFFFF bytes.
  EXPECT_FALSE(DecodeMetadata(std::string("\xFF\xFF\xFF\xFFname", 8)).has_value());
  // Name "n", then a map of 4 bytes whose key says 9.
  EXPECT_FALSE(DecodeMetadata(std::string("\1\0\0\0n\4\0\0\0\11\0\0\0", 13)).has_value());
}

}  // namespace
}  // namespace footing::mcap
