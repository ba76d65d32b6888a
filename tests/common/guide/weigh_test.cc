#include "common/guide/board_steps.h"

#include <gtest/gtest.h>

namespace footing::guide {
namespace {

Load Force(double mean_n, double sd_n) {
  Load load;
  load.samples = 180;
  load.mean_n = mean_n;
  load.sd_n = sd_n;
  return load;
}

TEST(Weigh, AddsUpBothBoards) {
  // 70 kg: 70 * 9.80665 N = 686.4655 N.
  const Weight weight = Weigh({Force(343.2, 1.5), Force(343.2655, 1.5)}, std::nullopt);
  EXPECT_TRUE(weight.passed) << weight.note;
  EXPECT_NEAR(weight.mass_kg, 70, 1e-9);
  EXPECT_NEAR(weight.sd_kg, 3 / 9.80665, 1e-9);
}

TEST(Weigh, WaitsWhileThePersonMoves) {
  const Weight weight = Weigh({Force(686, 40)}, std::nullopt);
  EXPECT_FALSE(weight.done);
  EXPECT_FALSE(weight.passed);
}

TEST(Weigh, WaitsForSomebodyAndForSamples) {
  EXPECT_FALSE(Weigh({Force(20, 0.5)}, std::nullopt).done);
  EXPECT_FALSE(Weigh({Force(686, 1), Load{}}, std::nullopt).done);
}

TEST(Weigh, RefusesAWeightThatNoPersonHas) {
  const Weight weight = Weigh({Force(2200, 1)}, std::nullopt);
  EXPECT_TRUE(weight.done);
  EXPECT_FALSE(weight.passed);
  EXPECT_NE(weight.note.find("tare"), std::string::npos);
}

TEST(Weigh, ComparesWithTheGivenMass) {
  EXPECT_TRUE(Weigh({Force(686.4655, 2)}, 71.5).passed);  // Within 3 % of 71.5 kg.
  EXPECT_FALSE(Weigh({Force(686.4655, 2)}, 75).passed);   // 5 kg of 75 kg is 6.7 %.
  EXPECT_TRUE(Weigh({Force(196.133, 1)}, 21.5).passed);   // 20 kg: 2 kg are allowed.
}

}  // namespace
}  // namespace footing::guide
