#include "common/recording/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "common/recording/mcap_reader.h"
#include "common/recording/recorded_session.h"
#include "common/recording/seekable_recording.h"
#include "tests/common/recording/recording_fixture.h"

namespace footing::recording {
namespace {

TEST_F(Recording, RepairOfACutFileKeepsEveryCompleteMessageAndIsComplete) {
  WriteMotion(Path("whole.mcap"), 250);
  const std::string whole = Bytes(Path("whole.mcap"));
  std::size_t kept_before = 0;
  for (std::size_t cut = 8; cut < whole.size();
       cut += 331) {  // 331 is prime: any place in a record.
    Save(Path("cut.mcap"), whole.substr(0, cut));
    const auto report = Repair(Path("cut.mcap"), Path("repaired.mcap"), "test", true);
    ASSERT_TRUE(report.ok()) << report.error().message;
    const std::vector<double> values = Read(Bytes(Path("repaired.mcap")));
    ASSERT_EQ(values.size(), report->messages);
    ASSERT_GE(values.size(), kept_before);
    for (std::size_t k = 0; k < values.size(); ++k) ASSERT_EQ(values[k], 0.25 * double(k));
    kept_before = values.size();
    EXPECT_TRUE(mcap::ReadSummary(Bytes(Path("repaired.mcap"))).ok());
  }
  EXPECT_EQ(kept_before, 250u);
}

TEST_F(Recording, RepairOfAWholeFileSaysThatNothingWasWrong) {
  WriteMotion(Path("whole.mcap"), 30);
  const auto report = Repair(Path("whole.mcap"), Path("copy.mcap"), "test", false);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->found.complete);
  EXPECT_EQ(report->messages, 30u);
  EXPECT_EQ(Bytes(Path("copy.mcap")), Bytes(Path("whole.mcap")));
}

TEST_F(Recording, RepairOfADamagedFileNamesTheTicksThatItLost) {
  WriteMotion(Path("whole.mcap"), 450, true);
  const RepairReport report = RepairDamaged(Path("whole.mcap"));
  const Numbers numbers = NumbersOf(Bytes(Path("repaired.mcap")));
  ASSERT_EQ(numbers.gaps.size(), 1u);
  const v1::Gap& gap = numbers.gaps[0];
  EXPECT_EQ(gap.reason(), v1::Gap::REASON_DAMAGED);
  EXPECT_GT(report.missing_ticks, 50u);
  EXPECT_EQ(gap.to_sequence() - gap.from_sequence() + 1, report.missing_ticks);
  EXPECT_EQ(numbers.ticks.size() + report.missing_ticks, 450u);
  for (const std::uint32_t tick : numbers.ticks) {
    EXPECT_TRUE(tick < gap.from_sequence() || tick > gap.to_sequence()) << tick;
  }
}

TEST_F(Recording, RepairAddsNothingToAFileThatIsOfNoServer) {
  WriteMotion(Path("whole.mcap"), 450);
  EXPECT_EQ(RepairDamaged(Path("whole.mcap")).missing_ticks, 0u);
  EXPECT_TRUE(NumbersOf(Bytes(Path("repaired.mcap"))).gaps.empty());
}

TEST_F(Recording, RepairNamesNoTicksWhereAServerStartedAgainOrSkippedSome) {
  Result<RecordingWriter> writer = RecordingWriter::Create(Path("whole.mcap"), {"test", false, {}});
  int written = 0;
  for (const int epoch : {1, 2}) {
    ASSERT_TRUE(writer->Flush().ok());
    ASSERT_TRUE(
        writer->AddMetadata("session", {{"server", "footingd"}, {"epoch", std::to_string(epoch)}})
            .ok());
    // The second start counts from 1 again, with other numbers; every third tick has nothing new.
    for (int k = 0; k < 150; ++k, ++written) {
      const std::int64_t time_ns = std::int64_t{10'000'000} * written;
      const auto number = static_cast<std::uint32_t>(epoch * 100 + k + k / 2);
      ASSERT_TRUE(
          writer->Write("/footingd/motion", v1::MotionSamples(), {time_ns, time_ns, number}).ok());
    }
  }
  ASSERT_TRUE(writer->Finish().ok());
  EXPECT_TRUE(NumbersOf(Bytes(Path("whole.mcap"))).gaps.empty());
  std::string bytes = Bytes(Path("whole.mcap"));
  const std::size_t second = bytes.find("session", bytes.find("session") + 1);
  bytes[second - 1200] ^= 1;  // In the last chunk of the first start.
  Save(Path("damaged.mcap"), bytes);
  const auto report = Repair(Path("damaged.mcap"), Path("repaired.mcap"), "test", true);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->found.damaged_chunks, 1u);
  EXPECT_EQ(report->missing_ticks, 0u);
  EXPECT_TRUE(NumbersOf(Bytes(Path("repaired.mcap"))).gaps.empty());
}

TEST_F(Recording, RepairRefusesWhatIsNoRecordingAndItsOwnInput) {
  for (const char* bytes : {"time_s,x_mm\n", ""}) {
    Save(Path("text.mcap"), bytes);
    const auto no_mcap = Repair(Path("text.mcap"), Path("out.mcap"), "test", false);
    ASSERT_FALSE(no_mcap.ok());
    EXPECT_EQ(no_mcap.error().kind, ErrorKind::kInvalidData);
    EXPECT_FALSE(std::filesystem::exists(Path("out.mcap")));
  }
  WriteMotion(Path("a.mcap"), 1);
  const auto same = Repair(Path("a.mcap"), Path("a.mcap"), "test", true);
  ASSERT_FALSE(same.ok());
  EXPECT_EQ(same.error().kind, ErrorKind::kUsage);
}

/// Log times and numbers of the ticks, and what each says.
std::vector<std::string> TicksOf(const std::vector<playback::PlacedTick>& ticks) {
  std::vector<std::string> texts;
  for (const playback::PlacedTick& tick : ticks) texts.push_back(tick.tick.DebugString());
  return texts;
}

TEST_F(Recording, ACompressedOneHasTheSameMessagesForEveryReader) {
  WriteMotion(Path("plain.mcap"), 1000, true);
  WriteMotion(Path("packed.mcap"), 1000, true, /*compress=*/true);
  const std::string plain = Bytes(Path("plain.mcap")), packed = Bytes(Path("packed.mcap"));
  EXPECT_LT(packed.size(), 6 * plain.size() / 10);
  EXPECT_EQ(Read(packed), Read(plain));
  const auto summary = mcap::ReadSummary(packed);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  for (const mcap::ChunkIndex& chunk : summary->chunks) {
    EXPECT_EQ(chunk.compression, "zstd");
    EXPECT_LT(chunk.compressed_size, chunk.uncompressed_size);
  }
  const auto session = RecordedSession::Open(Path("packed.mcap"));
  ASSERT_TRUE(session.ok()) << session.error().message;
  const std::vector<RecordedTick>& ticks = session->servers().at(0).ticks;
  ASSERT_EQ(ticks.size(), 1000u);
  for (std::size_t i = 0; i < ticks.size(); i += 99) {
    const auto tick = ReadTick(ticks[i]);
    ASSERT_TRUE(tick.ok()) << tick.error().message;
    EXPECT_EQ(tick->motion().samples(0).specific_force_mps2().x(), 0.25 * double(i));
  }
  std::vector<std::string> seen[2];
  for (const bool is_packed : {false, true}) {
    auto opened = playback::SeekableRecording::Open(Path(is_packed ? "packed.mcap" : "plain.mcap"),
                                                    {"footingd"}, {"motion"});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    EXPECT_EQ(opened->Limits(), "");
    seen[is_packed] = TicksOf(opened->Ticks(2'000'000'000, 4'000'000'000));
    const auto last = opened->LastOf(0, "motion", 3'333'000'000, false);
    ASSERT_TRUE(last.has_value());
    EXPECT_EQ(last->tick.motion().samples(0).received_ns(), 3'330'000'000);
  }
  EXPECT_EQ(seen[0].size(), 200u);
  EXPECT_EQ(seen[1], seen[0]);
}

TEST_F(Recording, RepairOfACutCompressedFileKeepsItsWholeChunks) {
  WriteMotion(Path("whole.mcap"), 450, true, /*compress=*/true);
  const std::string whole = Bytes(Path("whole.mcap"));
  const auto summary = mcap::ReadSummary(whole);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  ASSERT_GT(summary->chunks.size(), 3u);
  for (std::size_t cut = 8; cut < whole.size(); cut += 331) {
    Save(Path("cut.mcap"), whole.substr(0, cut));
    const auto report = Repair(Path("cut.mcap"), Path("repaired.mcap"), "test", true);
    ASSERT_TRUE(report.ok()) << report.error().message;
    std::size_t chunks = 0;
    for (const mcap::ChunkIndex& chunk : summary->chunks) {
      chunks += chunk.chunk_offset + chunk.chunk_length <= cut ? 1 : 0;
    }
    // A chunk has a second: 101 ticks of 10 ms, the last one fewer.
    const std::string repaired = Bytes(Path("repaired.mcap"));
    ASSERT_EQ(Read(repaired).size(), std::min<std::size_t>(101 * chunks, 450)) << cut;
    const auto again = mcap::ReadSummary(repaired);
    ASSERT_TRUE(again.ok()) << again.error().message;
    if (chunks > 0) {
      EXPECT_EQ(again->chunks[0].compression, "zstd");
    }
  }
}

TEST_F(Recording, ADamagedCompressedChunkIsLeftOutAndTheRestIsRead) {
  WriteMotion(Path("whole.mcap"), 450, true, /*compress=*/true);
  const std::string whole = Bytes(Path("whole.mcap"));
  const auto summary = mcap::ReadSummary(whole);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  const mcap::ChunkIndex& second = summary->chunks.at(1);
  const std::size_t at = second.chunk_offset + second.chunk_length;
  for (std::size_t behind = 1; behind < second.compressed_size; behind += 7) {
    std::string bytes = whole;
    bytes[at - behind] = static_cast<char>(bytes[at - behind] ^ 0x55);
    Save(Path("damaged.mcap"), bytes);
    const auto report = Repair(Path("damaged.mcap"), Path("repaired.mcap"), "test", true);
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_EQ(report->found.damaged_chunks, 1u) << behind;
    EXPECT_EQ(report->missing_ticks, 101u);
  }
  // A chunk that claims to be larger than a file may be is refused, whatever memory there is.
  mcap::Chunk chunk{0, 0, std::uint64_t{1} << 40, 1, "zstd", whole};
  std::string unpacked;
  EXPECT_FALSE(mcap::Unpack(chunk, unpacked).has_value());
  EXPECT_TRUE(unpacked.empty());
}

}  // namespace
}  // namespace footing::recording
