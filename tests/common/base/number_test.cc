#include "common/base/number.h"

#include <gtest/gtest.h>

namespace footing::text {
namespace {

TEST(Number, NumbersAreWholeWordsAndFinite) {
  EXPECT_EQ(text::ToNumber("-1.5e-3"), -0.0015);
  EXPECT_EQ(text::ToNumber("+2"), 2);
  EXPECT_EQ(text::ToNumber("1e-999"), 0);
  for (const char* word : {"", "1.5x", "nan", "inf", "1e999", "0x10", "+-1", " 1"}) {
    EXPECT_FALSE(text::ToNumber(word).has_value()) << word;
  }
  EXPECT_EQ(text::ToCount("12"), 12u);
  EXPECT_FALSE(text::ToCount("-1").has_value());
  EXPECT_FALSE(text::ToCount("99999999999999999999").has_value());
}

TEST(Number, MinusZeroIsWrittenAsZero) {
  std::string text;
  AppendFixed(text, -1e-9, 3);
  EXPECT_EQ(text, "0.000");
  EXPECT_EQ(Fixed(-0.04, 1), "0.0");
  EXPECT_EQ(Fixed(-0.06, 1), "-0.1");
}

TEST(Number, TheShortestTextReadsBackAsTheSameNumber) {
  EXPECT_EQ(Shortest(0.1), "0.1");
  EXPECT_EQ(Shortest(250), "250");
  EXPECT_EQ(ToNumber(Shortest(1.0 / 3)), 1.0 / 3);
}

}  // namespace
}  // namespace footing::text
