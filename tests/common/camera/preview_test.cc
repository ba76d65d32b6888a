#include "common/camera/preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::preview {
namespace {

using testing::HasSubstr;

Picture Sample() {
  Picture picture;
  picture.number = 0x0102030405060708;
  picture.exposed_ns = 52120000000;
  picture.camera_width = 8;
  picture.camera_height = 4;
  picture.has_pose = true;
  picture.spheres = {
      {stream::DeviceRole::kLeftHand, Sight::kSeen, true, false, 0.75f, 1.5f, {3.5f, 2.25f, 1}},
      {stream::DeviceRole::kRightHand, Sight::kChecking, false, true, 0, 0, {}}};
  picture.refused = {{stream::DeviceRole::kRightHand, {6, 1, 2}}};
  picture.width = 4;
  picture.height = 2;
  for (std::uint8_t i = 0; i < 24; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(10 * i));
  return picture;
}

void ExpectSame(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.exposed_ns, b.exposed_ns);
  EXPECT_EQ(a.camera_width, b.camera_width);
  EXPECT_EQ(a.camera_height, b.camera_height);
  EXPECT_EQ(a.has_pose, b.has_pose);
  EXPECT_EQ(a.simulated, b.simulated);
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    EXPECT_EQ(a.spheres[i].role, b.spheres[i].role);
    EXPECT_EQ(a.spheres[i].sight, b.spheres[i].sight);
    EXPECT_EQ(a.spheres[i].is_saturated, b.spheres[i].is_saturated);
    EXPECT_EQ(a.spheres[i].is_occluded, b.spheres[i].is_occluded);
    EXPECT_EQ(a.spheres[i].confidence, b.spheres[i].confidence);
    EXPECT_EQ(a.spheres[i].range_m, b.spheres[i].range_m);
    EXPECT_EQ(a.spheres[i].circle.v_px, b.spheres[i].circle.v_px);
  }
  ASSERT_EQ(a.refused.size(), b.refused.size());
  EXPECT_EQ(a.refused[0].role, b.refused[0].role);
  EXPECT_EQ(a.refused[0].circle.radius_px, b.refused[0].circle.radius_px);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.rgb, b.rgb);
}

TEST(Preview, PicturesComeBackAsTheyWereHoweverTheBytesAreCut) {
  const std::string bytes = Encode(Sample()) + EncodeRefusal("full") + Encode(Sample());
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, bytes.size()}) {
    PreviewReader reader;
    std::vector<Message> messages;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.Add(std::string_view(bytes).substr(at, piece));
      for (;;) {
        const auto next = reader.Next();
        ASSERT_TRUE(next) << next.error().message;
        if (!*next) break;
        messages.push_back(**next);
      }
    }
    ASSERT_EQ(messages.size(), 3u);
    ExpectSame(std::get<Picture>(messages[0]), Sample());
    EXPECT_EQ(std::get<Refusal>(messages[1]).why, "full");
    ExpectSame(std::get<Picture>(messages[2]), Sample());
  }
}

TEST(Preview, TheBytesAreThoseOfTheDocumentation) {
  const std::string bytes = Encode(Sample());
  // 12 of the header, 28 fixed, 2 spheres of 24, 1 light of 16, 4 x 2 pixels of 3.
  ASSERT_EQ(bytes.size(), 12u + 28 + 2 * 24 + 16 + 24);
  EXPECT_EQ(bytes.substr(0, 12), std::string("FCP1\x01\0\0\0\x74\0\0\0", 12));
  EXPECT_EQ(bytes.substr(12, 8), std::string("\x08\x07\x06\x05\x04\x03\x02\x01", 8));
  EXPECT_EQ(bytes.substr(28, 12), std::string("\x08\0\x04\0\x04\0\x02\0\x01\0\x02\x01", 12));
  // Left hand, seen, saturated; 0.75 = 0x3f400000, 1.5 = 0x3fc00000.
  EXPECT_EQ(bytes.substr(40, 12), std::string("\x01\x03\x01\0\0\0\x40\x3f\0\0\xc0\x3f", 12));
}

TEST(Preview, WhatIsMoreThanTheLimitsIsLeftOut) {
  Picture picture = Sample();
  picture.spheres.resize(kMaxSpheres + 3);
  picture.refused.resize(kMaxRefused + 300);
  PreviewReader reader;
  reader.Add(Encode(picture));
  const auto next = reader.Next();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ(std::get<Picture>(**next).spheres.size(), kMaxSpheres);
  EXPECT_EQ(std::get<Picture>(**next).refused.size(), kMaxRefused);
}

TEST(Preview, EveryDamageIsAnErrorOrANumberWithinItsBounds) {
  const std::string whole = Encode(Sample());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char byte : {'\0', '\x7f', '\xff'}) {
      std::string bytes = whole;
      bytes[at] = byte;
      PreviewReader reader;
      reader.Add(bytes);
      const auto next = reader.Next();
      if (!next || !*next) continue;
      const Picture& picture = std::get<Picture>(**next);
      EXPECT_EQ(picture.rgb.size(), static_cast<std::size_t>(3 * picture.width * picture.height));
      for (const Sphere& sphere : picture.spheres) {
        EXPECT_TRUE(sphere.confidence >= 0 && sphere.confidence <= 1);
        EXPECT_TRUE(sphere.circle.radius_px >= 0 && sphere.circle.radius_px < 1e6f);
        EXPECT_LE(sphere.sight, Sight::kSeen);
      }
    }
  }
}

TEST(Preview, OtherBytesAreRefusedBeforeAnythingIsHeldOfThem) {
  const auto error = [](const std::string& bytes) {
    PreviewReader reader;
    reader.Add(bytes);
    const auto next = reader.Next();
    return next ? std::string("none") : next.error().message;
  };
  EXPECT_THAT(error("HTTP/1.1 200 OK"), HasSubstr("does not begin with FCP1"));
  EXPECT_THAT(error(std::string("FCP1\x01\0\0\0\xff\xff\xff\x7f", 12)), HasSubstr("2147483647"));
  EXPECT_THAT(error(std::string("FCP1\x02\0\0\0\x01\x02\0\0", 12)), HasSubstr("513 bytes"));
  EXPECT_THAT(error(std::string("FCP1\x09\0\0\0\x01\0\0\0", 12)), HasSubstr("kind 9"));
  EXPECT_THAT(error(std::string("FCP1\x01\0\0\0\x01\0\0\0z", 13)), HasSubstr("1 bytes"));
  EXPECT_EQ(error("FC"), "none");
}

TEST(Preview, ARefusalHoldsOnlyWhatAScreenCanShow) {
  PreviewReader reader;
  reader.Add(EncodeRefusal("full\x1b[2J\n"));
  const auto next = reader.Next();
  ASSERT_TRUE(next && *next);
  EXPECT_EQ(std::get<Refusal>(**next).why, "full?[2J?");
}

}  // namespace
}  // namespace footing::preview
