#include "common/board/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/board/layout.h"

namespace footing::board {
namespace {

TEST(BoardGeometry, IsThatOfABalanceBoard) {
  EXPECT_EQ(kBalanceBoard, (stream::BoardGeometry{0.511, 0.316, 0.433, 0.238}));
  EXPECT_TRUE(IsSound(kBalanceBoard));
}

TEST(BoardGeometry, LengthsThatNoBoardHasAreNotSound) {
  for (const double bad :
       {0.0, -0.433, 0.099, 1.01, std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (double stream::BoardGeometry::*length :
         {&stream::BoardGeometry::plate_x_m, &stream::BoardGeometry::plate_y_m,
          &stream::BoardGeometry::sensor_distance_x_m,
          &stream::BoardGeometry::sensor_distance_y_m}) {
      stream::BoardGeometry geometry = kBalanceBoard;
      geometry.*length = bad;
      EXPECT_FALSE(IsSound(geometry)) << bad;
    }
  }
}

TEST(BoardGeometry, ABoardWithoutASoundPublishedOneIsABalanceBoard) {
  EXPECT_EQ(GeometryOr(std::nullopt), kBalanceBoard);
  const stream::BoardGeometry other{0.6, 0.4, 0.5, 0.3};
  EXPECT_EQ(GeometryOr(other), other);
  for (const double bad : {0.0, std::nan("")}) {
    EXPECT_EQ(GeometryOr(stream::BoardGeometry{0.6, 0.4, bad, 0.3}), kBalanceBoard);
  }
}

TEST(BoardGeometry, WithYawZeroTheFrontIsForward) {
  const Eigen::Vector2d at = InWorld({1, 2, 0}, 0.1, 0.2);
  EXPECT_NEAR(at.x(), 1.2, 1e-12);
  EXPECT_NEAR(at.y(), 1.9, 1e-12);  // Right is -y.
}

TEST(BoardGeometry, SensorsStandAtHalfTheirDistances) {
  const stream::BoardGeometry wide{0.511, 0.316, 0.866, 0.476};
  const auto places = SensorPlaces({1, 2, 0}, wide);
  EXPECT_NEAR(places[1].x(), 1 + 0.476 / 2, 1e-12);  // Top right.
  EXPECT_NEAR(places[1].y(), 2 - 0.866 / 2, 1e-12);
  EXPECT_NEAR(places[2].x(), 1 - 0.476 / 2, 1e-12);  // Bottom left.
  EXPECT_NEAR(places[2].y(), 2 + 0.866 / 2, 1e-12);
}

}  // namespace
}  // namespace footing::board
