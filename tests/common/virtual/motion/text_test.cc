#include "common/virtual/motion/text.h"

#include <gtest/gtest.h>

namespace footing::motion {
namespace {

TEST(Text, NumbersAreWholeWordsAndFinite) {
  EXPECT_EQ(ToNumber("-1.5e-3"), -0.0015);
  EXPECT_EQ(ToNumber("+2"), 2);
  EXPECT_EQ(ToNumber("1e-999"), 0);
  for (const char* word : {"", "1.5x", "nan", "inf", "1e999", "0x10", "+-1", " 1"}) {
    EXPECT_FALSE(ToNumber(word).has_value()) << word;
  }
  EXPECT_EQ(ToCount("12"), 12u);
  EXPECT_FALSE(ToCount("-1").has_value());
  EXPECT_FALSE(ToCount("99999999999999999999").has_value());
}

TEST(Text, LinesEndInAnyWayAndAreCounted) {
  Lines lines("one\r\n\n  \ntwo", "f.txt");
  EXPECT_EQ(lines.NextFull(), "one");
  EXPECT_EQ(lines.NextFull(), "two");
  EXPECT_EQ(lines.Fault("bad").message, "f.txt, line 4: bad");
  EXPECT_FALSE(lines.Next().has_value());
}

TEST(Text, MinusZeroIsWrittenAsZero) {
  std::string text;
  AppendFixed(text, -1e-9, 3);
  EXPECT_EQ(text, "0.000");
}

}  // namespace
}  // namespace footing::motion
