#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "daemon/offline/tune/team.h"
#include "daemon/offline/tune/trial.h"
#include "daemon/offline/tune/tune_command.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::tune {
namespace {

constexpr double kStepS = 0.001;

/// Feet that are down for 0.4 of every 0.7 s, half a cycle apart, at 1 m/s; each touchdown
/// chatters for 10 ms.
TrialResult WalkMade(stream::Gait gait) {
  GaitMeter meter({gait, 1.0});
  engine::EngineOutput output;
  for (int i = 0; i < 5000; ++i) {
    for (int leg = 0; leg < 2; ++leg) {
      const int phase = (i + 350 * leg) % 700;
      const bool chatters = phase == 3 || phase == 7;
      output.contacts[static_cast<std::size_t>(leg)].touching = phase < 400 && !chatters;
      if (phase == 0) ++output.gait.steps;
    }
    output.gait.speed_mps = 1 + 0.3 * std::sin(2 * M_PI * i / 350);
    output.gait.distance_m = i * kStepS;
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  return result;
}

TEST(GaitMeter, MeasuresSwingStanceAndStrideOfAWalk) {
  const TrialResult result = WalkMade(stream::Gait::kWalk);
  EXPECT_NEAR(result.flight_s, 0.30, 0.012);  // Down for good from the chatter's end.
  EXPECT_NEAR(result.stance_s, 0.40, 0.012);
  EXPECT_NEAR(result.stride_m, 0.70, 1e-9);
}

TEST(GaitMeter, TakesTheSpeedOverAStepNotWithinIt) {
  // A swing of 0.3 m/s at 18 rad/s through 0.5 s of smoothing: 0.3 / (18 * 0.5), and its rms.
  EXPECT_NEAR(WalkMade(stream::Gait::kWalk).speed_error_mps, 0.3 / 9 / std::sqrt(2), 0.012);
}

TEST(GaitMeter, OfARunCountsTheTimesWithoutAnyFoot) {
  GaitMeter meter({stream::Gait::kRun, 2.0});
  engine::EngineOutput output;
  for (int i = 0; i < 4000; ++i) {
    output.contacts[0].touching = i % 800 < 150;
    output.contacts[1].touching = (i + 400) % 800 < 150;
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  EXPECT_NEAR(result.flight_s, 0.25, 0.002);
  EXPECT_NEAR(result.stance_s, 0.15, 0.002);
}

TEST(GaitMeter, KeepsTheLeastGapBetweenTheLegs) {
  GaitMeter meter({stream::Gait::kRun, 2.0});
  engine::EngineOutput output;
  for (const double feet_m : {0.2, 0.1, 0.15}) {  // Parallel legs of 4 cm.
    for (const int side : {0, 1}) {
      const double y_m = (side == 0 ? 0.5 : -0.5) * feet_m;
      output.links[static_cast<std::size_t>(1 + 2 * side)].position_m = {0, y_m, 0.9};
      output.contacts[static_cast<std::size_t>(side)].position_m = {0, y_m, 0};
    }
    meter.Add(output, kStepS);
  }
  TrialResult result;
  meter.Report(result);
  EXPECT_NEAR(result.leg_gap_m, 0.06, 1e-12);
}

const Task kTrialWalk{stream::Gait::kWalk, 0.8};

Team NewTeam(int threads) {
  auto team = Team::Create(threads);
  EXPECT_TRUE(team.ok());
  EXPECT_TRUE(team->Prepare({kTrialWalk}, *TableOf(engine_files::ReadTexts()->gains, {}), 3).ok());
  return std::move(team).value();
}

std::vector<double> Totals(Team team) {
  std::vector<gait::Gains> gains(2);
  gains[1].attitude.roll_damping_nms_per_rad = 20;
  std::vector<double> totals;
  for (const auto& costs : team.Try(gains, 6, 99)) {
    for (const Cost& cost : costs) totals.push_back(cost.total());
  }
  return totals;
}

TEST(Trials, DoNotDependOnTheNumberOfThreads) { EXPECT_EQ(Totals(NewTeam(1)), Totals(NewTeam(3))); }

TEST(Trials, SeeTheGainsThatAreTried) {
  const auto totals = Totals(NewTeam(1));
  EXPECT_NE(std::vector(totals.begin(), totals.begin() + 6),
            std::vector(totals.begin() + 6, totals.end()));
}

TEST(Trials, LegsThatCannotCarryFailInEveryTrial) {
  Team team = NewTeam(2);
  gait::Gains weak;
  weak.walking.leg_stiffness_n_per_m = 100;
  weak.walking.supported_mass_kg = 1;
  const Score score = ScoreOf(team.Try({weak}, 4, 1).front());
  EXPECT_EQ(score.survival, 0);
  EXPECT_GT(score.mean.failure, 5);
}

TEST(Trials, BeginWalkingAtTheirSpeed) {
  auto texts = engine_files::ReadTexts();
  auto engine = engine::GaitEngine::Create(*texts);
  ASSERT_TRUE(engine.ok());
  const auto states = SettledStates(*engine, kTrialWalk, 3, 5);
  ASSERT_TRUE(states.ok());
  std::set<std::uint64_t> moments;
  for (const auto& state : *states) {
    EXPECT_EQ(state.gait.gait, stream::Gait::kWalk);
    EXPECT_NEAR(state.gait.speed.desired_mps, 0.8, 1e-6);
    EXPECT_EQ(state.failures, stream::FailureCounts());
    moments.insert(state.step);
  }
  EXPECT_EQ(moments.size(), 3u);
}

TEST(Trials, BrakeWithTheTablesOtherSets) {
  const Task run{stream::Gait::kRun, 3.5};
  auto team = Team::Create(1);
  ASSERT_TRUE(team.ok());
  const gait::GainTable table = *TableOf(engine_files::ReadTexts()->gains, {});
  const gait::Gains tried = table.At(run.gait, run.speed_mps);
  gait::GainSet weak{"slow", 1, tried};
  weak.gains.hopping.run_leg_stiffness_n_per_m = 500;
  const auto changes = [&run](std::uint64_t seed, std::uint64_t trial) {
    return Draw(run, MixSeeds(seed, trial)).change_s > 0;
  };
  std::uint64_t seed = 1;  // Seed with which the first of two trials is to walk.
  while (!changes(seed, 0) || changes(seed, 1)) ++seed;

  ASSERT_TRUE(team->Prepare({run}, table, 3).ok());
  const std::vector<Cost> alone = team->Try({tried}, 2, seed).front();
  ASSERT_TRUE(team->Prepare({run}, table, 3, {weak}).ok());
  const std::vector<Cost> beside = team->Try({tried}, 2, seed).front();
  EXPECT_NE(alone[0].total(), beside[0].total());
  EXPECT_EQ(alone[1].total(), beside[1].total());
}

TEST(Trials, TimeAChangeToWalking) {
  auto engine = engine::GaitEngine::Create(*engine_files::ReadTexts());
  ASSERT_TRUE(engine.ok());
  const Task run{stream::Gait::kRun, 3};
  const auto states = SettledStates(*engine, run, 1, 5);
  ASSERT_TRUE(states.ok());
  const auto result = [&](double change_s) {
    return RunTrial(*engine, states->front(), run,
                    {.kick_s = 9,
                     .change_s = change_s,
                     .change = {.gait = stream::Gait::kWalk, .speed_mps = 0.8}});
  };
  const TrialResult walked = result(1);
  EXPECT_EQ(walked.survived, 1);
  EXPECT_GT(walked.latency_s, 0.3);
  EXPECT_LT(walked.latency_s, 1.5);
  EXPECT_LT(walked.speed_error_mps, 0.1);  // Error in the run before.
  // A command that is over before it walks counts up to there; one that is never to walk has no
  // latency.
  EXPECT_NEAR(result(4.9).latency_s, kTrialS - 4.9, 1e-9);
  EXPECT_EQ(result(0).latency_s, 0);
}

TEST(Disturbances, OfARunArePushesTurnsPitsAndChangesOfGait) {
  const Task run{stream::Gait::kRun, 3};
  int pushed = 0, pushed_turning = 0, turning = 0, pits = 0, changes = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Disturbance drawn = Draw(run, seed);
    EXPECT_FALSE(drawn.pit_m > 0 && drawn.turn_rad != 0);
    EXPECT_FALSE(drawn.pit_m > 0 && ScoresHeading(drawn));
    EXPECT_FALSE(drawn.change_s > 0 && (drawn.turn_rad != 0 || drawn.pit_m > 0));
    EXPECT_EQ(ScoresLegs(drawn), drawn.kick_ns < 26);
    const bool hard = drawn.kick_ns >= 26;
    pushed += hard ? 1 : 0;
    EXPECT_LE(drawn.kick_ns, 1.3 * 26);
    pushed_turning += hard && drawn.turn_rad != 0 ? 1 : 0;
    turning += ScoresHeading(drawn) ? 1 : 0;
    pits += drawn.pit_m > 0 ? 1 : 0;
    changes += drawn.change_s > 0 ? 1 : 0;
  }
  // Shares of 400: 45, 15, 15, 15 and 25 %, within three standard deviations.
  EXPECT_NEAR(pushed, 180, 30);
  EXPECT_NEAR(pushed_turning, 60, 22);
  EXPECT_NEAR(turning, 60, 22);
  EXPECT_NEAR(pits, 60, 22);
  EXPECT_NEAR(changes, 100, 26);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_LE(Draw(kTrialWalk, seed).pit_m, 0.3);
    EXPECT_EQ(Draw(kTrialWalk, seed).change_s, 0);
    EXPECT_EQ(Draw({stream::Gait::kStep, 0}, seed).pit_m, 0);
    EXPECT_EQ(Draw({stream::Gait::kJump, 0}, seed).pit_m, 0);
  }
}

TEST(Tasks, OfTheOutermostSetsGoToTheEndsOfTheTests) {
  const auto speeds = [](stream::Gait gait, const std::vector<double>& sets, std::size_t set) {
    std::vector<double> tried_mps;
    for (const Task& task : TasksOf(gait, sets, set)) tried_mps.push_back(task.speed_mps);
    return tried_mps;
  };
  const std::vector<double> runs{3, 4, 5};
  EXPECT_EQ(speeds(stream::Gait::kRun, runs, 0), (std::vector<double>{3, 2}));
  EXPECT_EQ(speeds(stream::Gait::kRun, runs, 1), (std::vector<double>{4}));
  EXPECT_EQ(speeds(stream::Gait::kRun, runs, 2), (std::vector<double>{5, 6}));
  EXPECT_EQ(speeds(stream::Gait::kJump, {1}, 0), (std::vector<double>{1, 0, 2}));
  EXPECT_EQ(speeds(stream::Gait::kStep, {0}, 0), (std::vector<double>{0}));
}

TEST(Tasks, OfThePapersGaitsChangeIntoThemToo) {
  std::set<stream::Gait> from;
  for (const Task& task : TasksOf(stream::Gait::kWalk, {0.3, 1.2}, 1, /*paper=*/true)) {
    if (task.gait != stream::Gait::kWalk) {
      EXPECT_EQ(task.into, stream::Gait::kWalk);
      from.insert(task.gait);
      EXPECT_EQ(Draw(task, 1).change.gait, stream::Gait::kWalk);
    }
  }
  EXPECT_EQ(from.size(), 3u);
  int changes = 0;
  const Task jump{stream::Gait::kJump, 0.5, /*paper=*/true};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Disturbance drawn = Draw(jump, seed);
    if (drawn.change_s == 0) continue;
    ++changes;
    EXPECT_NE(drawn.change.gait, stream::Gait::kRun);  // Figure 9 has no such arrow.
  }
  EXPECT_NEAR(changes, 100, 26);
}

TEST(Disturbances, JumpsAreAsHighAsTheBuiltInTablesWereTunedFor) {
  double highest_m = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    highest_m = std::max(highest_m, Draw({stream::Gait::kJump, 2}, seed).height_m);
  }
  EXPECT_LE(highest_m, 0.5);
  EXPECT_GT(highest_m, 0.48);
}

TEST(Trials, APitTooWideToJumpEndsOne) {
  auto texts = engine_files::ReadTexts();
  auto engine = engine::GaitEngine::Create(*texts);
  ASSERT_TRUE(engine.ok());
  const auto states = SettledStates(*engine, {stream::Gait::kRun, 3}, 1, 5);
  ASSERT_TRUE(states.ok());
  const Disturbance wide{.kick_s = 9, .pit_m = 4, .pit_ahead_m = 6};
  texts->track = PitTrack(states->front(), wide);
  auto on_pit = engine::GaitEngine::Create(*texts);
  ASSERT_TRUE(on_pit.ok());
  EXPECT_LT(RunTrial(*on_pit, states->front(), {stream::Gait::kRun, 3}, wide).survived, 1);
}

TEST(Score, HasTheMeanAndItsInterval) {
  // 0 and 2 in equal parts of 100: standard deviation 1.005, half width 1.96 of a tenth of it.
  std::vector<Cost> costs(100);
  for (std::size_t i = 0; i < costs.size(); i += 2) costs[i].speed = 2;
  const Score score = ScoreOf(costs);
  EXPECT_NEAR(score.mean.total(), 1, 1e-12);
  EXPECT_NEAR(score.total_half_width, 0.196 * 1.005, 1e-3);
  std::vector<Cost> better = costs;
  for (Cost& cost : better) cost.speed -= 0.5;
  EXPECT_NEAR(Compare(better, costs).mean, -0.5, 1e-12);
  EXPECT_NEAR(Compare(better, costs).half_width, 0, 1e-12);
}

TEST(Seeds, AreMixed) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t a = 0; a < 30; ++a) {
    for (std::uint64_t b = 0; b < 30; ++b) seen.insert(MixSeeds(a, b));
  }
  EXPECT_EQ(seen.size(), 900u);
}

}  // namespace
}  // namespace footing::tune
