#include <gtest/gtest.h>

#include "common/recording/encode.h"
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

}  // namespace
}  // namespace footing::mcap
