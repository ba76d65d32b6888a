#include "common/base/lines.h"

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

TEST(Lines, AByteOrderMarkIsNoPartOfTheFirstLine) {
  Lines lines("\xEF\xBB\xBFHIERARCHY\n", "f.bvh");
  EXPECT_EQ(lines.Next(), "HIERARCHY");
}

TEST(Lines, RowsLeaveOutBlanksAndComments) {
  Lines lines("# a comment\n\n  # another\n1,2\n", "f.csv");
  EXPECT_EQ(lines.NextRow(), "1,2");
  EXPECT_EQ(lines.Fault("bad").message, "f.csv, line 4: bad");
  EXPECT_FALSE(lines.NextRow().has_value());
}

TEST(Lines, QuotedWordsKeepTheirLanguageAndLoseControls) {
  EXPECT_EQ(Quoted("Größe 𝄞"), "'Größe 𝄞'");
  EXPECT_EQ(Quoted("a\x1b[2J\tb"), "'a?[2J?b'");
  EXPECT_EQ(Quoted("a\xc2\x9b\xff"),
            "'a?"
            "?'");  // A control of 8 bits; a byte of Latin-1.
  EXPECT_EQ(Quoted("a\xe2\x82"),
            "'a?"
            "?'");  // Cut short.
  std::string word;
  for (int i = 0; i < 40; ++i) word += "ü";
  EXPECT_EQ(Quoted(word), "'" + word + "'");
  EXPECT_EQ(Quoted(word + "ü"), "'" + word + "...'");
}

}  // namespace
}  // namespace footing::text
