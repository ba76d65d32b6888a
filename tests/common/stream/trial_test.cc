#include "common/stream/trial.h"

#include <gtest/gtest.h>

#include "common/stream/track.h"

namespace footing::stream {
namespace {

TEST(FailureCounts, EachCauseHasItsOwnCountAndName) {
  FailureCounts counts;
  std::uint64_t value = 1;
  for (const FailureCause cause : kFailureCauses) {
    *MutableCountOf(cause, counts) = value;
    value *= 10;
  }
  EXPECT_EQ(counts, (FailureCounts{1, 10, 100, 1000, 10000}));
  EXPECT_EQ(CountOf(FailureCause::kStraightness, counts), 1000u);
  EXPECT_EQ(Total(counts), 11111u);
  EXPECT_STREQ(Name(FailureCause::kTransition), "transition");
  EXPECT_EQ(MutableCountOf(FailureCause::kUnspecified, counts), nullptr);
  EXPECT_EQ(CountOf(FailureCause::kUnspecified, counts), 0u);
}

TEST(Instruction, SaysWhatComesBeforeTheLineAndWhatBehindIt) {
  EXPECT_EQ(InstructionFor(Gait::kWalk, Gait::kRun), "walk to the line, then run");
  EXPECT_EQ(InstructionFor(Gait::kRun, Gait::kStep), "run to the line, then stop");
  EXPECT_EQ(InstructionFor(Gait::kUnspecified, Gait::kJump), "to the line, then jump");
}

}  // namespace
}  // namespace footing::stream
