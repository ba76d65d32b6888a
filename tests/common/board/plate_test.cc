#include "common/board/plate.h"

#include <gtest/gtest.h>

namespace footing::board {
namespace {

TEST(Plate, CentreOfPressureIsUnderTheLoadedCorner) {
  Plate plate;
  const PlateReading right_front = plate.Advance({0, 600, 0, 0});
  ASSERT_TRUE(right_front.cop_valid);
  EXPECT_DOUBLE_EQ(right_front.total_n, 600);
  EXPECT_DOUBLE_EQ(right_front.cop_x_m, 0.433 / 2);
  EXPECT_DOUBLE_EQ(right_front.cop_y_m, 0.238 / 2);
  const PlateReading left_rear = plate.Advance({0, 0, 600, 0});
  EXPECT_DOUBLE_EQ(left_rear.cop_x_m, -0.433 / 2);
  EXPECT_DOUBLE_EQ(left_rear.cop_y_m, -0.238 / 2);
}

TEST(Plate, CentreOfPressureIsTheWeightedMeanOfTheCorners) {
  Plate plate;
  // x: (300 - 100) / 400 of half the width; y: (250 - 150) / 400 of half the depth.
  const PlateReading reading = plate.Advance({60, 190, 40, 110});
  EXPECT_DOUBLE_EQ(reading.cop_x_m, 0.433 / 2 * (300.0 - 100.0) / 400.0);
  EXPECT_DOUBLE_EQ(reading.cop_y_m, 0.238 / 2 * (250.0 - 150.0) / 400.0);
}

TEST(Plate, EmptyOrNegativeItHasNoCentreOfPressureAndNoContact) {
  Plate plate;
  for (const double corner : {0.0, 0.3, -5.0, 12.0}) {
    const PlateReading reading = plate.Advance({corner, corner, corner, corner});
    EXPECT_FALSE(reading.cop_valid);
    EXPECT_FALSE(reading.contact);
    EXPECT_EQ(reading.cop_x_m, 0);
    EXPECT_EQ(reading.cop_y_m, 0);
  }
}

TEST(Plate, ContactBeginsAboveOneBorderAndEndsBelowAnother) {
  const PlateConfig config;  // On at 68.6 N, off at 49 N.
  Plate plate(config);
  const auto contact = [&plate](double total_n) {
    return plate.Advance({total_n, 0, 0, 0}).contact;
  };
  EXPECT_FALSE(contact(60));
  EXPECT_TRUE(contact(70));
  EXPECT_TRUE(contact(60));
  EXPECT_TRUE(contact(50));
  EXPECT_FALSE(contact(48));
  EXPECT_FALSE(contact(60));
}

TEST(Plate, TheSameReadingAgainIsARepeat) {
  Plate plate;
  EXPECT_FALSE(plate.Advance({0, 0, 0, 0}).repeated);
  EXPECT_TRUE(plate.Advance({0, 0, 0, 0}).repeated);
  EXPECT_FALSE(plate.Advance({0, 0, 0, 1e-9}).repeated);
}

}  // namespace
}  // namespace footing::board
