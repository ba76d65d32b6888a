#include "clients/game/rules/director.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/body/centre_line.h"
#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

using stream::GamePhase;
using ::testing::HasSubstr;

constexpr double kStepS = 0.01;

GameOptions Quick() {
  GameOptions options;
  options.rounds = 2;
  options.round_s = 10;
  options.countdown_s = 1;
  options.pause_s = 1;
  return options;
}

/// footing-sim as far as the game goes: does what is ordered, and moves the runner on.
struct World {
  Director director{Quick()};
  Collector seen;
  Hand hand{true, 0.5, 0.5};
  Frame frame;
  stream::Track track = ShortTrack();
  std::vector<Piece> laid;
  std::vector<GamePhase> phases;
  std::string started, started_on;

  World() {
    frame.commanded = true;
    frame.commanded_speed_mps = 2;
    seen.OnTrack(track);
  }

  void Step() {
    frame.time_s += kStepS;
    if (frame.trial.progress.phase == stream::TrialPhase::kRunning) {
      frame.trial.progress.distance_m += 2 * kStepS;
      frame.trial.progress.time_s += kStepS;
    }
    seen.OnTrack(track);
    seen.OnTrial(frame.trial);
    const Orders orders = director.Advance(frame, seen, hand);
    if (orders.append) {
      laid.push_back(*orders.append);
      Lay(*orders.append, track);
    }
    if (!orders.start_trial.empty()) {
      started = orders.start_trial;
      started_on = orders.track;
      track = ShortTrack();
      const std::uint64_t number = frame.trial.number + 1;
      frame.trial = TrialAt(started, 0.5, 0);
      frame.trial.number = number;
    }
    if (orders.stop_trial == frame.trial.trial && !orders.stop_trial.empty()) {
      frame.trial.progress.phase = stream::TrialPhase::kStopped;
    }
    const GamePhase phase = director.game().phase;
    if (phases.empty() || phases.back() != phase) phases.push_back(phase);
  }

  void RunFor(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kStepS); ++i) Step();
  }
  void RunUntil(GamePhase phase, double within_s) {
    for (double s = 0; s < within_s && director.game().phase != phase; s += kStepS) Step();
    ASSERT_EQ(director.game().phase, phase);
  }
};

TEST(Director, PlaysAllRoundsWithSwappedPartsToTheEnd) {
  World world;
  world.RunUntil(GamePhase::kOver, 40);
  const stream::GameState& game = world.director.game();
  EXPECT_EQ(world.phases,
            (std::vector<GamePhase>{GamePhase::kCountdown, GamePhase::kRound, GamePhase::kPause,
                                    GamePhase::kWaiting, GamePhase::kCountdown, GamePhase::kRound,
                                    GamePhase::kOver}));
  ASSERT_EQ(game.results.size(), 2u);
  EXPECT_EQ(game.results[0].runner, 0u);
  EXPECT_EQ(game.results[1].runner, 1u);
  EXPECT_NE(game.results[0].trial, game.results[1].trial);
  for (const stream::GameRound& round : game.results) {
    EXPECT_NEAR(round.distance_m, 0.5 + 2 * 10 - 1, 0.1);  // 2 m/s for 10 s, from the start line.
    EXPECT_GT(round.segments_laid, 3u);
    EXPECT_GT(round.runner_points, round.distance_m);
  }
  EXPECT_EQ(game.players[0].points, game.results[0].runner_points);
  EXPECT_EQ(game.players[1].points, game.results[1].runner_points);
  EXPECT_EQ(stream::WhyNotAGame(game), nullptr);
  // Then the character may run on, on a track that continues itself.
  EXPECT_EQ(world.started, "after-" + game.results[1].trial);
  EXPECT_EQ(world.started_on, "endless");
}

TEST(Director, LaysLevelGroundBetweenTheRoundsThatCountsForNobody) {
  World world;
  world.RunUntil(GamePhase::kPause, 15);
  const stream::GameRound ended = world.director.game().results.back();
  const std::size_t laid = world.laid.size();
  for (int i = 0; i < 90; ++i) {
    world.frame.trial.progress.distance_m += 0.05;  // It runs on, at 5 m/s.
    world.Step();
    EXPECT_GT(track::LengthOf(world.track) - world.frame.trial.progress.distance_m, 3);
  }
  ASSERT_GT(world.laid.size(), laid);
  for (std::size_t i = laid; i < world.laid.size(); ++i) EXPECT_EQ(world.laid[i].slope_rad, 0);
  EXPECT_EQ(world.director.game().results[0].segments_laid, ended.segments_laid);
  EXPECT_EQ(world.director.game().results[0].distance_m, ended.distance_m);
  EXPECT_FALSE(world.director.game().ghost);
}

TEST(Director, ShowsAsGhostWhatItThenLays) {
  World world;
  world.RunUntil(GamePhase::kRound, 5);
  stream::TrackSegment shown;
  std::size_t compared = 0;
  for (int i = 0; i < 900; ++i) {
    const std::size_t before = world.laid.size();
    world.hand.pitch_rad = 0.1 * (i % 13) - 0.6;
    world.Step();
    ASSERT_TRUE(world.director.game().ghost);
    if (world.laid.size() == before) continue;
    shown = *world.director.game().ghost;
    EXPECT_EQ(shown.start_m, world.track.segments.back().start_m);
    EXPECT_EQ(shown.slope_rad, world.track.segments.back().slope_rad);
    EXPECT_EQ(shown.heading_rad, world.track.segments.back().heading_rad);
    ++compared;
  }
  EXPECT_GT(compared, 3u);
}

TEST(Director, WaitsForBothPlayersAndSaysForWhom) {
  World world;
  world.hand.known = false;
  world.RunFor(2);
  EXPECT_EQ(world.director.game().phase, GamePhase::kWaiting);
  EXPECT_THAT(world.director.game().note, HasSubstr("builder"));
  world.hand.known = true;
  world.frame.commanded = false;
  world.RunFor(2);
  EXPECT_THAT(world.director.game().note, HasSubstr("runner"));
  world.frame.commanded = true;
  world.RunFor(0.5);
  EXPECT_EQ(world.director.game().phase, GamePhase::kCountdown);
  world.frame.commanded = false;
  world.RunFor(0.1);
  EXPECT_EQ(world.director.game().phase, GamePhase::kWaiting);
  EXPECT_TRUE(world.started.empty());
}

TEST(Director, SaysInARoundWhoseDevicesAreSilent) {
  World world;
  world.RunUntil(GamePhase::kRound, 5);
  world.RunFor(1);
  EXPECT_EQ(world.director.game().note, "");
  world.frame.runner_silent = true;
  world.RunFor(0.1);
  EXPECT_EQ(world.director.game().phase, GamePhase::kRound);
  EXPECT_EQ(world.director.game().note, "the runner's controllers are silent");
  world.hand.known = false;
  world.RunFor(0.1);
  EXPECT_EQ(world.director.game().note,
            "the builder's Wiimote is silent: level ground; the runner's controllers are silent");
  world.hand.known = true;
  world.frame.runner_silent = false;
  world.frame.commanded = false;  // footingd itself.
  world.RunFor(0.1);
  EXPECT_EQ(world.director.game().note, "the runner's controllers are silent");
}

TEST(Director, LaysLevelGroundWhileTheBuildersDeviceIsSilent) {
  World world;
  world.RunUntil(GamePhase::kRound, 5);
  world.hand.known = false;
  world.RunFor(8);
  EXPECT_THAT(world.director.game().note, HasSubstr("level ground"));
  ASSERT_GT(world.laid.size(), 2u);
  for (const Piece& piece : world.laid) EXPECT_EQ(piece, Piece());
  EXPECT_GE(track::LengthOf(world.track) - world.frame.trial.progress.distance_m, 6);
}

TEST(Director, PlaysARoundAgainWhoseTrialIsGone) {
  World world;
  world.RunUntil(GamePhase::kRound, 5);
  world.RunFor(3);
  const std::string first = world.started;
  world.frame.trial = {};
  world.frame.time_s = 0;  // footing-sim was started again.
  world.Step();
  EXPECT_EQ(world.director.game().phase, GamePhase::kCountdown);
  EXPECT_TRUE(world.director.game().results.empty());
  world.RunUntil(GamePhase::kRound, 5);
  world.RunFor(1);
  EXPECT_NE(world.started, first);
  EXPECT_EQ(world.director.game().results.size(), 1u);
}

TEST(Director, PlaysARoundAgainWhoseTrialTheGameDidNotStop) {
  World world;
  world.RunUntil(GamePhase::kRound, 5);
  world.RunFor(3);
  const std::string stopped = world.started;
  world.frame.trial.progress.phase = stream::TrialPhase::kStopped;
  world.Step();
  EXPECT_EQ(world.director.game().phase, GamePhase::kWaiting);
  EXPECT_TRUE(world.director.game().results.empty()) << "3 s of 10 count for nobody";
  world.RunUntil(GamePhase::kPause, 15);
  EXPECT_NE(world.started, stopped);
  ASSERT_EQ(world.director.game().results.size(), 1u);
  EXPECT_EQ(world.director.game().results[0].runner, 0u);
  EXPECT_NEAR(world.director.game().results[0].distance_m, 0.5 + 2 * 10 - 1, 0.1);
}

TEST(Director, PublishesTenTimesASecond) {
  World world;
  int published = 0;
  for (int i = 0; i < 300; ++i) {
    world.frame.time_s += kStepS;
    world.hand.known = false;
    published += world.director.Advance(world.frame, world.seen, world.hand).publish;
  }
  EXPECT_NEAR(published, 30, 4);
}

}  // namespace
}  // namespace footing::game
