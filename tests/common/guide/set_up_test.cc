#include "common/guide/set_up.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/units/units.h"

namespace footing::guide {
namespace {

constexpr std::int64_t kSetUpSecondNs = 1'000'000'000;
constexpr double kWeightN = 70 * 9.80665;

/// Somebody with two boards and two shin devices who does what the prompts say, and a footingd that
/// answers. Boards 1 and 2 lie left and right; devices 3 and 4 are on the left and right shin.
class Person {
 public:
  Person() {
    for (std::uint32_t device = 1; device <= 4; ++device) {
      stream::DeviceStatus status;
      status.device = device;
      status.serial = "serial-" + std::to_string(device);
      status.kind = device <= 2 ? stream::DeviceKind::kBalanceBoard : stream::DeviceKind::kWiimote;
      status.state = stream::DeviceState::kLive;
      status.rig = "main";
      status.calibration = stream::CalibrationOrigin::kDevice;
      status.report_rate_hz = 90;
      devices.push_back(status);
    }
    SetRoles({stream::DeviceRole::kLeftBoard, stream::DeviceRole::kRightBoard,
              stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg});
  }

  void SetRoles(const std::vector<stream::DeviceRole>& roles) {
    for (std::size_t i = 0; i < roles.size(); ++i) devices[i].role = roles[i];
  }

  /// Runs a set-up to its end, at most two minutes of its own time.
  std::vector<stream::SetupItem> Do(std::vector<Item> items,
                                    std::vector<stream::DeviceRole> body_roles = {}) {
    SetUpOptions options;
    options.patience_s = 20;
    options.body_roles = std::move(body_roles);
    SetUp set_up(options, std::move(items));
    for (int i = 0; i < 20 * 120; ++i) {
      Live();
      Situation now;
      now.now_ns = now_ns_;
      now.recent = &recent_;
      now.setup = &setup_;
      now.adapters = {"hci0"};
      now.answers = std::move(answers_);
      answers_.clear();
      const Progress progress = set_up.Advance(now);
      Hear(progress.prompt);
      for (const Action& action : progress.actions) Serve(action);
      if (progress.finished) return set_up.results();
    }
    ADD_FAILURE() << "the set-up did not end; it asked: " << heard_;
    return set_up.results();
  }

  std::vector<stream::DeviceStatus> devices;
  double left_yaw_rad = -kPi / 2;  ///< How board 1 lies in truth.
  double right_yaw_rad = kPi / 2;
  bool deaf = false;        ///< Never does anything.
  bool clumsy = false;      ///< Shakes both shins at once.
  double mounting_deg = 4;  ///< What footingd finds.
  std::set<std::string> prompts;

 private:
  void Hear(const std::string& whole) {
    prompts.insert(whole);
    const std::string prompt = whole.substr(0, whole.find(" (Again"));
    if (prompt == heard_ || prompt.empty()) return;
    heard_ = prompt;
    heard_ns_ = now_ns_;
  }

  bool Asked(const char* text) const { return !deaf && heard_.find(text) != std::string::npos; }

  /// A twentieth of a second of samples.
  void Live() {
    recent_.SetDevices(devices);
    double left = 0;
    double right = 0;
    double lean_m = 0;
    double shake[2] = {0.1, 0.1};
    const double s = NanosecondsToSeconds(now_ns_ - heard_ns_);
    if (Asked("left board")) left = 1;
    if (Asked("right board")) right = 1;
    if (Asked("Stand upright") || Asked("one foot on each") || Asked("Lean")) left = right = 0.5;
    if (Asked("Lean")) lean_m = 0.05;
    if (Asked("Shake the left shin")) shake[0] = 12;
    if (Asked("Shake the right shin")) shake[1] = 12;
    if (clumsy && Asked("Shake")) shake[0] = shake[1] = 12;
    if (Asked("three steps") && s < 2.5) shake[0] = shake[1] = 8;
    for (int i = 0; i < 5; ++i) {
      now_ns_ += kSetUpSecondNs / 100;
      Put(1, left, left_yaw_rad, lean_m);
      Put(2, right, right_yaw_rad, lean_m);
      for (std::uint32_t j = 0; j < 2; ++j) {
        stream::MotionSample sample;
        sample.device = 3 + j;
        sample.received_ns = now_ns_;
        const double phase = 2 * kPi * 5 * NanosecondsToSeconds(now_ns_ % kSetUpSecondNs);
        sample.specific_force_mps2 = {shake[j] * std::sqrt(2) * std::sin(phase), 0, -9.81};
        recent_.Add(sample);
      }
    }
  }

  void Put(std::uint32_t device, double share, double yaw_rad, double forward_m) {
    stream::BoardSample sample;
    sample.device = device;
    sample.received_ns = now_ns_;
    sample.total_n = share * kWeightN + 1;
    sample.cop_valid = share > 0.1;
    if (sample.cop_valid) {  // Forward in the plate's frame: front and right, by its yaw.
      sample.cop_y_m = forward_m * std::cos(yaw_rad);
      sample.cop_x_m = forward_m * std::sin(yaw_rad);
    }
    recent_.Add(sample);
  }

  void Serve(const Action& action) {
    Answer answer;
    answer.key = action.key;
    answer.ok = true;
    if (action.kind == Action::Kind::kTare) answer.residual = 0.7;
    if (action.kind == Action::Kind::kSolveMounting) {
      answer.residual = mounting_deg;
      EXPECT_GE(action.still_to_ns - action.still_from_ns, 2 * kSetUpSecondNs);
      EXPECT_GT(action.steps_to_ns, action.steps_from_ns + 2 * kSetUpSecondNs);
    }
    if (action.kind == Action::Kind::kAssign) {  // A role that is taken is swapped.
      stream::DeviceStatus* one = nullptr;
      stream::DeviceStatus* other = nullptr;
      for (auto& device : devices) {
        if (device.serial == action.serial) one = &device;
        if (device.role == action.role) other = &device;
      }
      ASSERT_NE(one, nullptr);
      if (other != nullptr) std::swap(one->role, other->role);
      one->role = action.role;
    }
    answers_.push_back(answer);
  }

  std::int64_t now_ns_ = 100 * kSetUpSecondNs;
  std::int64_t heard_ns_ = 0;
  std::string heard_;
  Recent recent_;
  std::vector<stream::RigSetup> setup_;
  std::vector<Answer> answers_;
};

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

stream::SetupItem Done(Item item, const std::string& serial, std::int64_t wall_time_ns) {
  stream::SetupItem done = Outcome(item, serial, true, 1, "", "");
  done.wall_time_ns = wall_time_ns;
  return done;
}

TEST(Stale, MountingAfterANewRole) {
  Person person;
  for (auto& device : person.devices) device.mounted = true;
  const std::vector<stream::SetupItem> before{Done(Item::kMounting, "serial-3", 100),
                                              Done(Item::kRoles, "serial-3", 50)};
  EXPECT_FALSE(Merged(before, {}, person.devices)[1].stale);
  const auto after = Merged(before, {Done(Item::kRoles, "serial-3", 200)}, person.devices);
  EXPECT_EQ(after[1].name, "mounting");
  EXPECT_TRUE(after[1].stale);
  EXPECT_NE(after[1].note.find("--only mounting"), std::string::npos);
}

TEST(Stale, LayoutAndTareAfterABoardMoved) {
  Person person;
  person.devices[0].tared = true;
  const std::vector<stream::SetupItem> items{Done(Item::kLayout, "", 100),
                                             Done(Item::kTare, "serial-1", 100)};
  for (const auto& item : Merged(items, {}, person.devices)) EXPECT_FALSE(item.stale);
  person.devices[0].moved = true;
  for (const auto& item : Merged(items, {}, person.devices)) EXPECT_TRUE(item.stale) << item.name;
}

TEST(Stale, AnItemOfADeviceThatIsNotThereAnyMore) {
  Person person;
  const auto items = Merged({Done(Item::kTare, "another", 100)}, {}, person.devices);
  EXPECT_TRUE(items[0].stale);
}

TEST(Stale, ANewResultReplacesAStaleOne) {
  Person person;
  person.devices[0].tared = true;
  stream::SetupItem old = Done(Item::kTare, "serial-1", 100);
  old.stale = true;
  const auto items = Merged({old}, {Done(Item::kTare, "serial-1", 200)}, person.devices);
  ASSERT_EQ(items.size(), 1u);
  EXPECT_FALSE(items[0].stale);
}

}  // namespace
}  // namespace footing::guide
