// A board at the hub: geometry, corrections, alarms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "tests/sensor/service/kept.h"

namespace footing::sensor {
namespace {

using testing::HasSubstr;
using virtual_devices::BalanceBoard;

TEST(HubBoards, TheGeometryInForceIsPublishedWithTheLayoutOfEveryRigWithABoard) {
  Config config;
  config.plate.geometry.sensor_distance_x_m = 0.866;
  Bench bench(config);
  bench.Advance(0.1);
  EXPECT_TRUE(bench.content.setup.empty());
  bench.Attach(BalanceBoard(1), "a");
  bench.corners = {100, 200, 100, 200};
  bench.Advance(1);
  ASSERT_EQ(bench.content.setup.size(), 1u);
  const stream::RigSetup& published = bench.content.setup[0];
  EXPECT_EQ(published.rig, "main");
  EXPECT_EQ(published.layout.preset, "") << "nobody laid them out";
  ASSERT_TRUE(published.layout.left_geometry && published.layout.right_geometry);
  EXPECT_EQ(published.layout.left_geometry->sensor_distance_x_m, 0.866);
  EXPECT_EQ(published.layout.right_geometry->sensor_distance_y_m, 0.238);
  // Its samples are computed with it: (400 - 200) / 600 of half the distance.
  EXPECT_NEAR(bench.content.boards.back().cop_x_m, 0.866 / 2 / 3, 1e-3);
  ASSERT_TRUE(bench.hub().setup().SetBoardLayout(OneFootEach()));
  bench.Advance(0.1);
  ASSERT_EQ(bench.content.setup.size(), 1u);
  EXPECT_EQ(bench.content.setup[0].layout.preset, "one_foot_each");
  EXPECT_EQ(bench.content.setup[0].layout.left_geometry->sensor_distance_x_m, 0.866);
}

TEST(HubBoards, LocalGravityIsDividedOut) {
  constexpr double kEquatorMps2 = 9.78;
  Config told;
  told.local_gravity_mps2 = kEquatorMps2;
  Bench untold;
  Bench corrected(told);
  for (Bench* bench : {&untold, &corrected}) {
    // A mass that weighs 600 N under standard gravity weighs less there.
    const double corner_n = 150 * kEquatorMps2 / kStandardGravityMps2;
    bench->corners = {corner_n, corner_n, corner_n, corner_n};
    bench->Attach(BalanceBoard(1), "a");
    bench->Advance(0.5);
  }
  // A count is 0.11 N a corner.
  EXPECT_NEAR(untold.content.boards.back().total_n, 600 * kEquatorMps2 / kStandardGravityMps2, 0.3);
  EXPECT_NEAR(corrected.content.boards.back().total_n, 600, 0.3);
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

TEST(HubBoards, AnotherTemperatureIsTakenOff) {
  Bench bench;
  const auto handle = bench.Attach(BalanceBoard(1), "a");
  for (const int degrees : {-15, 0, 20}) {
    bench.ModelOf<BalanceBoard>(handle).set_temperature(
        static_cast<std::uint8_t>(BalanceBoard::kReferenceTemperature + degrees));
    bench.Advance(0.5);
    // Untreated, 20 degrees more would be 1.4 %, 8.4 N. What is left is counts, and the correction
    // as a factor of 1 - x where the cells gain 1 + x: x squared is 0.02 %.
    EXPECT_NEAR(bench.content.boards.back().total_n, 600, 0.35) << degrees;
  }
}

TEST(HubBoards, TheBatteryIsByteTenOfTheDataAndNotTheStatusReports) {
  Bench bench;
  const auto handle = bench.Attach(BalanceBoard(1), "a");
  auto& board = bench.ModelOf<BalanceBoard>(handle);
  bench.Advance(1.5);
  EXPECT_GT(bench.StatusOf("a").battery_fraction, 0.8);
  EXPECT_FALSE(bench.StatusOf("a").battery_low);
  board.controller().set_battery(0);  // Level in the status report: it must not be believed.
  ASSERT_TRUE(bench.hub().RequestDeviceStatus(1));
  bench.Advance(0.5);
  EXPECT_GT(bench.StatusOf("a").battery_fraction, 0.8);
  EXPECT_FALSE(bench.StatusOf("a").battery_low);
  board.set_battery(0x69);  // Just below the first bar.
  bench.Advance(0.5);
  EXPECT_TRUE(bench.StatusOf("a").battery_low);
  EXPECT_LT(bench.StatusOf("a").battery_fraction, 0.3);
}

TEST(HubBoards, ACalibrationWithAWrongChecksumIsNotUsedAndEverySampleSaysSo) {
  Bench bench;
  BalanceBoard board(1);
  board.controller().memory().extension()[0x24] ^= 1;
  bench.Attach(board, "a");
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").calibration, stream::CalibrationOrigin::kDefaults);
  EXPECT_THAT(bench.StatusOf("a").note, HasSubstr("checksum is wrong"));
  ASSERT_FALSE(bench.content.boards.empty());
  for (const auto& sample : bench.content.boards) {
    EXPECT_TRUE(sample.uncalibrated);
    EXPECT_TRUE(std::isfinite(sample.total_n));
  }
}

TEST(HubBoards, RepeatsAreFlaggedAndCountedAndNewsAreNot) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.Advance(0.5);
  const std::uint64_t before = bench.StatusOf("a").repeats;
  bench.content.boards.clear();
  for (int i = 1; i <= 20; ++i) {  // A new value every other report.
    bench.corners.top_left_n = 150 + i;
    bench.Advance(0.02);
  }
  ASSERT_EQ(bench.content.boards.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(bench.content.boards[i].repeated, i % 2 == 1) << i;
  }
  bench.Advance(0.3);  // The status is 0.2 s old at most.
  EXPECT_GE(bench.StatusOf("a").repeats, before + 20);
}

TEST(HubBoards, CountsStartAgainWhenADeviceIsAttachedAgain) {
  Bench bench;
  const auto handle = bench.Attach(BalanceBoard(1), "a");
  bench.Advance(5);  // Nothing changes: all but the first report repeat.
  EXPECT_GT(bench.StatusOf("a").repeats, 400u);
  bench.Detach(handle);
  bench.Attach(BalanceBoard(1), "a");
  bench.Advance(1);
  const auto status = bench.StatusOf("a");
  EXPECT_GT(status.repeats, 0u);
  EXPECT_LE(status.repeats, status.reports);
}

TEST(HubBoards, TheStatusSaysHowWellSampleTimesAreKnown) {
  Bench bench;
  bench.Attach(BalanceBoard(1), "a");
  bench.Advance(0.3);
  EXPECT_LT(bench.StatusOf("a").clock_offset_sd_ms, 0);  // Too few reports to say.
  bench.Advance(3);
  EXPECT_GE(bench.StatusOf("a").clock_offset_sd_ms, 0);
  // A sample held for up to 1/60 s: no worse than its period over the square root of 12.
  EXPECT_LT(bench.StatusOf("a").clock_offset_sd_ms, 1e3 / 60 / std::sqrt(12) + 0.5);
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
  const auto set = bench.hub().setup().SetBoardLayout(single);
  ASSERT_TRUE(set);
  EXPECT_THAT(set->message, HasSubstr("cannot be distinguished"));
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").note, "") << "it is meant to be alone";
}

TEST(HubBoards, TheLayoutOfOneBoardIsRefusedForTwo) {
  Bench bench;
  stream::BoardLayout single;
  single.preset = "single";
  bench.Attach(BalanceBoard(1), "a");
  ASSERT_TRUE(bench.hub().setup().SetBoardLayout(single));
  stream::SetupItem checked;
  checked.name = "layout";
  checked.passed = true;
  ASSERT_TRUE(bench.hub().setup().RecordSetup("main", checked, false));
  bench.Advance(0.5);
  const auto lines = bench.log.size();
  const auto second = bench.Attach(BalanceBoard(2), "b");
  bench.Advance(0.5);
  for (const char* serial : {"a", "b"}) {
    EXPECT_THAT(bench.StatusOf(serial).note, HasSubstr("--preset one_foot_each")) << serial;
  }
  ASSERT_FALSE(bench.content.setup.empty());
  EXPECT_TRUE(bench.content.setup[0].items[0].stale) << "what was checked was another layout";
  EXPECT_EQ(std::count_if(bench.log.begin() + static_cast<std::ptrdiff_t>(lines), bench.log.end(),
                          [](const std::string& line) {
                            return line.find("the layout single is for one board") !=
                                   std::string::npos;
                          }),
            1);
  const auto refused = bench.hub().setup().SetBoardLayout(single);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("rig main has 2"));
  ASSERT_TRUE(bench.hub().setup().SetBoardLayout(OneFootEach()));
  bench.Advance(0.5);
  EXPECT_EQ(bench.StatusOf("a").note, "");
  bench.Detach(second);
  EXPECT_TRUE(bench.hub().setup().SetBoardLayout(single));
}

class MovedBoard : public testing::Test {
 protected:
  void SetUp() override {
    bench_.Attach(BalanceBoard(1), "a");
    bench_.Attach(BalanceBoard(2), "b");
    bench_.corners = {0, 0, 0, 0};
    bench_.Advance(3);
    ASSERT_TRUE(bench_.hub().setup().Tare("a", 0, false) &&
                bench_.hub().setup().Tare("b", 0, false));
  }
  void Check() {
    ASSERT_TRUE(bench_.hub().setup().SetBoardLayout(OneFootEach()));
    ASSERT_TRUE(bench_.hub().setup().RecordSetup("main", Passed("layout"), false));
    ASSERT_TRUE(bench_.hub().setup().RecordSetup("main", Passed("tare", "a"), false));
  }
  void Lift() {
    bench_.corners = {-8, -8, -8, -8};  // Its feet hang: some 3 kg less than standing.
    bench_.Advance(1);
    bench_.corners = {0, 0, 0, 0};
    bench_.Advance(0.5);
  }
  Kept kept_;
  Bench bench_{{}, kept_.storage()};
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

  Bench again({}, kept_.storage());
  again.Attach(BalanceBoard(1), "a");
  again.corners = {0, 0, 0, 0};
  again.Advance(1);
  EXPECT_TRUE(again.StatusOf("a").moved);
  EXPECT_TRUE(ItemOf(again, "layout").stale);
  ASSERT_TRUE(again.hub().setup().RecordSetup("main", Passed("layout"), false));
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

}  // namespace
}  // namespace footing::sensor
