#include "common/recording/repair.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/recording/mcap_reader.h"
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

}  // namespace
}  // namespace footing::recording
