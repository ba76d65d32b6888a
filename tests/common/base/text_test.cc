#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/text.h"

namespace footing::text {
namespace {

using testing::ElementsAre;

TEST(Text, LowersAsciiLettersOnly) {
  EXPECT_EQ(Lower("A b-C9.PNG"), "a b-c9.png");
  EXPECT_EQ(Lower("\xc3\x84"), "\xc3\x84");  // A capital umlaut stays.
}

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

TEST(Utf8, SequencesHaveOneToFourBytes) {
  EXPECT_EQ(SequenceLength("a", 0), 1u);
  EXPECT_EQ(SequenceLength("xé", 1), 2u);
  EXPECT_EQ(SequenceLength("€", 0), 3u);
  EXPECT_EQ(SequenceLength("𝄞", 0), 4u);
  EXPECT_EQ(SequenceLength("𝄞", 1), 0u);  // In the middle of it.
  EXPECT_EQ(SequenceLength("\xc0\x80", 0), 0u);
}

TEST(Utf8, CharactersCountCodePointsAndStrayBytes) {
  EXPECT_EQ(Characters(""), 0u);
  EXPECT_EQ(Characters("Müller"), 6u);
  EXPECT_EQ(Characters("a\xff\xffz"), 4u);
  EXPECT_TRUE(IsUtf8("Grüße €, 𝄞"));
  EXPECT_FALSE(
      IsUtf8("Gr\xfc\xdf"
             "e"));
}

TEST(Utf8, PrintableTextHasNoControlCharacters) {
  for (const char* text : {"", "left player", "Grüße €, 𝄞", "\u00a0"}) {
    EXPECT_TRUE(IsPrintable(text)) << text;
  }
  for (const char* text : {"a\nb", "\t", "\x1b[2J", "\x7f", "\u0080", "\u009b2J", "a\xff"}) {
    EXPECT_FALSE(IsPrintable(text)) << text;
  }
  EXPECT_FALSE(IsPrintable(std::string_view("\0", 1)));
}

}  // namespace
}  // namespace footing::text
