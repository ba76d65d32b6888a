// A worn sensor at the hub: its mounting, and how it slips.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/base/units.h"
#include "tests/sensor/service/kept.h"

namespace footing::sensor {
namespace {

using stream::DeviceRole;
using testing::HasSubstr;
using virtual_devices::BalanceBoard;
using virtual_devices::Wiimote;

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
  Result<Measured> Solve() {
    bench_.Advance(3);
    const std::int64_t stood_ns = bench_.now_ns();
    steps_from_s_ = NanosecondsToSeconds(stood_ns);
    steps_to_s_ = steps_from_s_ + 3;
    bench_.Advance(4);
    return bench_.hub().setup().SolveMounting(
        "a", {stood_ns - 2'100'000'000, stood_ns - 20'000'000, stood_ns, stood_ns + 3'500'000'000});
  }

  Kept kept_;
  Eigen::Quaterniond rotation_MS_ =
      Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()));
  double steps_from_s_ = 0;
  double steps_to_s_ = 0;
  double roll_rad_ = 0;
  Bench bench_{{}, kept_.storage()};
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
  Bench again({}, kept_.storage());
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
  ASSERT_TRUE(again.hub().setup().ClearMounting("a"));
  again.Advance(0.3);
  EXPECT_FALSE(again.StatusOf("a").mounted);
}

TEST_F(MountedLeg, ThatSlipsIsToldOverARestartUntilItIsSolvedAgain) {
  ASSERT_TRUE(Solve());
  ASSERT_TRUE(bench_.hub().setup().RecordSetup("main", Passed("mounting", "a"), false));
  bench_.Advance(5);
  EXPECT_FALSE(bench_.StatusOf("a").slipped);
  rotation_MS_ =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX())) * rotation_MS_;
  bench_.Advance(6);
  EXPECT_TRUE(bench_.StatusOf("a").slipped);
  EXPECT_TRUE(ItemOf(bench_, "mounting").stale);
  {
    Bench again({}, kept_.storage());
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
  const auto refused = bench_.hub().setup().SolveMounting("a", early);
  EXPECT_THAT(refused.ok() ? "" : refused.error().message, HasSubstr("are needed"));
  EXPECT_FALSE(bench_.hub().setup().SolveMounting("a", {}));
  EXPECT_FALSE(bench_.hub().setup().SolveMounting("board", early));
  EXPECT_FALSE(bench_.hub().setup().SolveMounting("nobody", early));
}

}  // namespace
}  // namespace footing::sensor
