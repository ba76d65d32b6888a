#include "daemon/simulation/biped/world.h"

#include <cmath>

#include "common/base/units.h"
#include "tests/simulation/test_world.h"

namespace footing::physics {
namespace {

/// Efforts that swing all joints about, different at every step.
JointEfforts Wriggle(int step) {
  JointEfforts efforts{};
  for (int i = 0; i < kJoints; ++i) {
    efforts[static_cast<std::size_t>(i)] = (i % 4 == 0 ? 0.05 : 5.0) * std::sin(0.01 * step + i);
  }
  return efforts;
}

TEST(World, WeighsThirteenKilograms) {
  // Figure 4: body 9 kg, two hips and two knees of 1 kg.
  EXPECT_NEAR(test::LevelWorld().mass_kg(), 13.0, 1e-12);
}

/// How far the COM's velocity is from that of a falling stone after 0.5 s.
double FlightError(double step_s) {
  World world = test::LevelWorld(step_s);
  world.Reset({0, 0, 6}, 0.3, {});
  const int steps = static_cast<int>(0.5 / step_s + 0.5);
  for (int i = 0; i < steps; ++i) {
    JointEfforts efforts = Wriggle(static_cast<int>(i * step_s * 1000));
    for (double& effort : efforts) effort *= 0.2;
    world.Step(efforts, Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(world.Observe().normal_force_n[0] + world.Observe().normal_force_n[1], 0);
  return (world.Observe().v_WC - Eigen::Vector3d(0, 0, -kStandardGravityMps2 * 0.5)).norm();
}

TEST(World, FlightConservesMomentumWhateverTheJointsDo) {
  // The rest is the integrator's error, of first order: it goes with the step.
  const double error_mps = FlightError(0.001);
  EXPECT_LT(error_mps, 0.02);
  EXPECT_LT(FlightError(0.00025), 0.3 * error_mps);
}

TEST(World, APushChangesTheMomentumByItsImpulse) {
  World world = test::LevelWorld();
  world.Reset({0, 0, 6}, 0, {});
  const Eigen::Vector3d push_n(30, -20, 0);
  for (int i = 0; i < 100; ++i) world.Step({}, push_n);
  // dv = F t / m over 0.1 s.
  EXPECT_NEAR(world.Observe().v_WC.x(), 30 * 0.1 / 13, 1e-3);
  EXPECT_NEAR(world.Observe().v_WC.y(), -20 * 0.1 / 13, 1e-3);
  EXPECT_EQ(world.root_force_max_n(), 0);
}

TEST(World, ARestoredStateGoesOnBitForBit) {
  World world = test::LevelWorld();
  world.Reset({0, 0, 1.0}, 0.2, {});
  for (int i = 0; i < 700; ++i) world.Step(Wriggle(i), Eigen::Vector3d::Zero());
  const WorldState saved = world.Save();
  for (int i = 700; i < 1400; ++i) world.Step(Wriggle(i), Eigen::Vector3d::Zero());
  const std::uint64_t expected = world.StateHash();

  World other = test::LevelWorld();
  other.Restore(saved);
  for (int i = 700; i < 1400; ++i) other.Step(Wriggle(i), Eigen::Vector3d::Zero());
  EXPECT_EQ(other.StateHash(), expected);
}

TEST(World, BareStepsReachTheSameStateAsOurs) {
  World world = test::LevelWorld(), bare = test::LevelWorld();
  world.Reset({0, 0, 1.0}, 0.2, {});
  bare.Reset({0, 0, 1.0}, 0.2, {});
  for (int i = 0; i < 700; ++i) {
    world.Step(Wriggle(i), Eigen::Vector3d::Zero());
    bare.StepBare(Wriggle(i), Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(bare.StateHash(), world.StateHash());
}

/// Over two boxes, the second one 10 cm higher, with a pit of this width between them; feet and
/// boxes listed as pairs or not.
World SteppedWorld(bool pairs, double pit_m = 0) {
  const auto box = [](const char* name, double x_m, double top_m) {
    return std::string("<geom name='") + name +
           "' type='box' contype='1' conaffinity='2' size='2 2 1' pos='" + std::to_string(x_m) +
           " 0 " + std::to_string(top_m - 1) + "'/>";
  };
  const std::string boxes = box("low", -2 - pit_m / 2, 0) + box("high", 2 + pit_m / 2, 0.1);
  const std::vector<std::string> listed{"low", "high"};
  return std::move(
             World::FromMjcf(biped::WriteMjcf(test::Biped(), boxes,
                                              pairs ? listed : std::vector<std::string>{}, 0.001),
                             biped::Names(pairs ? listed : std::vector<std::string>{})))
      .value();
}

TEST(World, LooksAtTheFeetAloneOnlyWhereNothingElseCanTouch) {
  for (const double pit_m : {0.0, 0.6}) {
    World feet = SteppedWorld(true, pit_m), all = SteppedWorld(false, pit_m);
    for (World* world : {&feet, &all}) world->Reset({-0.1 - pit_m / 2, 0, 1.02}, 0.2, {});
    bool stood = false, lay = false;
    for (int i = 0; i < 2500; ++i) {  // It stands, wriggles, stumbles over the edge and lies there.
      const Eigen::Vector3d push_n(i < 300 ? 0 : 20, 0, 0);
      feet.Step(Wriggle(i), push_n);
      all.Step(Wriggle(i), push_n);
      ASSERT_EQ(feet.StateHash(), all.StateHash()) << i;
      ASSERT_EQ(feet.Observe().other_contact, all.Observe().other_contact) << i;
      stood = stood || feet.Observe().normal_force_n[0] > 0;
      lay = lay || feet.Observe().other_contact;
    }
    EXPECT_TRUE(stood && lay) << pit_m;
  }
}

TEST(World, GroundThatRisesUnderTheBodyTouchesIt) {
  World world = SteppedWorld(true);
  world.Reset({-0.5, 0, 3}, 0, {});
  world.Step({}, Eigen::Vector3d::Zero());
  // The box's face is then 5 cm above the body's COM, all between its shells.
  world.PlaceBox(0, {-0.5, 0, 2.05}, Eigen::Quaterniond::Identity(), {2, 2, 1});
  world.Step({}, Eigen::Vector3d::Zero());
  world.Step({}, Eigen::Vector3d::Zero());
  EXPECT_TRUE(world.Observe().other_contact);
}

TEST(World, HashTellsStatesApartThatDifferInTheLastBit) {
  World world = test::LevelWorld();
  const std::uint64_t hash = world.StateHash();
  WorldState state = world.Save();
  EXPECT_EQ(world.StateHash(), hash);
  state.qvel[3] = std::nextafter(state.qvel[3], 1.0);
  world.Restore(state);
  EXPECT_NE(world.StateHash(), hash);
}

TEST(World, ALyingBodyTouchesWithMoreThanItsFeet) {
  World world = test::LevelWorld();
  world.Reset({0, 0, 0.3}, 0, {});
  bool other = false;
  for (int i = 0; i < 300 && !other; ++i) {
    world.Step({}, Eigen::Vector3d::Zero());
    other = world.Observe().other_contact;
  }
  EXPECT_TRUE(other);
}

TEST(World, EffortsThatAreNoNumbersAreSeenAndNothingGoesOnWithThem) {
  World world = test::LevelWorld();
  world.Reset({0, 0, 1}, 0, {});
  EXPECT_FALSE(world.Observe().diverged);
  JointEfforts efforts{};
  efforts[3] = std::nan("");
  world.Step(efforts, Eigen::Vector3d::Zero());
  EXPECT_TRUE(world.Observe().diverged);
  EXPECT_TRUE(world.Observe().p_WC.allFinite() && world.Observe().v_WC.allFinite());
  world.Reset({0, 0, 1}, 0, {});
  EXPECT_FALSE(world.Observe().diverged);
}

TEST(World, RefusesTextThatIsNoModel) {
  const auto world = World::FromMjcf("<mujoco><worldbody>", biped::Names());
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().message.find("does not compile"), std::string::npos);
}

}  // namespace
}  // namespace footing::physics
