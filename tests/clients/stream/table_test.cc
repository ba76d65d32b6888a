#include "clients/stream/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::stream_client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Table, AHeaderAndEmptyLinesAreNoRows) {
  const auto table = ParseTable("ax,ay,az\r\n1,2,3\r\n\n-4.5, 5e-1 ,6\n", 3, "f");
  ASSERT_TRUE(table);
  EXPECT_THAT(table->rows, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(-4.5, 0.5, 6)));
}

TEST(Table, TheFaultyLineIsNamed) {
  for (const char* text : {"1,2,3\n1,2\n", "1,2,3\n1,2,3,4\n", "1,2,3\n1,x,3\n", "1,2,3\n1,nan,3\n",
                           "1,2,3\n1,inf,3\n", "1,2,3\n1,,3\n"}) {
    const auto table = ParseTable(text, 3, "some.csv");
    ASSERT_FALSE(table) << text;
    EXPECT_EQ(table.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(table.error().message, HasSubstr("some.csv, line 2")) << text;
  }
}

TEST(Table, WithoutRowsIsInvalid) {
  EXPECT_FALSE(ParseTable("", 3, "f"));
  EXPECT_FALSE(ParseTable("ax,ay,az\n", 3, "f"));
}

}  // namespace
}  // namespace footing::stream_client
