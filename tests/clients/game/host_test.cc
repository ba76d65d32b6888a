#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "clients/game/host.h"
#include "common/stream/user_interface.h"
#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

void AddDevice(v1::Tick& tick, std::uint32_t device, v1::DeviceRole role, double roll_rad) {
  v1::DeviceFeatures& features = *tick.mutable_features()->add_rigs()->add_devices();
  features.set_device(device);
  features.set_role(role);
  features.set_inclination_valid(true);
  features.set_roll_rad(roll_rad);
  features.set_pitch_rad(-roll_rad);
}

void AddButtons(v1::Tick& tick, std::uint32_t device, std::uint32_t buttons) {
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_device(device);
  sample.set_buttons(buttons);
}

TEST(Messages, TakeTheHandFromTheEditorAlone) {
  v1::Tick tick;
  AddDevice(tick, 1, v1::DEVICE_ROLE_LEFT_HAND, 0.9);
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, 0.4);
  AddButtons(tick, 1, 0x000c);
  AddButtons(tick, 7, 0x0008);
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 7u);
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_EQ(hand.pitch_rad, -0.4);
  EXPECT_TRUE(hand.a);
  EXPECT_FALSE(hand.b);
  tick.mutable_motion()->mutable_samples(1)->set_buttons(0x0004);
  Take(tick, device, hand);
  EXPECT_FALSE(hand.a);
  EXPECT_TRUE(hand.b);
}

TEST(Messages, TakeTheWholeHandFromTheFirstRigsEditor) {
  v1::Tick tick;
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, 0.4);
  AddDevice(tick, 3, v1::DEVICE_ROLE_EDITOR, 0.9);
  AddButtons(tick, 3, 0x0004);
  AddButtons(tick, 7, 0x0008);
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 7u);
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_TRUE(hand.a);
  EXPECT_FALSE(hand.b);
  // A lost device stays in its rig, without an inclination.
  tick.mutable_features()->mutable_rigs(0)->mutable_devices(0)->set_inclination_valid(false);
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 3u);
  EXPECT_EQ(hand.roll_rad, 0.9);
  EXPECT_FALSE(hand.a);
  EXPECT_TRUE(hand.b);
}

TEST(Messages, KeepTheHandWhereATickSaysNothingOfIt) {
  std::uint32_t device = 7;
  Hand hand{true, 0.4, 0.2, true};
  EXPECT_FALSE(Take(v1::Tick(), device, hand));
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_TRUE(hand.a);
}

TEST(Messages, NeverTakeNumbersThatAreNotFinite) {
  v1::Tick tick;
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, std::numeric_limits<double>::quiet_NaN());
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(hand.roll_rad, 0);
}

TEST(Messages, TakeTheRunnersSilenceFromTheInterface) {
  v1::Tick tick;
  v1::Character& character = *tick.mutable_characters()->add_characters();
  tick.mutable_characters()->set_time_s(3);
  character.mutable_gait()->set_commanded_by_stream(true);
  character.mutable_interface()->set_activity(v1::ACTIVITY_ALTERNATE);
  EXPECT_EQ(FrameOf(tick).time_s, 3);
  EXPECT_TRUE(FrameOf(tick).commanded);
  EXPECT_FALSE(FrameOf(tick).runner_silent);
  character.mutable_interface()->set_missing_roles(stream::RoleBit(stream::DeviceRole::kHead));
  EXPECT_TRUE(FrameOf(tick).runner_silent);
  character.mutable_interface()->set_missing_roles(0);
  character.mutable_interface()->set_activity(v1::ACTIVITY_ABSENT);
  EXPECT_TRUE(FrameOf(tick).runner_silent);
}

TEST(Messages, AppendEveryPropertyOfAPiece) {
  const v1::AppendSegment append = ToCommand({2.5, 0.05, -0.2, 0.08, false}).append_segment();
  EXPECT_EQ(append.length_m(), 2.5);
  EXPECT_EQ(append.slope_rad(), 0.05);
  EXPECT_EQ(append.curve_rad(), -0.2);
  EXPECT_EQ(append.step_m(), 0.08);
  EXPECT_FALSE(append.pit());
  EXPECT_TRUE(ToCommand({0.5, 0, 0, 0, true}).append_segment().pit());
}

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
