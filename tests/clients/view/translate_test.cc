#include "clients/view/app/recorded_show.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::view {
namespace {

TEST(Translate, StampsMoveOntoTheViewersClock) {
  v1::Tick tick;
  tick.set_host_ns(5'000);
  tick.mutable_motion()->add_samples()->set_received_ns(4'900);
  const scene::Update update = Translate(tick, 3, 1'200, 4'000);
  EXPECT_EQ(update.source, 3);
  EXPECT_EQ(update.host_ns, 1'000);
  EXPECT_EQ(update.received_ns, 1'200);
  EXPECT_EQ(update.motion.at(0).received_ns, 900);
  EXPECT_TRUE(update.live);
}

TEST(Translate, SnapshotsAndRefilledTicksAreNotLive) {
  v1::Tick snapshot, refilled;
  snapshot.set_snapshot(true);
  refilled.set_refilled(true);
  EXPECT_FALSE(Translate(snapshot, 0, 0, 0).live);
  EXPECT_FALSE(Translate(refilled, 0, 0, 0).live);
}

TEST(Translate, ANoticeIsANoteWithoutATime) {
  v1::Notice notice;
  notice.set_text("slow");
  const scene::Update update = TranslateNotice(notice, 2, 7);
  EXPECT_EQ(update.source, 2);
  EXPECT_FALSE(update.live);
  EXPECT_EQ(update.host_ns, 0);
  ASSERT_EQ(update.notes.size(), 1u);
  EXPECT_EQ(update.notes[0].kind, scene::NoteKind::kServer);
  EXPECT_EQ(update.notes[0].text, "slow");
}

TEST(Translate, WhatATickDoesNotCarryStaysEmpty) {
  const scene::Update update = Translate({}, 0, 0, 0);
  EXPECT_FALSE(update.devices || update.skeletons || update.track || update.frame);
  EXPECT_TRUE(update.motion.empty() && update.boards.empty() && update.notes.empty());
}

TEST(Translate, NumbersThatAreNotFiniteDoNotReachThePicture) {
  v1::Tick tick;
  v1::Character& character = *tick.mutable_characters()->add_characters();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  character.mutable_com_m()->set_x(nan);
  character.add_links()->mutable_orientation()->set_w(nan);
  character.add_contacts()->set_normal_force_n(nan);
  character.mutable_gait()->set_speed_mps(nan);
  character.mutable_gait()->set_next_foothold_x_m(nan);
  const scene::CharacterPose pose = Translate(tick, 0, 0, 0).frame->characters.at(0);
  EXPECT_TRUE(pose.com_m.allFinite());
  EXPECT_NEAR(pose.links.at(0).orientation.norm(), 1, 1e-12);
  EXPECT_EQ(pose.contacts.at(0).normal_force_n, 0);
  EXPECT_EQ(pose.gait.speed_mps, 0);
  EXPECT_TRUE(pose.gait.next_foothold_m.allFinite());
}

TEST(Translate, ATrialComesThroughAndIsFinite) {
  v1::Tick tick;
  v1::TrialState& trial = *tick.mutable_characters()->add_characters()->mutable_trial();
  trial.set_trial("p07-2");
  trial.set_phase(v1::TrialState::PHASE_RUNNING);
  trial.set_time_s(std::numeric_limits<double>::quiet_NaN());
  trial.mutable_failures()->set_straightness(3);
  const scene::CharacterPose pose = Translate(tick, 0, 0, 0).frame->characters.at(0);
  ASSERT_TRUE(pose.trial.has_value());
  EXPECT_EQ(pose.trial->trial, "p07-2");
  EXPECT_EQ(pose.trial->progress.phase, stream::TrialPhase::kRunning);
  EXPECT_EQ(pose.trial->progress.time_s, 0);
  EXPECT_EQ(pose.trial->progress.failures.straightness, 3u);
}

TEST(Translate, AGameComesThroughAndIsFinite) {
  v1::Tick tick;
  v1::GameState& game = *tick.mutable_game();
  game.set_phase(v1::GameState::PHASE_ROUND);
  game.add_players()->set_name("Ann");
  game.mutable_players(0)->set_points(std::numeric_limits<double>::quiet_NaN());
  game.mutable_ghost()->set_length_m(2.5);
  const scene::Update update = Translate(tick, 0, 1, 0);
  ASSERT_TRUE(update.game.has_value());
  EXPECT_EQ(update.game->phase, stream::GamePhase::kRound);
  EXPECT_EQ(update.game->players.at(0).points, 0);
  EXPECT_EQ(update.game->ghost->length_m, 2.5);
  EXPECT_FALSE(Translate({}, 0, 1, 0).game.has_value());
}

TEST(Translate, TheInterfaceInForceComesThrough) {
  v1::Tick tick;
  v1::InterfaceState& state = *tick.mutable_characters()->add_characters()->mutable_interface();
  state.set_interface(v1::USER_INTERFACE_BOARDS);
  state.set_activity(v1::ACTIVITY_HEEL_RISE);
  state.set_left_share(std::numeric_limits<double>::quiet_NaN());
  state.set_view_roll_rad(0.2);
  const scene::Update update = Translate(tick, 0, 1, 0);
  const stream::InterfaceState& shown = update.frame->characters.front().interface;
  EXPECT_EQ(shown.interface, stream::UserInterface::kBoards);
  EXPECT_EQ(shown.activity, stream::Activity::kHeelRise);
  EXPECT_EQ(shown.left_share, 0);
  EXPECT_EQ(shown.view_roll_rad, 0.2);
}

TEST(Translate, AGaitOfANewerServerIsUnspecified) {
  v1::Tick tick;
  tick.mutable_characters()->add_characters()->mutable_gait()->set_gait(static_cast<v1::Gait>(77));
  EXPECT_EQ(Translate(tick, 0, 0, 0).frame->characters[0].gait.gait, stream::Gait::kUnspecified);
}

TEST(Translate, MoreCharactersThanASceneHoldsAreLeftOut) {
  v1::Tick tick;
  for (int i = 0; i < 1000; ++i) tick.mutable_characters()->add_characters();
  EXPECT_EQ(Translate(tick, 0, 0, 0).frame->characters.size(), 8u);
}

TEST(Translate, ABodyWithItsFeetComesThroughAndIsFinite) {
  v1::Tick tick;
  v1::BodyState& body = *tick.mutable_characters()->add_characters()->mutable_body();
  body.set_subject("p07");
  body.set_calibrated(true);
  body.set_mass_kg(std::numeric_limits<double>::quiet_NaN());
  body.add_feet()->set_load_n(300);
  body.add_feet()->mutable_variance_m2()->set_x(std::numeric_limits<double>::infinity());
  body.add_feet();  // From a newer server: a person has two.
  body.add_hands_seen(true);
  const scene::CharacterPose pose = Translate(tick, 0, 0, 0).frame->characters.at(0);
  ASSERT_TRUE(pose.body.has_value());
  EXPECT_EQ(pose.body->subject, "p07");
  EXPECT_EQ(pose.body->mass_kg, 0);
  EXPECT_EQ(pose.body->feet[0].load_n, 300);
  EXPECT_TRUE(pose.body->feet[1].variance_m2.allFinite());
  EXPECT_TRUE(pose.body->hands_seen[0]);
  EXPECT_FALSE(pose.body->hands_seen[1]);
}

TEST(Translate, AReferencePoseHasItsTimeOnTheViewersClock) {
  v1::Tick tick;
  v1::ReferencePose& pose = *tick.mutable_reference()->add_poses();
  pose.set_sampled_ns(5'000);
  pose.add_parents(-1);
  pose.add_positions_m()->set_z(1);
  const scene::Update update = Translate(tick, 0, 1'200, 4'000);
  ASSERT_TRUE(update.reference.has_value());
  EXPECT_EQ(update.reference->sampled_ns, 1'000);
  EXPECT_EQ(update.reference->received_ns, 1'200);
  EXPECT_EQ(update.reference->positions_m.at(0).z(), 1);
}

}  // namespace
}  // namespace footing::view
