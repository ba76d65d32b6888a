#include "common/base/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/fnv.h"
#include "common/base/quantile.h"

namespace footing::text {
namespace {

using testing::ElementsAre;

TEST(Csv, CellsAreTrimmedAndEmptyOnesCount) {
  EXPECT_THAT(Cells(" 1,\t2 ,,"), ElementsAre("1", "2", "", ""));
}

TEST(Csv, ARowHasThisManyNumbers) {
  const auto row = NumberRow("1, -2.5 ,3e2", 3);
  ASSERT_TRUE(row);
  EXPECT_THAT(*row, ElementsAre(1, -2.5, 300));
  EXPECT_EQ(NumberRow("1,2", 3).error().message, "2 cells where 3 belong");
  for (const char* line : {"1,x,3", "1,nan,3", "1,,3", "1,2e9,3", "1,inf,3"}) {
    const auto wrong = NumberRow(line, 3);
    ASSERT_FALSE(wrong) << line;
    EXPECT_EQ(wrong.error().kind, ErrorKind::kInvalidData);
  }
}

TEST(Quantile, IsOneOfTheValues) {
  const std::vector<double> values{5, 1, 4, 2, 3, 6, 7, 8, 10, 9};
  EXPECT_EQ(Quantile(values, 0), 1);
  EXPECT_EQ(Quantile(values, 0.95), 10);  // Rank floor(9.5).
  EXPECT_EQ(Quantile(values, 1), 10);
  EXPECT_EQ(Median(values), 6);
  EXPECT_EQ(Median({}), 0);
  EXPECT_EQ(OfRank(values, 3), 4);
}

TEST(Fnv, OrderMatters) {
  EXPECT_EQ(AddFnv(kFnvBasis, 0), kFnvBasis * 1099511628211u);
  EXPECT_NE(AddFnv(AddFnv(kFnvBasis, 1), 2), AddFnv(AddFnv(kFnvBasis, 2), 1));
}

}  // namespace
}  // namespace footing::text
