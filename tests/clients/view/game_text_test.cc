#include "clients/view/scene/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/clients/view/made_game.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using stream::GamePhase;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST(GameText, SaysWhatHappensInEachPhase) {
  stream::GameState game = made::Game();
  EXPECT_EQ(GameTitle(game), "Round 1 of 2");
  game.phase = GamePhase::kPause;
  EXPECT_EQ(GameTitle(game), "Change the controllers over");
  game.phase = GamePhase::kCountdown;
  EXPECT_EQ(GameTitle(game), "Round 2 of 2 begins");
  game.phase = GamePhase::kOver;
  EXPECT_EQ(GameTitle(game), "Ann wins");
  game.players[1].points = game.players[0].points;
  EXPECT_EQ(GameTitle(game), "A draw");
  game.phase = GamePhase::kLeft;
  EXPECT_EQ(GameTitle(game), "The game was left");
}

TEST(GameText, StaysAfterTheGameUntilAnotherTrialBegins) {
  stream::GameState game = made::Game();
  stream::TrialState trial;
  EXPECT_FALSE(ShowsGame({}, nullptr));
  for (const char* id : {"", "game-1", "after-game-1", "p07-2"}) {
    trial.trial = id;
    const bool other = trial.trial == "p07-2";
    game.phase = GamePhase::kRound;
    EXPECT_TRUE(ShowsGame(game, &trial)) << id;
    for (const GamePhase phase : {GamePhase::kOver, GamePhase::kLeft}) {
      game.phase = phase;
      EXPECT_EQ(ShowsGame(game, &trial), !other) << id;
    }
  }
}

TEST(GameText, CountsDownInMinutesAndSecondsAndNeverShowsZeroBeforeTheEnd) {
  stream::GameState game = made::Game();
  EXPECT_EQ(GameClock(game), "0:42");
  game.left_s = 61.2;
  EXPECT_EQ(GameClock(game), "1:02");
  game.left_s = 0.2;
  EXPECT_EQ(GameClock(game), "0:01");
  game.left_s = 0;
  EXPECT_EQ(GameClock(game), "");
}

TEST(GameStage, HasATitleACountdownGoAnEndOfEachRoundAndAWinner) {
  stream::GameState game = made::Game();
  EXPECT_FALSE(GameStage(game)) << "in a round the world alone matters";
  EXPECT_FALSE(GameStage({}));
  game.results.back().time_s = 0.4;
  EXPECT_EQ(GameStage(game)->count, "Go!");
  game.phase = GamePhase::kCountdown;
  for (const auto& [left_s, count] :
       {std::pair(4.2, "5"), std::pair(3.0, "3"), std::pair(0.3, "1"), std::pair(0.0, "1")}) {
    game.left_s = left_s;
    EXPECT_EQ(GameStage(game)->count, count) << left_s;
  }
  EXPECT_EQ(GameStage(game)->headline, "Round 2 of 2");
  EXPECT_EQ(GameStage(game)->detail, "Ann builds, Ben runs");
  game.phase = GamePhase::kPause;
  EXPECT_EQ(GameStage(game)->headline, "The round is over");
  EXPECT_EQ(GameStage(game)->count, "38 : 8");
  game.phase = GamePhase::kOver;
  EXPECT_EQ(GameStage(game)->headline, "Ann wins");
  game.phase = GamePhase::kLeft;
  EXPECT_FALSE(GameStage(game));
  game.phase = GamePhase::kWaiting;
  game.results.clear();
  EXPECT_EQ(GameStage(game)->headline, "Ann against Ben");
  EXPECT_EQ(GameStage(game)->detail, "Ann runs, Ben builds");
  game.note = "waiting for the builder's Wiimote";
  EXPECT_EQ(GameStage(game)->detail, game.note);
}

TEST(GameText, NamesThePartsOfTheRoundOrOfTheNextOne) {
  stream::GameState game = made::Game();
  EXPECT_EQ(PartText(game, 0), "runs");
  EXPECT_EQ(PartText(game, 1), "builds");
  game.phase = GamePhase::kCountdown;
  EXPECT_EQ(PartText(game, 0), "builds");
  EXPECT_EQ(PartText(game, 1), "runs");
  game.phase = GamePhase::kPause;
  EXPECT_EQ(PartText(game, 0), "");
}

TEST(GameText, NamesWhatTheBuilderHolds) {
  stream::GameState game = made::Game();
  EXPECT_EQ(GhostText(game), "next: slope up 3.2 deg, curve right 8 deg");
  game.ghost->slope_rad = 0;
  game.ghost_curve_rad = 0;
  EXPECT_EQ(GhostText(game), "next: level");
  game.ghost_step_m = -0.055;
  EXPECT_EQ(GhostText(game), "next: step down 5.5 cm");
  game.ghost->pit = true;
  EXPECT_EQ(GhostText(game), "next: a pit of 2.5 m");
  game.ghost.reset();
  EXPECT_EQ(GhostText(game), "");
}

TEST(GameText, IsInTheTextViewAndItsLine) {
  Model model = made::ModelAfter(1, {});
  EXPECT_THAT(StatusLine(model, made::ClockAt(1)), ::testing::Not(HasSubstr("game")));
  model.game = made::Game();
  EXPECT_THAT(StatusLine(model, made::ClockAt(1)),
              AllOf(HasSubstr("game: Round 1 of 2  0:42"),
                    HasSubstr("Ann (runs) 38 : Ben (builds) 8"), HasSubstr("next: slope up")));
  EXPECT_THAT(StatusScreen(model, made::ClockAt(1)),
              AllOf(Contains(HasSubstr("Round 1 of 2   0:42")),
                    Contains(HasSubstr("29.9 m, 6 of 10 segments passed, failures 1 (curve 1)"))));
}

TEST(GameGhost, LiesWhereItWillBeLaid) {
  Model model = made::ModelAfter(1, {});
  Stage stage;
  const auto ghosts = [&] {
    return stage.Advance(model, model.playout.Newest(), made::ClockAt(1), 0.02, {}).ghosts.boxes;
  };
  EXPECT_TRUE(ghosts().empty());
  model.game = made::Game();
  const auto boxes = ghosts();
  ASSERT_EQ(boxes.size(), 1u);
  // From (10, 1, 0) on, 2.5 m long, its middle half of that along its own slope.
  const Eigen::Matrix4f& X = boxes[0].X_WP;
  const auto rise = static_cast<float>(2.5 * std::sin(model.game.ghost->slope_rad));
  EXPECT_NEAR(X.col(0).head<3>().norm(), 2.5f, 1e-4f);
  EXPECT_NEAR(X.col(1).head<3>().norm(), 4, 1e-4f);
  EXPECT_NEAR(X(2, 0), rise, 1e-4f);
  EXPECT_NEAR(X(2, 3), rise / 2, 0.05f);
  const auto reach = static_cast<float>(2.5 * std::cos(model.game.ghost->slope_rad)) / 2;
  EXPECT_NEAR(X(0, 3), 10 + reach * std::cos(-0.14f), 0.01f);
  EXPECT_NEAR(X(1, 3), 1 + reach * std::sin(-0.14f), 0.01f);
}

}  // namespace
}  // namespace footing::scene
