#include "common/text/lines.h"

#include <gtest/gtest.h>

namespace footing::text {
namespace {

TEST(Lines, LinesEndInAnyWayAndAreCounted) {
  text::Lines lines("one\r\n\n  \ntwo", "f.txt");
  EXPECT_EQ(lines.NextFull(), "one");
  EXPECT_EQ(lines.NextFull(), "two");
  EXPECT_EQ(lines.Fault("bad").message, "f.txt, line 4: bad");
  EXPECT_FALSE(lines.Next().has_value());
}

TEST(Lines, RowsLeaveOutBlanksAndComments) {
  Lines lines("# a comment\n\n  # another\n1,2\n", "f.csv");
  EXPECT_EQ(lines.NextRow(), "1,2");
  EXPECT_EQ(lines.Fault("bad").message, "f.csv, line 4: bad");
  EXPECT_FALSE(lines.NextRow().has_value());
}

}  // namespace
}  // namespace footing::text
