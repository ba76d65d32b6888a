#include "common/virtual/people/perform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/scene.h"

namespace footing::choreography {
namespace {

using body::Landmark;
using virtual_sensors::kFeet;

constexpr double kMassKg = 75;
constexpr double kRateHz = 100;

/// A carried script performed, with its forces.
class Performed {
 public:
  explicit Performed(const std::string& name) {
    const auto script = BuiltInScript(name);
    auto performer = Performer(1.75, kMassKg);
    EXPECT_TRUE(script && performer);
    performance = Perform(*script, *performer, kRateHz);
    virtual_sensors::SceneOptions options;
    options.t_pose = false;
    body::PersonParameters person;
    person.mass_kg = kMassKg;
    person.height_m = 1.75;
    auto made = virtual_sensors::MakeScene(performance.motion, person, options, name);
    EXPECT_TRUE(made) << made.error().message;
    scene = *std::move(made);
    feet = virtual_sensors::ShareThroughout(scene);
  }
  static const Performed& Of(const std::string& name) {
    static std::map<std::string, Performed> made;
    return made.try_emplace(name, name).first->second;
  }

  Performance performance;
  virtual_sensors::Scene scene;
  std::vector<std::array<virtual_sensors::FootForce, kFeet>> feet;
};

class CarriedMotion : public testing::TestWithParam<const char*> {
 protected:
  const Performed& made_ = Performed::Of(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Scripts, CarriedMotion, testing::Values("demo", "own_motion", "quiet"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(CarriedMotion, StaysWithinTheJointsLimits) {
  const body::Skeleton& skeleton = made_.scene.body.skeleton;
  const auto names = body::DofNames(skeleton);
  const Eigen::VectorXd lower = body::LowerLimits(skeleton), upper = body::UpperLimits(skeleton);
  const Eigen::MatrixXd& q = made_.performance.motion.q;
  ASSERT_TRUE(q.allFinite());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    EXPECT_GE(q.row(i).minCoeff(), lower(i) - 1e-6) << names[static_cast<std::size_t>(i)];
    EXPECT_LE(q.row(i).maxCoeff(), upper(i) + 1e-6) << names[static_cast<std::size_t>(i)];
  }
}

TEST_P(CarriedMotion, NoJointJumps) {
  const Eigen::MatrixXd& q = made_.performance.motion.q;
  const auto names = body::DofNames(made_.scene.body.skeleton);
  for (Eigen::Index i = 0; i < q.rows(); ++i)
    for (Eigen::Index k = 1; k < q.cols(); ++k)  // 25 rad/s: a fast punch has 15.
      ASSERT_LT(std::abs(q(i, k) - q(i, k - 1)), 0.25)
          << names[static_cast<std::size_t>(i)] << " at " << static_cast<double>(k) / kRateHz;
}

TEST_P(CarriedMotion, FeetThatCarryDoNotSlide) {
  EXPECT_LT(made_.performance.foot_error_m, 1e-5);
  const motion::Motion& motion = made_.performance.motion;
  body::Kinematics at(motion.skeleton);
  for (const Landmark ankle : {Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    const auto joint = static_cast<std::size_t>(made_.scene.body.landmarks[ankle]);
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    double ground_m = 0;
    for (Eigen::Index i = 0; i < motion.frames(); ++i) {
      body::ComputeKinematics(motion.skeleton, motion.q.col(i), at);
      const Eigen::Vector3d now = at.p_WJ[joint];
      if (i == 0) ground_m = now.z();
      EXPECT_GT(now.z(), ground_m - 1e-4);
      if (i > 0 && now.z() < ground_m + 5e-4) {
        ASSERT_LT((now - before).head<2>().norm() * kRateHz, 1e-3)
            << static_cast<double>(i) / kRateHz;
      }
      before = now;
    }
  }
}

TEST_P(CarriedMotion, TheGroundPushesAndIsPushedInsideTheSoles) {
  const auto& course = made_.scene.course;
  const auto& reaction = made_.scene.reaction;
  const double weight_n = kMassKg * kStandardGravityMps2;
  for (Eigen::Index i = 0; i < course.frames(); ++i) {
    const double at_s = static_cast<double>(i) / kRateHz;
    const Eigen::Vector3d force = reaction.force_n.col(i);
    ASSERT_GT(force.z(), 0.4 * weight_n) << at_s;
    ASSERT_LT(force.z(), 1.9 * weight_n) << at_s;
    ASSERT_LT(force.head<2>().norm(), 0.3 * force.z()) << at_s;  // Shoes do not slip.
    // ShareBetweenFeet can make the COP only when it is inside the hull of the soles that stand.
    Eigen::Vector2d cop = Eigen::Vector2d::Zero();
    for (const auto& foot : made_.feet[static_cast<std::size_t>(i)])
      cop += foot.load_n / force.z() * foot.cop_m;
    ASSERT_LT((cop - reaction.cop_m.col(i)).norm(), 0.008) << at_s;
  }
  EXPECT_LT(made_.performance.pressure_error_m, 0.004);
}

TEST_P(CarriedMotion, StandsOnBoardsThatLieOneUnderEachFoot) {
  const auto boards = virtual_sensors::OneFootEach(0.02);
  std::size_t loaded = 0, outside = 0;
  for (const auto& feet : made_.feet)
    for (std::size_t f = 0; f < kFeet; ++f)
      if (feet[f].load_n > 20) {
        ++loaded;
        outside += virtual_sensors::LoadBoard(boards[f], feet[f]).outside ? 1 : 0;
      }
  EXPECT_LT(static_cast<double>(outside), 0.02 * static_cast<double>(loaded));
}

TEST(Demo, SquatsLeansAndTakesEachFootOffTheGround) {
  const auto& made = Performed::Of("demo");
  const auto& course = made.scene.course;
  EXPECT_GT(course.com_m.row(2).maxCoeff() - course.com_m.row(2).minCoeff(), 0.25);
  EXPECT_GT(course.com_m.row(0).maxCoeff() - course.com_m.row(0).minCoeff(), 0.1);
  EXPECT_GT(course.com_m.row(1).maxCoeff() - course.com_m.row(1).minCoeff(), 0.15);
  for (std::size_t f = 0; f < kFeet; ++f) {
    const auto empty = std::count_if(made.feet.begin(), made.feet.end(),
                                     [f](const auto& feet) { return feet[f].load_n < 5; });
    EXPECT_GT(static_cast<double>(empty) / kRateHz, 1.5) << f;
  }
}

TEST(Demo, TheTPoseIsStillAndTheWeightIsWhereAStandingFootCarries) {
  const auto& made = Performed::Of("demo");
  for (Eigen::Index i = 0; i < 550; ++i) {
    ASSERT_NEAR(made.scene.reaction.force_n(2, i), kMassKg * kStandardGravityMps2, 8);
    ASSERT_LT((made.scene.course.com_m.col(i) - made.scene.course.com_m.col(0)).norm(), 0.012);
  }
}

TEST(Perform, ASquatGoesAsDeepAsTheScriptSays) {
  const auto script = ParseScript(
      R"({"keys": [{"seconds": 1}, {"seconds": 1, "crouch_m": 0.3}, {"seconds": 1}]})", "f");
  const auto performer = Performer(1.75, kMassKg);
  ASSERT_TRUE(script && performer);
  const Performance squat = Perform(*script, *performer, kRateHz);
  const Posture posture(*performer);
  EXPECT_NEAR(squat.motion.q(2, 300), posture.t_pose()(2) - 0.3, 1e-3);
}

TEST(Perform, TheSameScriptMakesTheSameMotion) {
  const auto script =
      ParseScript(R"({"sway_mm": 5, "keys": [{"seconds": 2, "weight": 0.5, "bow_deg": 20}]})", "f");
  const auto performer = Performer(1.6, 60);
  ASSERT_TRUE(script && performer);
  EXPECT_EQ(Perform(*script, *performer).motion.q, Perform(*script, *performer).motion.q);
}

}  // namespace
}  // namespace footing::choreography
