#include "common/runtime/subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/common/temporary_folder.h"

namespace footing::subject {
namespace {

using testing::HasSubstr;

struct SubjectFileTest : testing::Test {
  Result<Subject> Read(const std::string& text) {
    std::ofstream(path) << text;
    return ReadSubject(path);
  }

  const test::TemporaryFolder folder;
  const std::string path = folder.Path("subject.json");
};

TEST_F(SubjectFileTest, CodeAndHeightAreEnough) {
  const auto subject = Read(R"({"code": "p07", "height_m": 1.81})");
  ASSERT_TRUE(subject.ok()) << subject.error().message;
  EXPECT_EQ(subject->code, "p07");
  EXPECT_DOUBLE_EQ(subject->height_m, 1.81);
  EXPECT_EQ(subject->mass_kg, 0);
}

TEST_F(SubjectFileTest, WhatIsMissingIsNamedWithItsRange) {
  EXPECT_THAT(Read(R"({"code": "p07"})").error().message, HasSubstr("height_m is missing"));
  EXPECT_THAT(Read(R"({"height_m": 1.8})").error().message, HasSubstr("code"));
}

TEST_F(SubjectFileTest, CentimetresPoundsAndUnknownKeysAreRefusedByName) {
  EXPECT_THAT(Read(R"({"code": "a", "height_m": 181})").error().message, HasSubstr("height_m"));
  EXPECT_THAT(Read(R"({"code": "a", "height_m": 1.8, "mass_kg": 400})").error().message,
              HasSubstr("mass_kg"));
  EXPECT_THAT(Read(R"({"code": "a", "height_m": 1.8, "shoe": 43})").error().message,
              HasSubstr("shoe"));
  EXPECT_THAT(Read(R"({"code": "../etc", "height_m": 1.8})").error().message, HasSubstr("letters"));
}

TEST_F(SubjectFileTest, AWrongFileIsInvalidDataAndErrorsListTheKeys) {
  for (const char* const wrong : {"height", "[]", R"({"code": "a", "height_m": 181})",
                                  R"({"code": "../etc", "height_m": 1.8})"})
    EXPECT_EQ(Read(wrong).error().kind, ErrorKind::kInvalidData) << wrong;
  const auto unknown = Read(R"({"code": "a", "height_m": 1.8, "shoe": 43})");
  EXPECT_THAT(unknown.error().message, HasSubstr("subject file: unknown key \"shoe\" in "));
  EXPECT_THAT(unknown.error().message,
              HasSubstr("there are: code, height_m, mass_kg, foot_length_m"));
}

TEST(Subject, NumbersThatAreNoneAreRefused) {
  EXPECT_FALSE(CheckSubject({"a", std::nan(""), 0, 0}, "here").ok());
  EXPECT_FALSE(CheckSubject({"a", 1.8, std::nan(""), 0}, "here").ok());
  EXPECT_TRUE(CheckSubject({"a", 1.8, 0, 0.26}, "here").ok());
}

}  // namespace
}  // namespace footing::subject
