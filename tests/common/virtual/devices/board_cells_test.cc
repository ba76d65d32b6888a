#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/options/load.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::virtual_sensors {
namespace {

double Sum(const Corners& corners) { return std::accumulate(corners.begin(), corners.end(), 0.0); }

Eigen::Vector2d Cop(const BoardPlace& board, const Corners& corners) {
  const auto places = SensorPlaces(board);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) sum += corners[i] * places[i];
  return sum / Sum(corners);
}

TEST(LoadBoard, CornersGiveBackLoadAndCopOfAnyBoardThatIsTurned) {
  for (const double yaw : {0.0, 0.5, 1.5707963, -2.0}) {
    const BoardPlace board{{0.3, -0.2}, yaw};
    const FootForce foot{400, {0.35, -0.22}};
    const BoardLoad load = LoadBoard(board, foot);
    EXPECT_FALSE(load.outside);
    EXPECT_NEAR(Sum(load.corners_n), 400, 1e-9);
    EXPECT_NEAR((Cop(board, load.corners_n) - foot.cop_m).norm(), 0, 1e-9);
  }
}

TEST(LoadBoard, FrontOfABoardThatIsNotTurnedIsAhead) {
  const BoardLoad load = LoadBoard({}, {100, {0.5 * 0.238, 0}});
  EXPECT_NEAR(load.corners_n[0], 50, 1e-9);  // Top left and right carry all.
  EXPECT_NEAR(load.corners_n[1], 50, 1e-9);
  EXPECT_GT(LoadBoard({}, {100, {0, 0.1}}).corners_n[0], 25);  // Left is left.
}

TEST(LoadBoard, NoCellPullsWhenTheFootIsBeyondTheSensors) {
  const BoardLoad load = LoadBoard({}, {400, {0.3, 0}});
  EXPECT_TRUE(load.outside);
  EXPECT_NEAR(Sum(load.corners_n), 400, 1e-9);
  for (const double corner : load.corners_n) EXPECT_GE(corner, 0);
}

TEST(OneFootEach, HasTheFrontEdgesFacingEachOtherAcrossTheGap) {
  const auto boards = OneFootEach(0.02);
  EXPECT_NEAR(boards[0].middle_m.y(), 0.168, 1e-12);
  EXPECT_NEAR(boards[1].middle_m.y(), -0.168, 1e-12);
  // Top left is the first sensor; seen from above, the left board's front is at its right.
  EXPECT_NEAR(SensorPlaces(boards[0])[0].y(), 0.168 - 0.5 * 0.238, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[0])[0].x(), 0.5 * 0.433, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[1])[0].y(), -0.168 + 0.5 * 0.238, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[1])[0].x(), -0.5 * 0.433, 1e-9);
}

TEST(CellErrors, AreNoneWhenNoneAreWanted) {
  CellErrors cells({});
  const Corners forces{100, 90, 80, 70};
  EXPECT_EQ(cells.Advance(forces, 0.016), forces);
}

TEST(CellErrors, HysteresisLagsByItsPlayInBothDirections) {
  CellErrorConfig config;
  config.hysteresis_n = 2;
  CellErrors cells(config);
  const auto read = [&](double n) { return cells.Advance({n, n, n, n}, 0.016)[0]; };
  EXPECT_NEAR(read(100), 100, 1e-9);
  EXPECT_NEAR(read(101), 100, 1e-9);  // Inside the play.
  EXPECT_NEAR(read(110), 108, 1e-9);  // Going up it reads less,
  EXPECT_NEAR(read(100), 102, 1e-9);  // going down more.
}

TEST(CellErrors, NoiseGainAndSlowErrorHaveTheirSpread) {
  CellErrorConfig config;
  config.noise_kg = 0.05;
  config.slow_force_n = 1.5;
  config.slow_time_s = 0.5;
  CellErrors cells(config);
  const Corners forces{92.5, 92.5, 92.5, 92.5};  // 370 N: the slow error is whole.
  double noise = 0, total = 0;
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const Corners read = cells.Advance(forces, 1 / 60.0);
    noise += std::pow(read[0] - read[1], 2) / 2;
    total += std::pow(Sum(read) - 370, 2);
  }
  const double white = KilogramsToNewtons(0.05);
  EXPECT_NEAR(std::sqrt(noise / kSamples), white, 0.02 * white);
  EXPECT_NEAR(total / kSamples, 4 * white * white + 1.5 * 1.5, 0.3);
  config.gain_spread = 0.01;
  double square = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    config.seed = seed;
    const CellErrors spread(config);
    for (const double gain : spread.gains()) square += std::pow(gain - 1, 2);
  }
  EXPECT_NEAR(std::sqrt(square / 2000), 0.01, 0.001);
}

constexpr double kRateHz = 120;
constexpr double kMassKg = 70;
constexpr Eigen::Index kFrames = 600;

// Feet 32 cm apart, soles 22 cm long, flat.
BodyCourse Standing() {
  BodyCourse course;
  course.rate_hz = kRateHz;
  course.mass_kg = kMassKg;
  course.com_m = Eigen::Vector3d(0.04, 0, 1).replicate(1, kFrames);
  course.angular_momentum.setZero(3, kFrames);
  for (std::size_t f = 0; f < kFeet; ++f)
    for (std::size_t i = 0; i < kFootPoints; ++i)
      course.sole_m[f][i] =
          Eigen::Vector3d(i < 2 ? -0.05 : 0.17,
                          (f == 0 ? 0.16 : -0.16) + (i % 2 == 0 ? 0.03 : -0.03), 0)
              .replicate(1, kFrames);
  return course;
}

TEST(React, GivesTheWeightUnderTheCentreOfMassAtRest) {
  const BodyCourse course = Standing();
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.force_n(2, 300), kMassKg * kStandardGravityMps2, 1e-6);
  EXPECT_NEAR(reaction.cop_m(0, 300), 0.04, 1e-9);
  EXPECT_TRUE(reaction.supported[300]);
}

TEST(React, CopOvershootsASwayingPointMassByItsFrequencySquaredOverGravity) {
  BodyCourse course = Standing();
  const double w = 2 * kPi * 0.5;
  for (Eigen::Index i = 0; i < kFrames; ++i)
    course.com_m(1, i) = 0.05 * std::sin(w * static_cast<double>(i) / kRateHz);
  const GroundReaction reaction = React(course, 20);
  const double factor = 1 + w * w / kStandardGravityMps2;
  for (Eigen::Index i = 100; i < 500; ++i)
    EXPECT_NEAR(reaction.cop_m(1, i), factor * course.com_m(1, i), 2e-4);
}

TEST(React, AngularMomentumMovesTheCop) {
  BodyCourse course = Standing();
  // L_y grows by 7 N m: with 686.5 N the COP moves back by 1.02 cm.
  for (Eigen::Index i = 0; i < kFrames; ++i)
    course.angular_momentum(1, i) = 7 * static_cast<double>(i) / kRateHz;
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.cop_m(0, 300), 0.04 - 7 / (kMassKg * kStandardGravityMps2), 1e-6);
}

TEST(React, LeavesTheForceOfFlightAsItIs) {
  BodyCourse course = Standing();
  for (Eigen::Index i = 0; i < kFrames; ++i) {
    const double t = static_cast<double>(i) / kRateHz;
    course.com_m(2, i) = 1 + 10 * t - 0.5 * 1.02 * kStandardGravityMps2 * t * t;
  }
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.force_n(2, 300), -0.02 * kMassKg * kStandardGravityMps2, 0.1);
  EXPECT_FALSE(reaction.supported[300]);
}

TEST(ShareBetweenFeet, KeepsTotalAndCop) {
  const BodyCourse course = Standing();
  GroundReaction reaction = React(course);
  reaction.cop_m.col(300) << 0.1, 0.05;
  const auto feet = ShareBetweenFeet(course, reaction, 300);
  EXPECT_NEAR(feet[0].load_n + feet[1].load_n, kMassKg * kStandardGravityMps2, 1e-6);
  const Eigen::Vector2d cop = (feet[0].load_n * feet[0].cop_m + feet[1].load_n * feet[1].cop_m) /
                              (feet[0].load_n + feet[1].load_n);
  EXPECT_NEAR((cop - Eigen::Vector2d(0.1, 0.05)).norm(), 0, 2e-3);
  EXPECT_GT(feet[0].load_n, feet[1].load_n);
}

TEST(ShareBetweenFeet, GivesNothingToARaisedFoot) {
  BodyCourse course = Standing();
  for (auto& point : course.sole_m[1]) point.row(2).setConstant(0.2);
  GroundReaction reaction = React(course);
  reaction.cop_m.col(300) << 0.05, 0.16;
  const auto feet = ShareBetweenFeet(course, reaction, 300);
  EXPECT_LT(feet[1].load_n, 1);
  EXPECT_NEAR((feet[0].cop_m - Eigen::Vector2d(0.05, 0.16)).norm(), 0, 2e-3);
}

TEST(Follow, ASoleThatPointsIntoTheFloorLaterIsFlatInTheTPose) {
  const body::Skeleton skeleton = body::StandardPerson(1.75);
  const auto made = body::MakeBody(skeleton, body::PersonParameters{});
  ASSERT_TRUE(made);
  motion::Motion motion;
  motion.skeleton = skeleton;
  motion.rate_hz = 100;
  motion.q = body::TPose(skeleton, made->landmarks).replicate(1, 400);
  const int left = made->landmarks[body::Landmark::kLeftAnkle];
  const body::Joint& ankle = skeleton.joint(left);
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, motion.q.col(0), at);
  const Eigen::Matrix3d& R_WP = at.R_WJ[static_cast<std::size_t>(ankle.parent)];
  const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(left)];
  Eigen::VectorXd toes_down = motion.q.col(0);
  body::SetJointRotation(ankle, R_WP.transpose() * body::AxisRotation(body::Axis::kY, 0.2) * R_WJ,
                         toes_down);
  motion.q.rightCols(60).colwise() = toes_down;
  const BodyCourse course = Follow(*made, motion);
  const auto heights_m = [&](Eigen::Index frame) {
    Eigen::Matrix<double, kFeet * kFootPoints, 1> heights;
    for (std::size_t f = 0; f < kFeet; ++f)
      for (std::size_t i = 0; i < kFootPoints; ++i)
        heights(static_cast<Eigen::Index>(f * kFootPoints + i)) = course.sole_m[f][i](2, frame);
    return heights;
  };
  EXPECT_LT(heights_m(100).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(heights_m(380).minCoeff(), -0.01);
}

TEST(Follow, FindsTheStandardPersonAtRestOnBothSoles) {
  const body::Skeleton skeleton = body::StandardPerson(1.75);
  body::PersonParameters person;
  const auto made = body::MakeBody(skeleton, person);
  ASSERT_TRUE(made);
  motion::Motion motion;
  motion.skeleton = skeleton;
  motion.rate_hz = 100;
  motion.q = body::TPose(skeleton, made->landmarks).replicate(1, 200);
  const BodyCourse course = Follow(*made, motion);
  const GroundReaction reaction = React(course);
  const auto feet = ShareBetweenFeet(course, reaction, 100);
  EXPECT_NEAR(feet[0].load_n, feet[1].load_n, 1e-3);
  EXPECT_NEAR(feet[0].load_n + feet[1].load_n, 75 * kStandardGravityMps2, 1e-3);
  EXPECT_GT(feet[0].cop_m.y(), 0.05);  // The left foot is on the left.
  EXPECT_LT(feet[1].cop_m.y(), -0.05);
  EXPECT_NEAR(course.com_m(2, 100), 1.0, 0.1);
}

Eigen::Vector2d InW(const SolePlace& sole, const Eigen::Vector2d& p_F_m) {
  const double c = std::cos(sole.yaw_rad), s = std::sin(sole.yaw_rad);
  return sole.heel_m +
         Eigen::Vector2d(c * p_F_m.x() - s * p_F_m.y(), s * p_F_m.x() + c * p_F_m.y());
}

TEST(LoadInsole, HasTheFootsLoadAndCopAndNeverPulls) {
  const SolePlace sole{{0.5, -0.3}, 0.7, 0.24};
  const auto places = InsolePlaces(sole.length_m);
  for (const double x : {0.006, 0.05, 0.12, 0.2, 0.234}) {
    for (const double y : {-0.024, 0.0, 0.015}) {
      const FootForce foot{600, InW(sole, {x, y})};
      const auto loads = LoadInsole(places, sole, foot);
      double total = 0;
      Eigen::Vector2d moment = Eigen::Vector2d::Zero();
      for (std::size_t i = 0; i < loads.size(); ++i) {
        EXPECT_GE(loads[i], 0);
        total += loads[i];
        moment += loads[i] * InW(sole, places[i]);
      }
      EXPECT_NEAR(total, 600, 1e-6);
      EXPECT_LT((moment / total - foot.cop_m).norm(), 1e-4) << x << " " << y;
    }
  }
}

TEST(LoadInsole, IsEvenUnderTheMiddleAndAtTheEdgeForACopBeyondIt) {
  const SolePlace sole{{0, 0}, 0, 0.24};
  const auto places = InsolePlaces(sole.length_m);
  for (const double load : LoadInsole(places, sole, {160, {0.12, 0}})) EXPECT_NEAR(load, 10, 1e-6);
  const auto ahead = LoadInsole(places, sole, {160, {0.5, 0}});
  double moment = 0;
  for (std::size_t i = 0; i < ahead.size(); ++i) moment += ahead[i] * places[i].x();
  EXPECT_NEAR(moment / 160, 0.235, 1e-4);
  for (const double load : LoadInsole(places, sole, {-5, {0, 0}})) EXPECT_EQ(load, 0);
}

constexpr double kPlatesMassKg = 60;  // By the same plates under the standing subject (static1).

/// Load and COP of the plates of a trial together around one instant of the motion.
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

struct Trial {
  motion::Motion motion;
  motion::GroundForces forces;
  GroundReaction reaction;
};

Result<Trial> Read(const std::string& name) {
  const std::string folder = motion::test::SharedData() + "/forces/opencap_s4/";
  const auto loaded = motion_files::LoadMotion(folder + "MarkerData/" + name + ".trc",
                                               {.still = folder + "MarkerData/static1.trc"});
  if (!loaded) return loaded.error();
  const auto forces = motion_files::LoadForces(folder + "ID/" + name + "_grf.mot");
  if (!forces) return forces.error();
  body::PersonParameters person;
  person.mass_kg = kPlatesMassKg;
  person.height_m = loaded->height_m;
  const auto body = body::MakeBody(loaded->motion.skeleton, person);
  if (!body) return body.error();
  Trial trial{motion::Continuous(loaded->motion), *forces, {}};
  trial.reaction = ReactToImpacts(*body, trial.motion, Follow(*body, trial.motion));
  return trial;
}

/// Error of the forces of frames [begin, end).
struct Off {
  double force_share = 0;  ///< Share of the weight, root mean square.
  Eigen::Vector2d cop_m, cop_sd_m;
};

Off Compare(const Trial& trial, Eigen::Index begin, Eigen::Index end) {
  double load = 0, count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), square = Eigen::Vector2d::Zero();
  for (Eigen::Index i = begin; i < end; ++i) {
    const double at_s = trial.motion.start_s + static_cast<double>(i) / trial.motion.rate_hz;
    const Felt felt = Mean(trial.forces, at_s, 1 / trial.motion.rate_hz);
    load += std::pow(trial.reaction.force_n(2, i) - felt.load_n, 2);
    ++count;
    const Eigen::Vector2d off = trial.reaction.cop_m.col(i) - felt.cop_m;
    sum += off;
    square += off.cwiseAbs2();
  }
  const Eigen::Vector2d mean = sum / count;
  return {std::sqrt(load / count) / (kPlatesMassKg * kStandardGravityMps2), mean,
          (square / count - mean.cwiseAbs2()).cwiseSqrt()};
}

/// No constant was chosen on squats. Measured when it was written: 1.5 % of the weight, 0.9 cm
/// sideways, 2.7 cm fore and aft about a constant 2.4 cm.
TEST(ReactToImpacts, GivesTheForcesOfRealPlatesUnderSquats) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto trial = Read("squats1");
  ASSERT_TRUE(trial);
  const Eigen::Index frames = trial->motion.frames();
  ASSERT_GT(frames, 1000);
  const Off off = Compare(*trial, 30, frames - 30);
  EXPECT_LT(off.force_share, 0.0155);
  EXPECT_LT(off.cop_sd_m.y(), 0.010);
  EXPECT_LT(off.cop_sd_m.x(), 0.029);
  EXPECT_LT(std::abs(off.cop_m.y()), 0.004);
  EXPECT_LT(std::abs(off.cop_m.x()), 0.028);
}

/// Measured when it was written: 11 % of the weight, against 15 % with React.
TEST(ReactToImpacts, FollowsTheLandingOfADropJump) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto trial = Read("DJ1");
  ASSERT_TRUE(trial);
  // From the landing on, with both feet on the plates.
  EXPECT_LT(Compare(*trial, 126, 254).force_share, 0.12);
}

}  // namespace
}  // namespace footing::virtual_sensors
