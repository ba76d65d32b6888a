#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "common/guide/set_up.h"
#include "tests/common/guide/person.h"

namespace footing::guide {
namespace {

constexpr std::int64_t kMountingSecondNs = 1'000'000'000;

/// Runs for so long at 20 Hz with a shake that depends on the time, s.
StillThenSteps Watch(double seconds, const std::function<double(double)>& moving_mps2) {
  StillThenSteps still;
  for (int i = 0; i < seconds * 20; ++i) {
    still.Advance(10 * kMountingSecondNs + i * kMountingSecondNs / 20, moving_mps2(i / 20.0));
  }
  return still;
}

TEST(StillThenSteps, FindsTheStillnessAndTheStepsAfterIt) {
  // Restless for 3 s, still until 8 s, three steps until 10 s, then still.
  const StillThenSteps found = Watch(12, [](double t) {
    return t < 3 ? 3.0 : t < 8 ? 0.2 : t < 10 ? 5.0 : 0.2;
  });
  ASSERT_EQ(found.phase(), StillThenSteps::Phase::kDone);
  const auto at = [](double s) {
    return 10 * kMountingSecondNs + static_cast<std::int64_t>(s * 1e9);
  };
  EXPECT_GE(found.still_to_ns() - found.still_from_ns(), 2 * kMountingSecondNs);
  EXPECT_LE(found.still_to_ns(), at(7.5));
  EXPECT_GE(found.still_from_ns(), at(2.5));
  // The shake of half a second: movement may have begun so long before it shows.
  EXPECT_LE(found.steps_from_ns(), at(7.5));
  EXPECT_GE(found.steps_from_ns(), at(7.4));
  EXPECT_GT(found.steps_to_ns(), at(10.5));
  EXPECT_LT(found.steps_to_ns(), at(11.5));
}

TEST(StillThenSteps, WaitsForTwoWholeSecondsOfStillness) {
  const StillThenSteps found =
      Watch(12, [](double t) { return std::fmod(t, 1.5) < 0.2 ? 3 : 0.2; });
  EXPECT_EQ(found.phase(), StillThenSteps::Phase::kStill);
}

TEST(StillThenSteps, BeginsAnewAfterATwitch) {
  const StillThenSteps found = Watch(6, [](double t) { return t > 4 && t < 4.3 ? 4.0 : 0.2; });
  EXPECT_EQ(found.phase(), StillThenSteps::Phase::kStill);
}

TEST(Mounting, EveryWornRoleHasAPicture) {
  for (const auto role :
       {stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand, stream::DeviceRole::kLeftLeg,
        stream::DeviceRole::kRightLeg, stream::DeviceRole::kHead, stream::DeviceRole::kTrunk}) {
    EXPECT_GT(Picture(role).size(), 100u) << stream::Name(role);
    EXPECT_FALSE(Wearing(role).empty()) << stream::Name(role);
  }
  EXPECT_EQ(Picture(stream::DeviceRole::kLeftBoard), "");
}

const stream::SetupItem* Find(const std::vector<stream::SetupItem>& items, const std::string& name,
                              const std::string& serial = "") {
  for (const auto& item : items) {
    if (item.name == name && item.serial == serial) return &item;
  }
  return nullptr;
}

TEST(SetUp, LeadsFromTheBoxToAReadyRig) {
  Person person;
  const auto results = person.Do({});
  for (const auto& result : results) {
    EXPECT_TRUE(result.passed) << result.name << " " << result.note;
  }
  for (auto& device : person.devices) {
    device.tared = true;
    device.mounted = true;
  }
  std::vector<std::string> missing;
  EXPECT_TRUE(Ready(Merged({}, results, person.devices), person.devices, &missing))
      << (missing.empty() ? "" : missing.front());
  EXPECT_EQ(Find(results, "adapter")->note, "Bluetooth adapter hci0");
  EXPECT_EQ(Find(results, "adapter")->unit, "");  // No number such as "1.0 adapters" in its line.
  EXPECT_EQ(Find(results, "tare", "serial-1")->residual, 0.7);
  EXPECT_EQ(Find(results, "mounting", "serial-3")->unit, "deg");
  EXPECT_EQ(Find(results, "weigh")->note, "70.2 kg");  // 70 kg and 1 N on each board.
}

TEST(SetUp, WithoutBoardsAsksForNothingAboutBoards) {
  Person person;
  person.devices.erase(person.devices.begin(), person.devices.begin() + 2);
  const auto results = person.Do({});
  for (const std::string& prompt : person.prompts) {
    EXPECT_EQ(prompt.find("board"), std::string::npos) << prompt;
  }
  EXPECT_TRUE(person.prompts.contains("Shake the left shin now.")) << person.prompts.size();
  for (const char* item : {"layout", "tare", "weigh"}) EXPECT_EQ(Find(results, item), nullptr);
  for (auto& device : person.devices) device.mounted = true;
  EXPECT_TRUE(Ready(Merged({}, results, person.devices), person.devices, nullptr));
}

bool AskedForSteps(const Person& person) {
  return person.prompts.contains(
      "Now take three steps forward, starting with the left foot, and stand again.");
}

TEST(SetUp, AsksForNoStepsWithRemotesThatAreHeld) {
  const std::vector<stream::DeviceRole> hands{stream::DeviceRole::kLeftHand,
                                              stream::DeviceRole::kRightHand};
  const auto with_hands = [&] {
    Person person;
    person.SetRoles(
        {stream::DeviceRole::kLeftBoard, stream::DeviceRole::kRightBoard, hands[0], hands[1]});
    return person;
  };
  Person held = with_hands();
  const auto results = held.Do({});
  EXPECT_FALSE(AskedForSteps(held));
  EXPECT_EQ(Find(results, "mounting", "serial-3"), nullptr);
  for (auto& device : held.devices) device.tared = true;
  std::vector<std::string> missing;
  EXPECT_TRUE(Ready(Merged({}, results, held.devices), held.devices, &missing))
      << (missing.empty() ? "" : missing.front());

  Person wrists = with_hands();
  EXPECT_NE(Find(wrists.Do({}, hands), "mounting", "serial-3"), nullptr) << "named as worn";
  Person asked = with_hands();
  EXPECT_NE(Find(asked.Do({Item::kMounting}), "mounting", "serial-4"), nullptr);
  Person mounted = with_hands();
  mounted.devices[3].mounted = true;
  mounted.setup.emplace_back().rig = "main";
  mounted.setup[0].items = {Outcome(Item::kMounting, "serial-3", true, 1, "deg", "")};
  const auto again = mounted.Do({});
  EXPECT_NE(Find(again, "mounting", "serial-3"), nullptr) << "its mounting is recorded";
  EXPECT_NE(Find(again, "mounting", "serial-4"), nullptr) << "it has a mounting";
}

TEST(SetUp, GivesEachDeviceTheRoleOfTheGesture) {
  Person person;  // Roles begin crossed; the gestures put them right.
  person.SetRoles({stream::DeviceRole::kRightBoard, stream::DeviceRole::kLeftBoard,
                   stream::DeviceRole::kRightLeg, stream::DeviceRole::kLeftLeg});
  person.Do({Item::kRoles});
  EXPECT_EQ(person.devices[0].role, stream::DeviceRole::kLeftBoard);
  EXPECT_EQ(person.devices[1].role, stream::DeviceRole::kRightBoard);
  EXPECT_EQ(person.devices[2].role, stream::DeviceRole::kLeftLeg);
  EXPECT_EQ(person.devices[3].role, stream::DeviceRole::kRightLeg);
}

TEST(SetUp, AsksForWhatTheRemotesAreToBeWornAs) {
  Person person;  // Footingd took them for wrist remotes.
  person.SetRoles({stream::DeviceRole::kLeftBoard, stream::DeviceRole::kRightBoard,
                   stream::DeviceRole::kRightHand, stream::DeviceRole::kLeftHand});
  const auto results =
      person.Do({Item::kRoles}, {stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg});
  EXPECT_EQ(person.devices[2].role, stream::DeviceRole::kLeftLeg);
  EXPECT_EQ(person.devices[3].role, stream::DeviceRole::kRightLeg);
  EXPECT_TRUE(Find(results, "roles", "serial-3")->passed);
}

TEST(SetUp, GivesALoneRemoteItsRoleWithoutAGesture) {
  Person person;
  person.devices = {person.devices[2]};
  person.Do({Item::kRoles}, {stream::DeviceRole::kHead});
  EXPECT_EQ(person.devices[0].role, stream::DeviceRole::kHead);
  for (const std::string& prompt : person.prompts) EXPECT_EQ(prompt, "");
}

TEST(SetUp, SaysThatThereAreFewerRemotesThanRoles) {
  Person person;
  const auto results = person.Do(
      {Item::kRoles},
      {stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg, stream::DeviceRole::kHead});
  const auto* bad = Find(results, "roles", "");
  ASSERT_NE(bad, nullptr);
  EXPECT_FALSE(bad->passed);
  EXPECT_NE(bad->note.find("3 roles are requested, but only 2"), std::string::npos) << bad->note;
}

TEST(SetUp, LeavesTheRoleOfARemoteThatIsNotAskedFor) {
  Person person;
  const auto results = person.Do({Item::kRoles}, {stream::DeviceRole::kLeftLeg});
  EXPECT_TRUE(Find(results, "roles", "serial-4")->passed);
  EXPECT_EQ(person.devices[3].role, stream::DeviceRole::kRightLeg);
}

TEST(SetUp, DoesNotMountWhatLiesOnTheTable) {
  Person person;
  person.devices[3].role = stream::DeviceRole::kEditor;
  const auto results = person.Do({Item::kMounting});
  EXPECT_NE(Find(results, "mounting", "serial-3"), nullptr);
  EXPECT_EQ(Find(results, "mounting", "serial-4"), nullptr);
}

TEST(SetUp, NeverGuessesARoleWhenTwoAreShaken) {
  Person person;
  person.clumsy = true;
  const auto results = person.Do({Item::kRoles});
  ASSERT_EQ(results.size(), 1u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_NE(results[0].note.find("two devices move"), std::string::npos) << results[0].note;
}

TEST(SetUp, FindsSwappedBoards) {
  Person person;
  person.SetRoles({stream::DeviceRole::kRightBoard, stream::DeviceRole::kLeftBoard});
  const auto results = person.Do({Item::kLayout});
  ASSERT_EQ(results.size(), 1u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_NE(results[0].note.find("swapped"), std::string::npos) << results[0].note;
}

TEST(SetUp, FindsATurnedBoardAndTriesAgainFirst) {
  Person person;
  person.right_yaw_rad = -kPi / 2;
  const auto results = person.Do({Item::kLayout});
  ASSERT_EQ(results.size(), 1u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_NE(results[0].note.find("right board is turned"), std::string::npos) << results[0].note;
  bool again = false;
  for (const std::string& prompt : person.prompts)
    again = again || prompt.find("(Again, because") != prompt.npos;
  EXPECT_TRUE(again);
}

TEST(SetUp, RefusesAMountingThatDoesNotFit) {
  Person person;
  person.mounting_deg = 40;
  const auto results = person.Do({Item::kMounting});
  ASSERT_EQ(results.size(), 2u);
  EXPECT_FALSE(results[0].passed);
}

TEST(SetUp, TellsAnExhaustedBattery) {
  Person person;
  person.devices[2].battery_low = true;
  const auto results = person.Do({Item::kChecks});
  const auto* check = Find(results, "checks", "serial-3");
  ASSERT_NE(check, nullptr);
  EXPECT_FALSE(check->passed);
  EXPECT_NE(check->note.find("change the batteries"), std::string::npos);
  EXPECT_TRUE(Find(results, "checks", "serial-1")->passed);
}

TEST(SetUp, GivesUpOnAnItemThatGetsNowhere) {
  Person person;
  person.deaf = true;
  const auto results = person.Do({Item::kLayout, Item::kChecks});
  ASSERT_GE(results.size(), 2u);
  EXPECT_FALSE(results[0].passed);
  EXPECT_NE(results[0].note.find("timed out"), std::string::npos);
}

TEST(SetUp, WorksWithOneBoardAloneAndSaysSo) {
  Person person;
  person.devices.erase(person.devices.begin() + 1);  // The right one.
  person.left_yaw_rad = 0;
  const auto results = person.Do({Item::kRoles, Item::kLayout, Item::kTare});
  ASSERT_NE(Find(results, "layout"), nullptr);
  EXPECT_TRUE(Find(results, "layout")->passed) << Find(results, "layout")->note;
  EXPECT_NE(Find(results, "layout")->note.find("one board alone"), std::string::npos);
}

TEST(SetUp, NeedsNoBoards) {
  Person person;
  person.devices.erase(person.devices.begin(), person.devices.begin() + 2);
  const auto results = person.Do({});
  EXPECT_EQ(Find(results, "layout"), nullptr);
  for (auto& device : person.devices) device.mounted = true;
  EXPECT_TRUE(Ready(Merged({}, results, person.devices), person.devices, nullptr));
}

TEST(SetUp, EachPromptSaysWhichGestureItIsAbout) {
  using stream::DeviceRole;
  using stream::Gesture;
  Person person;
  person.Do({});
  EXPECT_EQ(person.gestures, (std::set<std::pair<Gesture, DeviceRole>>{
                                 {Gesture::kUnspecified, DeviceRole::kUnspecified},  // Checks.
                                 {Gesture::kSwitchOn, DeviceRole::kUnspecified},
                                 {Gesture::kHoldStill, DeviceRole::kUnspecified},
                                 {Gesture::kStepOff, DeviceRole::kUnspecified},
                                 {Gesture::kStepOn, DeviceRole::kLeftBoard},
                                 {Gesture::kStepOn, DeviceRole::kRightBoard},
                                 {Gesture::kStand, DeviceRole::kUnspecified},
                                 {Gesture::kLean, DeviceRole::kUnspecified},
                                 {Gesture::kShake, DeviceRole::kLeftLeg},
                                 {Gesture::kShake, DeviceRole::kRightLeg},
                                 {Gesture::kTakeSteps, DeviceRole::kUnspecified}}));
}

}  // namespace
}  // namespace footing::guide
