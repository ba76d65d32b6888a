#include "daemon/offline/eval/report.h"

#include <gtest/gtest.h>

#include <sstream>

namespace footing::eval {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

TEST(Progress, ReportsAfterTwoSecondsAndThenEveryFive) {
  std::ostringstream out;
  Progress progress("gait", "trials", 20, 100 * kSecondNs);
  for (int i = 0; i < 20; ++i) progress.Done(i, (100 + i) * kSecondNs, out);
  EXPECT_EQ(out.str(),
            "gait: 2 of 20 trials\ngait: 7 of 20 trials\ngait: 12 of 20 trials\n"
            "gait: 17 of 20 trials\n");
}

TEST(Progress, IsSilentAboutWhatEndsAtOnce) {
  std::ostringstream out;
  Progress progress("gait", "trials", 3, 0);
  for (int i = 0; i < 3; ++i) progress.Done(i, i * kSecondNs / 2, out);
  EXPECT_EQ(out.str(), "");
}

TEST(Progress, CountsWholeUnits) {
  std::ostringstream out;
  Progress progress("monkey", "s simulated", 600, 0);
  progress.Done(119.99, 3 * kSecondNs, out);
  EXPECT_EQ(out.str(), "monkey: 119 of 600 s simulated\n");
}

}  // namespace
}  // namespace footing::eval
