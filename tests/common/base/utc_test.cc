#include "common/base/utc.h"

#include <gtest/gtest.h>

namespace footing::text {
namespace {

TEST(Utc, IsIso8601WithTheDecimalsAskedFor) {
  constexpr std::int64_t kNs = 1'763'818'728'123'456'789;  // date -u -d @1763818728
  EXPECT_EQ(Utc(kNs), "2025-11-22T13:38:48Z");
  EXPECT_EQ(Utc(kNs, 6), "2025-11-22T13:38:48.123456Z");
  EXPECT_EQ(Utc(kNs, 12), "2025-11-22T13:38:48.123456789Z");
}

TEST(Utc, PadsTheDecimalsAndKnowsInstantsBefore1970) {
  EXPECT_EQ(Utc(1'000'000, 6), "1970-01-01T00:00:00.001000Z");
  EXPECT_EQ(Utc(-1, 3), "1969-12-31T23:59:59.999Z");
}

}  // namespace
}  // namespace footing::text
