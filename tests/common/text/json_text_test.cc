#include "common/text/json_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::text {
namespace {

using testing::HasSubstr;

TEST(JsonText, CommentsArePartOfAPersonsFile) {
  const auto json = ParseJson("{\n  // Metres.\n  \"height\": 1.7 /* tall */\n}\n", "a.json");
  ASSERT_TRUE(json.ok());
  EXPECT_EQ((*json)["height"], 1.7);
}

TEST(JsonText, TheErrorNamesFileLineAndColumn) {
  const auto json = ParseJson("{\n  \"height\": 1.7,\n  \"mass\" 70\n}\n", "a.json");
  ASSERT_FALSE(json.ok());
  EXPECT_EQ(json.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(json.error().message, HasSubstr("a.json is not JSON: parse error at line 3, column"));
  EXPECT_THAT(ParseJson("", "b.json").error().message, HasSubstr("b.json is not JSON"));
  EXPECT_FALSE(ParseJson("\xff\xfe", "c.json").ok());
}

}  // namespace
}  // namespace footing::text
