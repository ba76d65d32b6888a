#include "common/base/json_text.h"

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

TEST(JsonText, AKeyThatOneObjectHasTwiceIsRefused) {
  for (const char* text :
       {"{\"a\": 1, \"b\": 2, \"a\": 3}", "[0, {\"c\": {\"a\": 1, \"a\": 1}}]"}) {
    const auto json = ParseJson(text, "a.json");
    ASSERT_FALSE(json.ok()) << text;
    EXPECT_EQ(json.error().kind, ErrorKind::kInvalidData);
    EXPECT_EQ(json.error().message,
              "a.json has the key 'a' twice in one object; leave one of them out");
    EXPECT_FALSE(ParseOrderedJson(text, "a.json").ok());
  }
  // Keys of different objects, one within the other.
  const auto json =
      ParseOrderedJson("{\"b\": {\"a\": 1}, \"a\": [{\"a\": 2}, {\"a\": 3}]}", "a.json");
  ASSERT_TRUE(json.ok()) << json.error().message;
  EXPECT_EQ(json->dump(), "{\"b\":{\"a\":1},\"a\":[{\"a\":2},{\"a\":3}]}");
}

}  // namespace
}  // namespace footing::text
