#include "common/wire/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "footing/v1/model.pb.h"

namespace footing::wire {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

model::Model Example() {
  return {
      .kind = "cascade",
      .provenance = {.program_version = "1.2.3",
                     .command = "footing-train cascade --data a.csv",
                     .seed = 18446744073709551615u,
                     .data = {{.name = "a.csv", .sha256 = model::Sha256("abc")}},
                     .subjects = {"13"}},
      .tensors = {{.name = "w", .shape = {2, 1}, .values = {0.1f, -2.5e-30f}, .labels = {"x"}}}};
}

std::string Bytes() { return ToModelFile(Example()).value(); }

/// The file again with a right checksum over other content.
std::string Sealed(v1::Model message) {
  message.clear_sha256();
  std::string bytes = message.SerializeAsString();
  const model::Digest digest = model::Sha256(bytes);
  return bytes + "\x7a\x20" + std::string(digest.begin(), digest.end());
}

std::string Refusal(const std::string& bytes) {
  const auto model = FromModelFile(bytes, "m.fmodel");
  EXPECT_TRUE(model.ok() || model.error().kind == ErrorKind::kInvalidData);
  return model.ok() ? "" : model.error().message;
}

TEST(ModelFile, GivesBackEveryFieldAndBit) {
  const auto read = FromModelFile(Bytes(), "m.fmodel");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->kind, "cascade");
  EXPECT_EQ(read->provenance.program_version, "1.2.3");
  EXPECT_EQ(read->provenance.command, "footing-train cascade --data a.csv");
  EXPECT_EQ(read->provenance.seed, 18446744073709551615u);
  ASSERT_EQ(read->provenance.data.size(), 1u);
  EXPECT_EQ(read->provenance.data[0].name, "a.csv");
  EXPECT_EQ(read->provenance.data[0].sha256, model::Sha256("abc"));
  EXPECT_THAT(read->provenance.subjects, ElementsAre("13"));
  ASSERT_EQ(read->tensors.size(), 1u);
  EXPECT_EQ(read->tensors[0].name, "w");
  EXPECT_THAT(read->tensors[0].shape, ElementsAre(2u, 1u));
  EXPECT_THAT(read->tensors[0].values, ElementsAre(0.1f, -2.5e-30f));
  EXPECT_THAT(read->tensors[0].labels, ElementsAre("x"));
}

TEST(ModelFile, IsOneMessageThatEndsInItsChecksum) {
  v1::Model message;
  ASSERT_TRUE(message.ParseFromString(Bytes()));
  EXPECT_EQ(message.version(), 1u);
  const std::string content = Bytes().substr(0, Bytes().size() - 34);
  const model::Digest digest = model::Sha256(content);
  EXPECT_EQ(message.sha256(), std::string(digest.begin(), digest.end()));
  EXPECT_EQ(Sealed(message), Bytes());
}

TEST(ModelFile, CutAtAnyByteIsRefused) {
  const std::string bytes = Bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THAT(Refusal(bytes.substr(0, size)), HasSubstr("m.fmodel")) << size;
  }
}

TEST(ModelFile, WithAnyBitFlippedIsRefused) {
  for (std::size_t bit = 0; bit < 8 * Bytes().size(); ++bit) {
    std::string bytes = Bytes();
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_THAT(Refusal(bytes), HasSubstr("m.fmodel")) << bit;
  }
}

TEST(ModelFile, OfAnUnknownVersionIsRefusedByIt) {
  v1::Model message;
  ASSERT_TRUE(message.ParseFromString(Bytes()));
  message.set_version(2);
  EXPECT_THAT(Refusal(Sealed(message)), HasSubstr("model version 2, this program reads version 1"));
}

TEST(ModelFile, WithContentThatMakesNoSenseIsRefusedThoughTheChecksumFits) {
  v1::Model good;
  ASSERT_TRUE(good.ParseFromString(Bytes()));
  v1::Model message = good;
  message.mutable_tensors(0)->set_shape(0, 3);
  EXPECT_THAT(Refusal(Sealed(message)), HasSubstr("tensor w"));
  message = good;
  message.mutable_tensors(0)->set_values(0, std::numeric_limits<float>::infinity());
  EXPECT_THAT(Refusal(Sealed(message)), HasSubstr("not finite"));
  message = good;
  message.mutable_provenance()->mutable_data(0)->set_sha256("short");
  EXPECT_THAT(Refusal(Sealed(message)), HasSubstr("5 bytes, not 32"));
}

TEST(ModelFile, OfMoreThanFourMegabytesIsRefused) {
  model::Model model = Example();
  model.tensors[0].shape = {1u << 20};
  model.tensors[0].labels.clear();
  model.tensors[0].values.assign(1u << 20, 1.f);
  EXPECT_THAT(ToModelFile(model).error().message, HasSubstr("train a smaller one"));
  EXPECT_THAT(Refusal(std::string(model::kMostFileBytes + 1, 'x')), HasSubstr("at most 4194304"));
}

}  // namespace
}  // namespace footing::wire
