#include <gtest/gtest.h>

#include <cmath>

#include "common/motion/edit.h"
#include "common/motion_files/load.h"
#include "common/units/units.h"
#include "common/virtual_sensors/ground_reaction.h"
#include "tests/common/motion/shared_data.h"

namespace footing::virtual_sensors {
namespace {

constexpr double kMassKg = 60;  // By the same plates under the standing subject (static1).

/// What the plates of a trial felt together around one instant of the motion.
struct Felt {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
};

Felt Mean(const motion::GroundForces& forces, double at_s, double span_s) {
  const auto first = static_cast<Eigen::Index>(
      std::lround((at_s - 0.5 * span_s - forces.start_s) * forces.rate_hz));
  const auto count = static_cast<Eigen::Index>(std::lround(span_s * forces.rate_hz)) + 1;
  Felt felt;
  for (Eigen::Index i = first; i < first + count; ++i)
    for (const auto& plate : forces.plates) {
      felt.load_n += plate.force_W(2, i) / static_cast<double>(count);
      felt.cop_m += plate.force_W(2, i) * plate.cop_W.col(i).head<2>() / static_cast<double>(count);
    }
  felt.cop_m /= felt.load_n;
  return felt;
}

/// Forces made from the markers of squats against the plates under them. The filters' constants
/// are older than this test. Measured when it was written: 1.6 % of the weight, 0.8 cm sideways,
/// 2.6 cm fore and aft about a constant 2.4 cm.
TEST(React, GivesTheForcesOfRealPlatesUnderSquats) {
  SKIP_WITHOUT_SHARED_DATA();
  const std::string folder = motion::test::SharedData() + "/forces/opencap_s4/";
  const auto loaded = motion_files::LoadMotion(folder + "MarkerData/squats1.trc",
                                               {.still = folder + "MarkerData/static1.trc"});
  const auto forces = motion_files::LoadForces(folder + "ID/squats1_grf.mot");
  ASSERT_TRUE(loaded && forces);
  body::PersonParameters person;
  person.mass_kg = kMassKg;
  person.height_m = loaded->height_m;
  const auto body = body::MakeBody(loaded->motion.skeleton, person);
  ASSERT_TRUE(body);
  const motion::Motion motion = motion::Continuous(loaded->motion);
  const GroundReaction reaction = React(Follow(*body, motion));

  double load = 0, count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), square = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 30; i + 30 < motion.frames(); ++i) {
    const double at_s = motion.start_s + static_cast<double>(i) / motion.rate_hz;
    const Felt felt = Mean(*forces, at_s, 1 / motion.rate_hz);
    const Eigen::Vector2d off = reaction.cop_m.col(i) - felt.cop_m;
    load += std::pow(reaction.force_n(2, i) - felt.load_n, 2);
    sum += off;
    square += off.cwiseAbs2();
    ++count;
  }
  ASSERT_GT(count, 1000);
  const double weight_n = kMassKg * kStandardGravityMps2;
  const Eigen::Vector2d bias = sum / count;
  const Eigen::Vector2d sd = (square / count - bias.cwiseAbs2()).cwiseSqrt();
  EXPECT_LT(std::sqrt(load / count), 0.018 * weight_n);
  EXPECT_LT(sd.y(), 0.010);
  EXPECT_LT(sd.x(), 0.029);
  EXPECT_LT(std::abs(bias.y()), 0.004);
  EXPECT_LT(std::abs(bias.x()), 0.028);
}

}  // namespace
}  // namespace footing::virtual_sensors
