#include "daemon/sensor/reports/camera.h"

#include <gtest/gtest.h>

namespace footing::reports {
namespace {

using Block = std::vector<std::uint8_t>;

void ExpectPoint(const stream::CameraPoint& point, unsigned x, unsigned y, unsigned size) {
  EXPECT_EQ(point.x, x);
  EXPECT_EQ(point.y, y);
  EXPECT_EQ(point.size, size);
}

TEST(Camera, BasicFormatHasTwoPointsInFiveBytes) {
  // (0x312, 0x234) and (0x145, 0x067): upper bits y1 2, x1 3, y2 0, x2 1.
  const Block first = {0x12, 0x34, 0b10'11'00'01, 0x45, 0x67};
  Block camera = first;
  camera.insert(camera.end(), 5, 0xff);
  const auto points = DecodeCamera(camera);
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], 0x312, 0x234, 0);
  ExpectPoint(points[1], 0x145, 0x067, 0);
}

TEST(Camera, ExtendedFormatHasSizes) {
  Block camera(12, 0xff);
  camera[3] = 0x12;
  camera[4] = 0x34;
  camera[5] = 0b10'11'0101;
  const auto points = DecodeCamera(camera);
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], 0x312, 0x234, 5);
}

TEST(Camera, FullFormatIsReadInHalvesAndWhole) {
  Block half = {0x12, 0x34, 0b10'11'0101, 1, 2, 3, 4, 0, 99};
  half.insert(half.end(), 9, 0xff);
  ASSERT_EQ(DecodeCamera(half).size(), 1u);
  ExpectPoint(DecodeCamera(half)[0], 0x312, 0x234, 5);
  Block whole = half;
  whole.insert(whole.end(), half.begin(), half.end());
  EXPECT_EQ(DecodeCamera(whole).size(), 2u);
}

TEST(Camera, SeesNothingWithoutPointsOrFormat) {
  for (const std::size_t size : {0u, 1u, 10u, 11u, 12u, 18u, 21u, 36u}) {
    EXPECT_TRUE(DecodeCamera(Block(size, 0xff)).empty()) << size;
  }
  EXPECT_TRUE(DecodeCamera(Block(11, 0x00)).empty());
}

TEST(Camera, ARowBelowThePictureIsNotSeen) {
  Block camera(12, 0xff);
  camera[0] = 0x00;
  camera[1] = 0x00;
  camera[2] = 0b11'00'0001;  // Row 768, the first below.
  EXPECT_TRUE(DecodeCamera(camera).empty());
  camera[1] = 0xff;
  camera[2] = 0b10'00'0001;  // Row 767, the last.
  EXPECT_EQ(DecodeCamera(camera).size(), 1u);
}

}  // namespace
}  // namespace footing::reports
