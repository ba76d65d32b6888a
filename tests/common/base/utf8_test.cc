#include "common/base/utf8.h"

#include <gtest/gtest.h>

namespace footing::text {
namespace {

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
