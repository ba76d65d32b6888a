#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/model/model.h"

namespace footing::model {
namespace {

using testing::HasSubstr;

Model Good() {
  Model model{.kind = "cascade",
              .provenance = {},
              .tensors = {{.name = "a", .shape = {2, 3}, .values = {1, 2, 3, 4, 5, 6}},
                          {.name = "b", .shape = {1}, .values = {7}}}};
  model.provenance.subjects = {"13", "14"};
  return model;
}

std::string Refusal(const Model& model) {
  const Result<void> checked = Check(model, "m.fmodel");
  return checked.ok() ? "" : checked.error().message;
}

TEST(Model, IsGoodWhenEveryShapeFitsItsValues) { EXPECT_EQ(Refusal(Good()), ""); }

TEST(Model, WithAShapeThatDoesNotFitIsRefusedByTheTensorsName) {
  Model model = Good();
  model.tensors[0].shape = {3, 3};
  EXPECT_THAT(Refusal(model), HasSubstr("m.fmodel: tensor a: 6 values do not fit shape [3 x 3]"));
  model.tensors[0].shape = {};
  EXPECT_THAT(Refusal(model), HasSubstr("tensor a"));
  // The product is 0 modulo 2^64.
  model.tensors[0].values.clear();
  model.tensors[0].shape = {1u << 31, 1u << 31, 4};
  EXPECT_THAT(Refusal(model), HasSubstr("tensor a"));
}

TEST(Model, WithLabelsThatDoNotFitTheLastIndexIsRefused) {
  Model model = Good();
  model.tensors[0].labels = {"x", "y", "z"};
  EXPECT_EQ(Refusal(model), "");
  model.tensors[0].labels.pop_back();
  EXPECT_THAT(Refusal(model), HasSubstr("2 labels"));
}

TEST(Model, WithANumberThatIsNotFiniteIsRefused) {
  Model model = Good();
  model.tensors[1].values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(Refusal(model), HasSubstr("tensor b"));
}

TEST(Model, WithATensorTwiceOrWithoutANameOrWithoutAnyIsRefused) {
  Model model = Good();
  model.tensors[1].name = "a";
  EXPECT_THAT(Refusal(model), HasSubstr("twice"));
  model.tensors[1].name = "";
  EXPECT_THAT(Refusal(model), HasSubstr("has no name"));
  model.tensors.clear();
  EXPECT_THAT(Refusal(model), HasSubstr("no tensors"));
}

TEST(Model, IsNotJudgedOnAPersonItWasTrainedWith) {
  EXPECT_TRUE(CheckNotTrainedOn(Good(), "15", "m.fmodel").ok());
  const Result<void> refused = CheckNotTrainedOn(Good(), "14", "m.fmodel");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(refused.error().message, HasSubstr("was trained on subject 14"));
  EXPECT_FALSE(CheckNotTrainedOn(Good(), "014", "m.fmodel").ok());
  EXPECT_TRUE(CheckNotTrainedOn(Good(), "14b", "m.fmodel").ok());
  EXPECT_EQ(SubjectName("000"), "000");
  EXPECT_EQ(SubjectOfFile("013_29"), "13");
  EXPECT_EQ(SubjectOfFile("walk"), "walk");
  EXPECT_EQ(SubjectOfFile("HDM_bd_squat1Reps_001_120"), "HDM_bd");
  EXPECT_EQ(SubjectOfFile("HDM_bd"), "HDM_bd");
}

TEST(Model, OfAnotherKindIsRefused) {
  EXPECT_TRUE(CheckKind(Good(), "cascade", "m.fmodel").ok());
  const Result<void> refused = CheckKind(Good(), "basis", "m.fmodel");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("kind basis"));
}

TEST(Model, FindsATensorByNameAndShapeOnly) {
  const Model model = Good();
  ASSERT_TRUE(Find(model, "a", {2, 3}, "m.fmodel").ok());
  EXPECT_FALSE(Find(model, "a", {3, 2}, "m.fmodel").ok());
  EXPECT_THAT(Find(model, "c", {1}, "m.fmodel").error().message, HasSubstr("c is missing"));
}

TEST(Sha256, IsWhatTheStandardsExamplesSay) {
  // FIPS 180-2, appendix B, and NIST's example of no bytes.
  EXPECT_EQ(Hex(Sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Hex(Sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Hex(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Hex(Sha256(std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PadsEveryLengthAroundABlockWithAnotherResult) {
  // 55 bytes leave room for the length in the same block, 56 do not.
  EXPECT_EQ(Hex(Sha256(std::string(55, 'a'))),
            "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(Hex(Sha256(std::string(56, 'a'))),
            "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(Hex(Sha256(std::string(64, 'a'))),
            "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
}

}  // namespace
}  // namespace footing::model
