#include "clients/game/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

using ::testing::HasSubstr;

stream::GameState OneRound() {
  stream::GameState game;
  game.phase = stream::GamePhase::kOver;
  game.players = {{"Ann", 12}, {"Ben", 20.5}};
  game.rounds = 1;
  game.results.resize(1);
  game.results[0].trial = "g-1";
  game.results[0].runner_points = 12;
  game.results[0].builder_points = 20.5;
  game.results[0].failures.curve = 2;
  return game;
}

TEST(Report, CountsTheSegmentsByWhatTheyAre) {
  Collector seen;
  stream::Track track = ShortTrack();
  seen.OnTrack(track);
  seen.OnTrial(TrialAt("g-1", 2));
  for (const Piece& piece : {Piece{2, 0.05}, Piece{2, 0.05, 0.1}, Piece{2, 0, 0, 0.05},
                             Piece{1, 0, 0, 0, true}, Piece{2}}) {
    Lay(piece, track);
  }
  seen.OnTrack(track);
  seen.OnTrial(TrialAt("g-1", 2));
  const Report report = MakeReport(OneRound(), seen, 42);
  const auto json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["slopes"], 2);
  EXPECT_EQ(json["curves"], 1);
  EXPECT_EQ(json["steps"], 1);
  EXPECT_EQ(json["pits"], 1);
  EXPECT_EQ(json["winner"], "Ben");
  EXPECT_EQ(json["seconds"], 42);
  EXPECT_EQ(json["rounds"][0]["runner"], "Ann");
  EXPECT_EQ(json["rounds"][0]["failures"]["curve"], 2);
  EXPECT_EQ(json["rounds"][0]["builder_points"], 20.5);
}

TEST(Report, NamesTheWinnerADrawAndAGameThatDidNotEnd) {
  Report report{OneRound()};
  EXPECT_THAT(ToText(report), HasSubstr("Ben wins"));
  report.game.players[0].points = 20.5;
  EXPECT_THAT(ToText(report), HasSubstr("a draw"));
  report.game.phase = stream::GamePhase::kLeft;
  EXPECT_THAT(ToText(report), HasSubstr("did not end"));
}

TEST(Report, SaysInOneLineWhatTheBuilderHolds) {
  stream::GameState game = OneRound();
  game.phase = stream::GamePhase::kRound;
  game.left_s = 11.2;
  game.ghost.emplace();
  game.ghost->slope_rad = 0.0873;
  game.ghost_step_m = -0.05;
  EXPECT_THAT(ToLine(game), HasSubstr("round 1 of 1  12 s left  Ann runs 12  Ben builds"));
  EXPECT_THAT(ToLine(game), HasSubstr("slope 5.0 deg, curve 0.0 deg, step -5.0 cm"));
}

}  // namespace
}  // namespace footing::game
