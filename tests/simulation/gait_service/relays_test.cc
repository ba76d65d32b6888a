#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/lease.h"
#include "daemon/simulation/gait_service/relays.h"

namespace footing::gait_service {
namespace {

using ::testing::HasSubstr;

const transport::SessionInfo kAnn{1, "ann's game", v1::ROLE_CONTROL};
const transport::SessionInfo kBen{2, "ben's game", v1::ROLE_CONTROL};

v1::SetGame Game() {
  v1::SetGame message;
  v1::GameState& game = *message.mutable_game();
  game.set_phase(v1::GameState::PHASE_ROUND);
  game.add_players()->set_name("Ann");
  game.add_players()->set_name("Ben");
  game.set_rounds(2);
  game.mutable_ghost()->set_length_m(2);
  return message;
}

v1::Command Append() {
  v1::Command command;
  command.mutable_append_segment()->set_length_m(3);
  return command;
}

TEST(GameRelay, PublishesTheStateOnceAfterEachChange) {
  GameRelay relay;
  EXPECT_FALSE(relay.TakeChange());
  ASSERT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
  const auto game = relay.TakeChange();
  ASSERT_TRUE(game);
  EXPECT_EQ(game->host, "ann's game");
  EXPECT_EQ(game->players[1].name, "Ben");
  EXPECT_FALSE(relay.TakeChange());
}

TEST(GameRelay, RefusesASecondLeaderByTheNameOfTheFirst) {
  GameRelay relay;
  ASSERT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
  const v1::CommandResult second = relay.OnSetGame(kBen, Game());
  EXPECT_FALSE(second.ok());
  EXPECT_THAT(second.message(), HasSubstr("ann's game leads"));
  v1::SetGame leave;
  leave.set_leave(true);
  EXPECT_FALSE(relay.OnSetGame(kBen, leave).ok());
  EXPECT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
}

TEST(GameRelay, LetsOnlyTheLeaderChangeTheTrack) {
  GameRelay relay;
  EXPECT_FALSE(relay.Refuse(kBen, Append()));
  ASSERT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
  EXPECT_FALSE(relay.Refuse(kAnn, Append()));
  v1::Command start, stop, push;
  start.mutable_start_trial()->set_trial("p1");
  stop.mutable_stop_trial();
  push.mutable_push();
  for (const v1::Command& command : {Append(), start, stop}) {
    const auto refusal = relay.Refuse(kBen, command);
    ASSERT_TRUE(refusal);
    EXPECT_THAT(refusal->message(), HasSubstr("ann's game"));
  }
  EXPECT_FALSE(relay.Refuse(kBen, push));
}

TEST(GameRelay, SaysOnceThatAGameUnderWayWasLeft) {
  GameRelay relay;
  ASSERT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
  relay.OnSessionEnd(kBen);
  EXPECT_FALSE(relay.TakeLeft());
  relay.OnSessionEnd(kAnn);
  EXPECT_TRUE(relay.TakeLeft());
  EXPECT_FALSE(relay.TakeLeft());
  v1::SetGame over = Game();
  over.mutable_game()->set_phase(v1::GameState::PHASE_OVER);
  ASSERT_TRUE(relay.OnSetGame(kAnn, over).ok());
  relay.OnSessionEnd(kAnn);
  EXPECT_FALSE(relay.TakeLeft());  // Its track is not built on any more.
}

TEST(GameRelay, IsFreeAgainWhenTheLeaderIsGoneOrLeaves) {
  for (const bool leaves : {true, false}) {
    GameRelay relay;
    ASSERT_TRUE(relay.OnSetGame(kAnn, Game()).ok());
    relay.OnSessionEnd(kBen);
    EXPECT_TRUE(relay.Refuse(kBen, Append()));
    v1::SetGame leave;
    leave.set_leave(true);
    if (leaves) {
      EXPECT_TRUE(relay.OnSetGame(kAnn, leave).ok());
    } else {
      relay.OnSessionEnd(kAnn);
    }
    EXPECT_FALSE(relay.Refuse(kBen, Append()));
    const auto game = relay.TakeChange();
    ASSERT_TRUE(game);
    EXPECT_EQ(game->phase, stream::GamePhase::kLeft);
    EXPECT_FALSE(game->ghost);
    EXPECT_TRUE(relay.OnSetGame(kBen, Game()).ok());
  }
}

TEST(GameRelay, KeepsTheResultOfAGameThatIsOver) {
  GameRelay relay;
  v1::SetGame over = Game();
  over.mutable_game()->set_phase(v1::GameState::PHASE_OVER);
  ASSERT_TRUE(relay.OnSetGame(kAnn, over).ok());
  relay.OnSessionEnd(kAnn);
  EXPECT_EQ(relay.TakeChange()->phase, stream::GamePhase::kOver);
}

TEST(GameRelay, RefusesAStateThatCannotBeAndTakesNoLeadWithIt) {
  GameRelay relay;
  const auto refused = [&relay](const v1::SetGame& message, const char* why) {
    const v1::CommandResult result = relay.OnSetGame(kAnn, message);
    EXPECT_FALSE(result.ok()) << why;
    EXPECT_THAT(result.message(), HasSubstr(why));
  };
  refused({}, "phase");
  v1::SetGame one = Game();
  one.mutable_game()->mutable_players()->RemoveLast();
  refused(one, "two players");
  v1::SetGame nameless = Game();
  nameless.mutable_game()->mutable_players(0)->set_name(std::string(25, 'x'));
  refused(nameless, "1 to 24 bytes");
  v1::SetGame endless = Game();
  endless.mutable_game()->set_rounds(21);
  refused(endless, "1 to 20 rounds");
  v1::SetGame third = Game();
  third.mutable_game()->add_results()->set_runner(2);
  refused(third, "0 or 1");
  v1::SetGame novel = Game();
  novel.mutable_game()->set_note(std::string(201, 'x'));
  refused(novel, "200 bytes");
  EXPECT_FALSE(relay.TakeChange());
  EXPECT_TRUE(relay.OnSetGame(kBen, Game()).ok());
}

TEST(GameRelay, PublishesNoNumberThatIsNotFinite) {
  GameRelay relay;
  v1::SetGame message = Game();
  message.mutable_game()->set_left_s(std::numeric_limits<double>::quiet_NaN());
  message.mutable_game()->mutable_ghost()->set_length_m(std::numeric_limits<double>::infinity());
  ASSERT_TRUE(relay.OnSetGame(kAnn, message).ok());
  const auto game = relay.TakeChange();
  EXPECT_EQ(game->left_s, 0);
  EXPECT_EQ(game->ghost->length_m, 0);
}

using testing::HasSubstr;

const transport::SessionInfo kStudyClient{1, "footing-study", v1::ROLE_CONTROL};
const transport::SessionInfo kOtherClient{2, "other", v1::ROLE_CONTROL};

v1::SetStudy State(const std::string& participant) {
  v1::SetStudy message;
  message.mutable_study()->set_participant(participant);
  return message;
}

TEST(StudyRelay, HandsTheStateOnOnceAndForgetsItWithItsSession) {
  StudyRelay relay;
  EXPECT_FALSE(relay.TakeChange(0));
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, State("P01")).ok());
  EXPECT_EQ(relay.TakeChange(0)->participant, "P01");
  EXPECT_FALSE(relay.TakeChange(0));
  relay.OnSessionEnd(kOtherClient);
  EXPECT_FALSE(relay.TakeChange(0));
  relay.OnSessionEnd(kStudyClient);
  EXPECT_EQ(relay.TakeChange(0)->participant, "");
}

TEST(StudyRelay, SendsACountdownAgainAsItGoesOn) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  StudyRelay relay;
  v1::SetStudy message = State("P01");
  message.mutable_study()->set_left_s(2.5);
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, message).ok());
  EXPECT_EQ(relay.TakeChange(10 * kSecond)->left_s, 2.5);
  std::vector<double> left_s;
  for (std::int64_t ms = 10; ms < 10'000; ms += 10) {
    const auto again = relay.TakeChange(10 * kSecond + ms * 1'000'000);
    if (again) left_s.push_back(again->left_s);
  }
  ASSERT_EQ(left_s.size(), 3u) << "no more once it has ended";
  EXPECT_NEAR(left_s[0], 1.5, 1e-9);
  EXPECT_NEAR(left_s[1], 0.5, 1e-9);
  EXPECT_GT(left_s[2], 0) << "0 would say that nothing was counted";
  EXPECT_LT(left_s[2], 0.01);
  message.mutable_study()->set_left_s(0);
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, message).ok());
  EXPECT_TRUE(relay.TakeChange(30 * kSecond));
  EXPECT_FALSE(relay.TakeChange(40 * kSecond));
}

TEST(StudyRelay, RefusesWhatNoScreenCanShow) {
  StudyRelay relay;
  EXPECT_THAT(relay.OnSetStudy(kStudyClient, State(std::string(500, 'x'))).message(),
              HasSubstr("more than 400 bytes"));
  v1::SetStudy message = State("P01");
  message.mutable_study()->set_active_s(std::numeric_limits<double>::infinity());
  ASSERT_TRUE(relay.OnSetStudy(kStudyClient, message).ok());
  EXPECT_EQ(relay.TakeChange(0)->active_s, 0);  // As the protocol reads what is not finite.
}

TEST(StudyRelay, IsForTheHolderOfTheLease) {
  lease::LeaseControl lease("footing-sim");
  v1::Command take;
  take.mutable_take_lease()->set_holder("ann");
  ASSERT_TRUE(lease.Answer(take, kStudyClient.session, 0)->ok());
  v1::Command command;
  *command.mutable_set_study() = State("P01");
  EXPECT_FALSE(lease.Answer(command, kStudyClient.session, 1));
  ASSERT_TRUE(lease.Answer(command, kOtherClient.session, 1));
  EXPECT_THAT(lease.Answer(command, kOtherClient.session, 1)->message(),
              HasSubstr("set_study: ann"));
}

}  // namespace
}  // namespace footing::gait_service
