// The set-up's commands, its memory, and the alarms, with devices at the hub's ports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "common/units/units.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {
namespace {

using device_models::BalanceBoard;
using device_models::Wiimote;
using stream::DeviceRole;
using testing::HasSubstr;

/// What is kept between two benches, as on a disk.
class Kept {
 public:
  setup::Shelf shelf() {
    return {[this](const std::string& name) {
              const auto found = pieces_.find(name);
              return found == pieces_.end() ? std::nullopt : std::optional(found->second);
            },
            [this](const std::string& name, const std::string& text) { pieces_[name] = text; },
            [this](const std::string& name, const std::string&) { pieces_.erase(name); }};
  }

 private:
  std::map<std::string, std::string> pieces_;
};

stream::BoardLayout OneFootEach() {
  stream::BoardLayout layout;
  layout.rig = "main";
  layout.preset = "one_foot_each";
  layout.gap_mm = 20;
  layout.left = {0, 0.168, -kPi / 2};
  layout.right = {0, -0.168, kPi / 2};
  return layout;
}

stream::SetupItem Passed(const std::string& name, const std::string& serial = "") {
  stream::SetupItem item;
  item.name = name;
  item.serial = serial;
  item.passed = true;
  return item;
}

const stream::SetupItem& ItemOf(const Bench& bench, const std::string& name) {
  for (const auto& rig : bench.content.setup) {
    for (const auto& item : rig.items) {
      if (item.name == name) return item;
    }
  }
  ADD_FAILURE() << "no item " << name;
  static const stream::SetupItem kNone;
  return kNone;
}

TEST(HubTare, TakesTheEmptyWeightOffWithoutClampingAndIsKept) {
  Kept kept;
  {
    Bench bench({}, kept.shelf());
    bench.Attach(BalanceBoard(1), "a");
    bench.corners = {5, -4, 3, -2};
    bench.Advance(3);
    EXPECT_FALSE(bench.StatusOf("a").tared);
    const auto tare = bench.hub().Tare("a", 0, false);
    ASSERT_TRUE(tare) << tare.error().message;
    EXPECT_EQ(tare->unit, "N");
    EXPECT_LT(tare->residual, 1);
    bench.Advance(0.1);
    EXPECT_TRUE(bench.StatusOf("a").tared);
    EXPECT_TRUE(bench.content.boards.back().tared);
    EXPECT_NEAR(bench.content.boards.back().total_n, 0, 0.01);
    // Less than empty by 8 N: below zero, and published so.
    bench.corners = {3, -6, 1, -4};
    bench.Advance(0.1);
    EXPECT_NEAR(bench.content.boards.back().total_n, -8, 0.5);
  }
  Bench again({}, kept.shelf());
  again.Attach(BalanceBoard(1), "a");
  again.corners = {5, -4, 3, -2};
  again.Advance(0.5);
  EXPECT_TRUE(again.StatusOf("a").tared);
  EXPECT_NEAR(again.content.boards.back().top_left_n, 0, 0.2);
  ASSERT_TRUE(again.hub().Tare("a", 0, true));
  again.Advance(0.1);
  EXPECT_FALSE(again.StatusOf("a").tared);
  EXPECT_NEAR(again.content.boards.back().top_left_n, 5, 0.2);
}

TEST(HubTare, RefusesAMovingLoadAPersonAnotherDeviceAndNobody) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.Attach(Wiimote(2), "b");
  bench.corners = {10, 10, 10, 10};
  bench.Advance(1);
  const auto early = bench.hub().Tare("a", 0, false);
  EXPECT_THAT(early.ok() ? "" : early.error().message, HasSubstr("2.0 are needed"));
  bench.Advance(1.5);
  bench.corners = {20, 20, 20, 20};  // Somebody puts a foot on it.
  bench.Advance(0.5);
  const auto moving = bench.hub().Tare("a", 0, false);
  EXPECT_THAT(moving.ok() ? "" : moving.error().message, HasSubstr("moves"));
  bench.corners = {170, 170, 170, 170};
  bench.Advance(3);
  const auto heavy = bench.hub().Tare("a", 0, false);
  EXPECT_THAT(heavy.ok() ? "" : heavy.error().message, HasSubstr("step off"));
  EXPECT_FALSE(bench.hub().Tare("b", 0, false));
  EXPECT_FALSE(bench.hub().Tare("nobody", 0, false));
  EXPECT_FALSE(bench.hub().Tare("a", std::nan(""), false));
  EXPECT_FALSE(bench.StatusOf("a").tared);
}

TEST(HubBoards, AUniformStreamRunsBesideTheRawOneAtItsOwnRate) {
  Config config;
  config.board_uniform.rate_hz = 50;
  Bench bench(config);
  bench.Attach(BalanceBoard(1), "a");
  bench.corners = {100, 200, 100, 200};
  bench.Advance(3);
  ASSERT_GT(bench.content.uniform_boards.size(), 120u);
  std::int64_t before_ns = 0;
  for (const auto& sample : bench.content.uniform_boards) {
    if (before_ns != 0) {
      EXPECT_EQ(sample.sampled_ns - before_ns, 20'000'000);
    }
    before_ns = sample.sampled_ns;
    EXPECT_NEAR(sample.total_n, 600, 2);
    EXPECT_TRUE(sample.cop_valid);
    EXPECT_NEAR(sample.cop_x_m, 0.433 / 2 / 3, 1e-3);  // (400 - 200) / 600 of half the distance.
    EXPECT_FALSE(sample.gap);
    EXPECT_TRUE(sample.simulated);
  }
  EXPECT_GT(bench.content.boards.size(), 250u);  // The raw one is as before.
}

TEST(HubBoards, LocalGravityIsDividedOut) {
  Config config;
  config.local_gravity_mps2 = 9.78;
  Bench standard;
  Bench equator(config);
  for (Bench* bench : {&standard, &equator}) {
    bench->Attach(BalanceBoard(1), "a");
    bench->Advance(0.5);
  }
  EXPECT_NEAR(equator.content.boards.back().total_n / standard.content.boards.back().total_n,
              kStandardGravityMps2 / 9.78, 1e-9);
}

TEST(HubBoards, ForcesGoOnBeyondTheCalibrationPointsBothWays) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.corners = {600, -50, 600, -50};  // 61 kg a cell, and an edge that hangs.
  bench.Advance(0.5);
  // 0.1 % of the factory's gravity, and a count.
  EXPECT_NEAR(bench.content.boards.back().top_left_n, 600, 0.7);
  EXPECT_NEAR(bench.content.boards.back().top_right_n, -50, 0.2);
  EXPECT_THAT(bench.StatusOf("a").note, HasSubstr("over its range"));
}

TEST(HubBoards, UnderTheThresholdThereIsNoCentreOfPressure) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.corners = {12, 0, 12, 20};  // 44 N: less than 5 kg.
  bench.Advance(1);
  for (const auto& sample : bench.content.boards) {
    EXPECT_FALSE(sample.cop_valid || sample.contact);
    EXPECT_EQ(sample.cop_x_m, 0);
  }
  ASSERT_FALSE(bench.content.uniform_boards.empty());
  for (const auto& sample : bench.content.uniform_boards) {
    EXPECT_FALSE(sample.cop_valid);
    EXPECT_EQ(sample.cop_y_m, 0);
  }
}

TEST(HubBoards, OneAloneWorksAndSaysThatItIs) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.Advance(0.5);
  EXPECT_THAT(bench.StatusOf("a").note, HasSubstr("one board alone"));
  EXPECT_TRUE(bench.content.boards.back().cop_valid);
  const auto second = bench.Attach(BalanceBoard(2), "b");
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").note, "");
  EXPECT_EQ(bench.StatusOf("b").note, "");
  bench.Detach(second);
  bench.Advance(0.5);
  EXPECT_THAT(bench.StatusOf("a").note, HasSubstr("one board alone"));
  stream::BoardLayout single;
  single.preset = "single";
  const auto set = bench.hub().SetBoardLayout(single);
  ASSERT_TRUE(set);
  EXPECT_THAT(set->message, HasSubstr("not told apart"));
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").note, "") << "it is meant to be alone";
}

class MovedBoard : public testing::Test {
 protected:
  void SetUp() override {
    bench_.Attach(BalanceBoard(1), "a");
    bench_.Attach(BalanceBoard(2), "b");
    bench_.corners = {0, 0, 0, 0};
    bench_.Advance(3);
    ASSERT_TRUE(bench_.hub().Tare("a", 0, false) && bench_.hub().Tare("b", 0, false));
  }
  void Check() {
    ASSERT_TRUE(bench_.hub().SetBoardLayout(OneFootEach()));
    ASSERT_TRUE(bench_.hub().RecordSetup("main", Passed("layout"), false));
    ASSERT_TRUE(bench_.hub().RecordSetup("main", Passed("tare", "a"), false));
  }
  void Lift() {
    bench_.corners = {-8, -8, -8, -8};  // Its feet hang: some 3 kg less than standing.
    bench_.Advance(1);
    bench_.corners = {0, 0, 0, 0};
    bench_.Advance(0.5);
  }
  Kept kept_;
  Bench bench_{{}, kept_.shelf()};
};

TEST_F(MovedBoard, IsToldOverARestartUntilTheLayoutIsCheckedAgain) {
  Check();
  bench_.Advance(1);
  EXPECT_FALSE(bench_.StatusOf("a").moved);
  Lift();
  EXPECT_TRUE(bench_.StatusOf("a").moved);
  EXPECT_TRUE(ItemOf(bench_, "layout").stale);
  EXPECT_THAT(ItemOf(bench_, "layout").note, HasSubstr("moved"));
  EXPECT_TRUE(ItemOf(bench_, "tare").stale);
  EXPECT_THAT(bench_.log, testing::Contains(HasSubstr("was moved")));

  Bench again({}, kept_.shelf());
  again.Attach(BalanceBoard(1), "a");
  again.corners = {0, 0, 0, 0};
  again.Advance(1);
  EXPECT_TRUE(again.StatusOf("a").moved);
  EXPECT_TRUE(ItemOf(again, "layout").stale);
  ASSERT_TRUE(again.hub().RecordSetup("main", Passed("layout"), false));
  again.Advance(1);
  EXPECT_FALSE(again.StatusOf("a").moved);
  EXPECT_FALSE(ItemOf(again, "layout").stale);
}

TEST_F(MovedBoard, BeforeItsLayoutWasCheckedIsNoAlarm) {
  Lift();
  EXPECT_FALSE(bench_.StatusOf("a").moved);
  Check();
  bench_.Advance(1);
  EXPECT_FALSE(bench_.StatusOf("a").moved) << "what was before the check does not count";
}

TEST(HubLayout, IsCheckedKeptAndPublished) {
  Kept kept;
  {
    Bench bench({}, kept.shelf());
    ASSERT_TRUE(bench.hub().SetBoardLayout(OneFootEach()));
    ASSERT_TRUE(bench.hub().RecordSetup("", Passed("layout"), false));
    auto wider = OneFootEach();
    wider.gap_mm = 120;
    EXPECT_FALSE(bench.hub().SetBoardLayout(wider)) << "the poses leave 20 mm";
    wider.left.y_m += 0.1;
    ASSERT_TRUE(bench.hub().SetBoardLayout(wider));
    bench.Advance(0.1);
    EXPECT_TRUE(ItemOf(bench, "layout").stale) << "set anew, not checked";
  }
  Bench again({}, kept.shelf());
  again.Advance(0.1);
  ASSERT_EQ(again.content.setup.size(), 1u);
  EXPECT_EQ(again.content.setup[0].rig, "main");
  EXPECT_EQ(again.content.setup[0].layout.gap_mm, 120);
  EXPECT_EQ(again.content.setup[0].items.size(), 1u);
}

TEST(HubRecord, ForgetsAndRefusesWhatIsTooLong) {
  Bench bench;
  ASSERT_TRUE(bench.hub().RecordSetup("main", Passed("weigh"), false));
  bench.Advance(0.1);
  EXPECT_TRUE(ItemOf(bench, "weigh").passed);
  EXPECT_FALSE(bench.hub().RecordSetup("main", Passed(""), false));
  EXPECT_FALSE(bench.hub().RecordSetup(std::string(65, 'r'), Passed("weigh"), false));
  ASSERT_TRUE(bench.hub().RecordSetup("main", {}, true));
  bench.Advance(0.1);
  EXPECT_TRUE(bench.content.setup.empty());
}

TEST(HubRoles, GivenByCommandOutliveARestartAndTheConfig) {
  Kept kept;
  Config config;
  config.roles["a"] = "main/left_hand";
  {
    Bench bench(config, kept.shelf());
    bench.Attach(Wiimote(1), "a");
    bench.Attach(Wiimote(2), "b");
    bench.Advance(0.3);
    ASSERT_TRUE(bench.hub().AssignRole("a", {"main", DeviceRole::kRightHand}));
  }
  Bench again(config, kept.shelf());
  EXPECT_THAT(again.log, testing::Contains(HasSubstr("no longer main/left_hand")));
  again.Attach(Wiimote(2), "b");
  again.Attach(Wiimote(1), "a");
  again.Advance(0.3);
  EXPECT_EQ(again.StatusOf("a").role, DeviceRole::kRightHand);
  EXPECT_EQ(again.StatusOf("b").role, DeviceRole::kLeftHand) << "it was given a's role in exchange";
}

/// A wearer with one sensor, turned by `rotation_MS`, who stands, takes steps, stands, and leans.
class MountedLeg : public testing::Test {
 protected:
  void SetUp() override {
    bench_.wish = DeviceRole::kLeftLeg;
    Attach(bench_);
  }
  void Attach(Bench& bench) {
    bench.force = [this](double t_s) {
      const double swing = t_s > steps_from_s_ && t_s < steps_to_s_
                               ? 8 * std::sin(2 * kPi * (t_s - steps_from_s_))
                               : 0;
      Eigen::Vector3d force_M(0, 0.6 * swing, 0.8 * swing);
      force_M +=
          kStandardGravityMps2 * Eigen::Vector3d(std::sin(roll_rad_), 0, -std::cos(roll_rad_));
      return rotation_MS_.conjugate() * force_M;
    };
    bench.Attach(Wiimote(1), "a");
  }
  Result<Hub::Measured> Solve() {
    bench_.Advance(3);
    const std::int64_t stood_ns = bench_.now_ns();
    steps_from_s_ = NanosecondsToSeconds(stood_ns);
    steps_to_s_ = steps_from_s_ + 3;
    bench_.Advance(4);
    return bench_.hub().SolveMounting(
        "a", {stood_ns - 2'100'000'000, stood_ns - 20'000'000, stood_ns, stood_ns + 3'500'000'000});
  }

  Kept kept_;
  Eigen::Quaterniond rotation_MS_ =
      Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()));
  double steps_from_s_ = 0;
  double steps_to_s_ = 0;
  double roll_rad_ = 0;
  Bench bench_{{}, kept_.shelf()};
};

TEST_F(MountedLeg, IsSolvedAndItsFeaturesAreThoseOfAPerfectMounting) {
  const auto solved = Solve();
  ASSERT_TRUE(solved) << solved.error().message;
  EXPECT_EQ(solved->unit, "deg");
  EXPECT_LT(solved->residual, 5);
  bench_.Advance(0.3);
  EXPECT_TRUE(bench_.StatusOf("a").mounted);
  ASSERT_EQ(bench_.content.setup.size(), 1u);
  ASSERT_EQ(bench_.content.setup[0].mountings.size(), 1u);
  EXPECT_LT(bench_.content.setup[0].mountings[0].rotation_MS.angularDistance(rotation_MS_),
            DegreesToRadians(3));
  roll_rad_ = 0.3;
  bench_.Advance(2);
  const auto& leg = bench_.content.features.at(0).devices.at(0);
  EXPECT_TRUE(leg.inclination_valid);
  EXPECT_NEAR(leg.roll_rad, 0.3, DegreesToRadians(3));
  EXPECT_NEAR(leg.pitch_rad, 0, DegreesToRadians(3));
  // Samples are published as measured.
  const Eigen::Vector3d force_S = bench_.content.motion.back().specific_force_mps2;
  EXPECT_GT((force_S - rotation_MS_ * force_S).norm(), 5);
}

TEST_F(MountedLeg, IsKeptOverARestartForThisRoleOnly) {
  ASSERT_TRUE(Solve());
  Bench again({}, kept_.shelf());
  again.wish = DeviceRole::kLeftLeg;
  Attach(again);
  again.Advance(0.5);
  EXPECT_TRUE(again.StatusOf("a").mounted);
  ASSERT_TRUE(again.hub().AssignRole("a", {"main", DeviceRole::kHead}));
  again.Advance(0.3);
  EXPECT_FALSE(again.StatusOf("a").mounted);
  ASSERT_TRUE(again.hub().AssignRole("a", {"main", DeviceRole::kLeftLeg}));
  again.Advance(0.3);
  EXPECT_TRUE(again.StatusOf("a").mounted);
  ASSERT_TRUE(again.hub().ClearMounting("a"));
  again.Advance(0.3);
  EXPECT_FALSE(again.StatusOf("a").mounted);
}

TEST_F(MountedLeg, ThatSlipsIsToldOverARestartUntilItIsSolvedAgain) {
  ASSERT_TRUE(Solve());
  ASSERT_TRUE(bench_.hub().RecordSetup("main", Passed("mounting", "a"), false));
  bench_.Advance(5);
  EXPECT_FALSE(bench_.StatusOf("a").slipped);
  rotation_MS_ =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX())) * rotation_MS_;
  bench_.Advance(6);
  EXPECT_TRUE(bench_.StatusOf("a").slipped);
  EXPECT_TRUE(ItemOf(bench_, "mounting").stale);
  {
    Bench again({}, kept_.shelf());
    again.wish = DeviceRole::kLeftLeg;
    Attach(again);
    again.Advance(0.5);
    EXPECT_TRUE(again.StatusOf("a").slipped);
  }
  ASSERT_TRUE(Solve());
  bench_.Advance(5);
  EXPECT_FALSE(bench_.StatusOf("a").slipped);
}

TEST_F(MountedLeg, IsRefusedWithoutSamplesWithoutARoleAndForABoard) {
  bench_.Attach(BalanceBoard(2), "board");
  bench_.Advance(1);
  const MountingStretches early = {bench_.now_ns(), bench_.now_ns() + 2, bench_.now_ns() + 2,
                                   bench_.now_ns() + 4};
  const auto refused = bench_.hub().SolveMounting("a", early);
  EXPECT_THAT(refused.ok() ? "" : refused.error().message, HasSubstr("are needed"));
  EXPECT_FALSE(bench_.hub().SolveMounting("a", {}));
  EXPECT_FALSE(bench_.hub().SolveMounting("board", early));
  EXPECT_FALSE(bench_.hub().SolveMounting("nobody", early));
}

}  // namespace
}  // namespace footing::sensor
