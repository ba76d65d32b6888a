#include "clients/study/simulate_study.h"

#include <gtest/gtest.h>

namespace footing::study::simulate {
namespace {

TEST(ProgressText, TheTimeLeftIsWhatTheOthersTakeSideBySide) {
  // 13 of 62 s each, two at once: 13 / 2 * 62 s = 6.7 min.
  EXPECT_EQ(ProgressText({.ended = 3, .all = 16, .at_once = 2, .mean_s = 62}),
            ", 3 of 16 sessions; about 7 min left");
  // 4 / 2 * 17 s = 34 s, in steps of 10 s.
  EXPECT_EQ(ProgressText({.ended = 1, .all = 5, .at_once = 2, .mean_s = 17}),
            ", 1 of 5 sessions; about 40 s left");
  // Another processor does not help the last one.
  EXPECT_EQ(ProgressText({.ended = 4, .all = 5, .at_once = 8, .mean_s = 20}),
            ", 4 of 5 sessions; about 20 s left");
}

TEST(ProgressText, AfterTheLastSessionNoTimeIsLeft) {
  EXPECT_EQ(ProgressText({.ended = 1, .all = 1, .at_once = 2, .mean_s = 60}), ", 1 of 1 session");
  EXPECT_EQ(ProgressText({.ended = 16, .all = 16, .at_once = 2, .mean_s = 60}),
            ", 16 of 16 sessions");
}

}  // namespace
}  // namespace footing::study::simulate
