#include "clients/view/scene/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Fixed, RoundsAndNeverWritesMinusZeroOrNan) {
  EXPECT_EQ(Fixed(1.25, 1), "1.2");  // 1.25 is exact; ties go to even.
  EXPECT_EQ(Fixed(-0.001, 2), "0.00");
  EXPECT_EQ(Fixed(-1.5, 1), "-1.5");
  EXPECT_EQ(Fixed(std::numeric_limits<double>::quiet_NaN(), 1), "0.0");
}

TEST(WaitingLines, SayWhatIsMissingAndHowToStartIt) {
  LinkReport link;
  link.address = "unix:/run/user/1000/footing/simulation.sock";
  const auto lines = WaitingLines(link);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0],
            "Waiting for a simulation server on unix:/run/user/1000/footing/simulation.sock");
  EXPECT_THAT(lines[1], HasSubstr("footing-sim"));
  EXPECT_THAT(lines[1], HasSubstr(link.address));
  link.address = "unix:/run/user/1000/footing/sensor.sock";
  EXPECT_THAT(WaitingLines(link)[1], HasSubstr("footingd"));
  link.state = LinkState::kLive;
  EXPECT_TRUE(WaitingLines(link).empty());
  link.state = LinkState::kRefused;
  link.why = "tls:127.0.0.1:7450 refused: no token";
  EXPECT_EQ(WaitingLines(link),
            (std::vector<std::string>{"No connection to the server", link.why}));
}

TEST(WaitingLines, WhoMayNotOpenTheSocketIsNotAskedToStartAServer) {
  const LinkReport link{"unix:/run/footing/simulation.sock", "", LinkState::kConnecting,
                        "waiting for unix:/run/footing/simulation.sock: permission denied; join "
                        "the group that owns the socket"};
  EXPECT_EQ(WaitingLines(link),
            (std::vector<std::string>{"No access to " + link.address, link.why}));
}

TEST(WaitingLines, ARefusalIsShownInTheServersOwnWords) {
  LinkReport link{"tcp:127.0.0.1:1", "", LinkState::kRefused, "update the viewer"};
  EXPECT_EQ(WaitingLines(link)[1], "update the viewer");
}

TEST(WaitingLines, AServerThatWentAwaySaysWhy) {
  const LinkReport link{"unix:/run/sensor.sock", "footingd", LinkState::kConnecting,
                        "waiting for unix:/run/sensor.sock: footingd is being stopped"};
  EXPECT_THAT(WaitingLines(link)[1], HasSubstr("footingd is being stopped"));
}

TEST(StatusScreen, ShowsForAWhileWhatSlowsAServer) {
  Model model = made::ModelAfter(3, {});
  model.links = {{"unix:/s", "footingd", LinkState::kLive, ""}};
  const double age_ms = AgeMs(model, made::ClockAt(3));
  Update update;
  update.live = false;
  update.received_ns = made::ClockAt(3);
  update.notes.push_back({NoteKind::kServer, made::ClockAt(3), "12 ticks left out", {}});
  Apply(model, update);
  EXPECT_THAT(StatusScreen(model, made::ClockAt(4)),
              Contains(HasSubstr("NOTICE: 12 ticks left out")));
  EXPECT_THAT(StatusScreen(model, made::ClockAt(40)), Not(Contains(HasSubstr("NOTICE"))));
  EXPECT_THAT(StatusLine(model, made::ClockAt(4)), HasSubstr("NOTICE: 12 ticks left out"));
  EXPECT_THAT(StatusLine(model, made::ClockAt(10)), Not(HasSubstr("NOTICE")));
  EXPECT_EQ(AgeMs(model, made::ClockAt(3)), age_ms) << "a notice is no data";
}

TEST(StatusScreen, NamesGaitSpeedDevicesAndThatTheInputIsSimulated) {
  const Model model = made::ModelAfter(3, {});
  const auto lines = StatusScreen(model, made::ClockAt(3));
  EXPECT_THAT(lines[0], HasSubstr("SIMULATED"));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("RUN"), HasSubstr("of 2.00"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("left_hand"), HasSubstr("98.7 Hz"),
                                    HasSubstr("battery 83 %"), HasSubstr("SIMULATED"))));
  EXPECT_THAT(lines, Contains(HasSubstr("72.4 kg")));
  EXPECT_THAT(lines, Contains(HasSubstr("age 1 ms")));
}

TEST(StatusLine, OneServerThatStandsStillShowsThoughTheOtherGoesOn) {
  Model model = made::ModelAfter(3, {});
  Update other;
  other.source = 1;
  other.host_ns = made::ClockAt(3);
  Apply(model, other);
  EXPECT_THAT(StatusLine(model, made::ClockAt(3)), HasSubstr("age 1 ms"));
  other.host_ns = made::ClockAt(13);
  Apply(model, other);
  EXPECT_THAT(StatusLine(model, made::ClockAt(13)), HasSubstr("no data for 10 s"));
  EXPECT_THAT(StatusScreen(model, made::ClockAt(13)), Contains(HasSubstr("no data for 10 s")));
}

TEST(StatusScreen, CountsFallsByCauseApartFromWhatTheOperatorPutBack) {
  const Model model = made::ModelAfter(3, {});
  stream::GaitState gait;
  gait.falls = 5;
  gait.failures = {.simulation = 0, .curve = 3, .jump = 2, .straightness = 0, .transition = 0};
  gait.operator_put_backs = 1;
  EXPECT_EQ(FallText(gait), "falls 5 (curve 3, jump 2), put back by the operator 1");
  EXPECT_EQ(FallText({}), "falls 0");
  EXPECT_THAT(StatusScreen(model, made::ClockAt(3)), Contains(HasSubstr("falls 0")));
}

TEST(StatusScreen, APhaseCalledFallIsNotShownBesideACountOfFalls) {
  EXPECT_EQ(PhaseTitle("fall"), "descend");
  EXPECT_EQ(PhaseTitle("rise"), "rise");
  Update update = made::TickAt(3, {});
  update.frame->characters[0].phase = "fall";
  Model model = made::ModelAfter(2.9, {});
  Apply(model, update);
  const auto lines = StatusScreen(model, made::ClockAt(3));
  EXPECT_THAT(lines, Contains(HasSubstr("descend")));
  EXPECT_THAT(lines, Not(Contains(HasSubstr("fall "))));
}

TEST(StatusScreen, RealDevicesCarryNoStamp) {
  made::Wish real;
  real.simulated = false;
  for (const std::string& line : StatusScreen(made::ModelAfter(3, real), made::ClockAt(3))) {
    EXPECT_THAT(line, Not(HasSubstr("SIMULATED")));
  }
}

TEST(StatusLine, SaysWhatItWaitsForBeforeAnythingCame) {
  Model model;
  model.links = {{"unix:/tmp/simulation.sock", "", LinkState::kConnecting, ""}};
  EXPECT_THAT(StatusLine(model, 0), HasSubstr("Waiting for a simulation server on unix:/tmp"));
}

TEST(InterfaceText, NamesTheInterfaceItsBeliefAndWhatItMisses) {
  stream::InterfaceState state;
  EXPECT_EQ(InterfaceText(state), "");
  state.interface = stream::UserInterface::kLeg;
  state.activity = stream::Activity::kAlternate;
  state.gait = stream::Gait::kWalk;
  state.next_gait = stream::Gait::kRun;
  state.frequency_valid = true;
  state.frequency_hz = 1.5;
  state.turn.source = stream::TurnSource::kHead;
  state.turn.share = -1.2;
  EXPECT_EQ(InterfaceText(state), "leg: stepping, 1.50 Hz -> WALK (RUN?), turn left by head");
  state.missing_roles =
      stream::RoleBit(stream::DeviceRole::kHead) | stream::RoleBit(stream::DeviceRole::kLeftLeg);
  EXPECT_THAT(InterfaceText(state), HasSubstr("missing: left leg, head"));
}

TEST(LostSignal, SaysWhatIsSilentWhatTheCharacterDoesAndWhatToDo) {
  made::Wish wish;
  wish.missing_roles = stream::RoleBit(stream::DeviceRole::kLeftHand) |
                       stream::RoleBit(stream::DeviceRole::kRightHand);
  const Model model = made::ModelAfter(3, wish);
  EXPECT_THAT(StatusScreen(model, made::ClockAt(3)),
              Contains(AllOf(HasSubstr("No signal from the left hand and the right hand."),
                             HasSubstr("The character stops"), HasSubstr("batteries"))));
  EXPECT_THAT(StatusLine(model, made::ClockAt(3)),
              HasSubstr("!! No signal from the left hand and the right hand"));
}

TEST(LostSignal, IsNoneWhileAllDevicesAreThereOrACommandTakesTheirPlace) {
  EXPECT_FALSE(LostSignalOf(made::TickAt(3, {}).frame->characters.front()));
  made::Wish wish;
  wish.missing_roles = stream::RoleBit(stream::DeviceRole::kLeftHand);
  CharacterPose pose = made::TickAt(3, wish).frame->characters.front();
  EXPECT_TRUE(LostSignalOf(pose));
  pose.gait.commanded_gait = stream::Gait::kRun;
  EXPECT_FALSE(LostSignalOf(pose));
  EXPECT_FALSE(LostSignalOf({}));
}

TEST(LostSignal, NamesTheSensorDaemonWhereNothingComesFromIt) {
  made::Wish wish;
  wish.missing_roles = stream::RoleBit(stream::DeviceRole::kLeftHand);
  CharacterPose pose = made::TickAt(3, wish).frame->characters.front();
  pose.gait.commanded_by_stream = false;
  EXPECT_THAT(LostLine(pose), AllOf(HasSubstr("No signal from any device"), HasSubstr("footingd")));
}

TEST(LostSignal, NamesTheHandOfTheJoystickAndTheBoard) {
  made::Wish wish;
  wish.missing_roles = stream::RoleBit(stream::DeviceRole::kLeftHand);
  CharacterPose pose = made::TickAt(3, wish).frame->characters.front();
  pose.interface.interface = stream::UserInterface::kJoystick;
  ASSERT_TRUE(LostSignalOf(pose));
  EXPECT_EQ(LostSignalOf(pose)->what, "No signal from the joystick in the left hand");
  EXPECT_THAT(InterfaceText(pose.interface), HasSubstr("missing: the joystick in the left hand"));
  pose.interface.missing_roles |= stream::RoleBit(stream::DeviceRole::kRightHand);
  EXPECT_EQ(LostSignalOf(pose)->what, "No signal from the joystick");
  pose.interface.interface = stream::UserInterface::kBoards;
  pose.interface.missing_roles = stream::RoleBit(stream::DeviceRole::kRightBoard);
  EXPECT_EQ(LostSignalOf(pose)->what, "No signal from the right board");
}

TEST(LostSignal, WithoutItsHeadAloneTheLegInterfaceDoesNotTurn) {
  CharacterPose pose = made::TickAt(3, {}).frame->characters.front();
  pose.interface.interface = stream::UserInterface::kLeg;
  pose.interface.missing_roles = stream::RoleBit(stream::DeviceRole::kHead);
  const auto lost = LostSignalOf(pose);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->what, "No signal from the head");
  EXPECT_THAT(lost->effect, HasSubstr("does not turn"));
}

TEST(InterfaceText, IsOnTheScreenAndInTheLog) {
  const Model model = made::ModelAfter(3, {});
  EXPECT_THAT(StatusScreen(model, made::ClockAt(3)),
              Contains(HasSubstr("wrist: hands swing alternately, 2.60 Hz")));
  EXPECT_THAT(StatusLine(model, made::ClockAt(3)), HasSubstr("wrist: hands swing alternately"));
}

}  // namespace
}  // namespace footing::scene
