#include "common/stream/response.h"

#include <gtest/gtest.h>

namespace footing::stream {
namespace {

TEST(ResponseTimes, AreTheDifferencesOfTheStamps) {
  const ResponseStages stamps{Gait::kWalk, Gait::kRun, 1'000'000,   1'500'000,  3'500'000,
                              4'000'000,   5'000'000,  105'000'000, 112'000'000};
  const auto stages = ResponseTimes(stamps);
  ASSERT_EQ(stages.size(), 6u);
  EXPECT_STREQ(stages[0].name, "decode");
  EXPECT_DOUBLE_EQ(stages[0].ms, 0.5);
  EXPECT_STREQ(stages[4].name, "contact");
  EXPECT_DOUBLE_EQ(stages[4].ms, 100);
  EXPECT_TRUE(ResponseTimes({}).empty());
}

}  // namespace
}  // namespace footing::stream
