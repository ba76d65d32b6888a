#include "clients/skeleton/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

TEST(Placement, PutsAFacingCamera) {
  // 2.5 m before the person, 1 m high, looking back along x: K's left is W's right.
  const Eigen::Isometry3d X_WK = ToPose({.p_W_m = {2.5, 0, 1}, .yaw_rad = kPi});
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LT((a - b).norm(), 1e-12) << a.transpose();
  };
  near(X_WK * Eigen::Vector3d(-0.3, 0.2, 2.5), {0, 0.3, 1.2});
  // Pitched up by 0.1 rad: what is straight ahead is higher.
  const Eigen::Isometry3d up = ToPose({.p_W_m = {0, 0, 0}, .yaw_rad = 0, .pitch_rad = 0.1});
  near(up * Eigen::Vector3d(0, 0, 1), {std::cos(0.1), 0, std::sin(0.1)});
  // Rolled so that its left side is up.
  const Eigen::Isometry3d rolled = ToPose({.p_W_m = {0, 0, 0}, .yaw_rad = 0, .roll_rad = 0.1});
  near(rolled * Eigen::Vector3d(1, 0, 0), {0, std::cos(0.1), std::sin(0.1)});
}

TEST(Placement, FindsACameraFromAPersonWhoStands) {
  const CameraPlace truth{
      .p_W_m = {2.1, 0.4, 1.3}, .yaw_rad = 2.9, .pitch_rad = -0.15, .roll_rad = 0.05};
  const Eigen::Isometry3d X_KW = ToPose(truth).inverse();
  const Eigen::Isometry3d X_WS =  // Standing() is before a level camera; feet to W's origin.
      ToPose({.p_W_m = {2.5, 0, 0.9 + kAnkleHeightM}, .yaw_rad = kPi});
  Skeleton seen = Standing();
  for (JointReading& joint : seen.joints) joint.p_K_m = X_KW * (X_WS * joint.p_K_m);
  const std::vector<Skeleton> frames(60, seen);
  const auto fit = FitStanding(frames, {.pitch_rad = truth.pitch_rad, .roll_rad = truth.roll_rad});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->place.yaw_rad, truth.yaw_rad, 1e-9);
  EXPECT_LT((fit->place.p_W_m - truth.p_W_m).norm(), 1e-9);
  EXPECT_LT(fit->lean_rad, 0.01);
  // With the tilt unknown, the person seems to lean by as much.
  const auto level = FitStanding(frames, {});
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->lean_rad, std::hypot(0.15, 0.05), 0.01);
}

TEST(Placement, RefusesWhatIsNoStand) {
  std::vector<Skeleton> frames(60, Standing());
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (JointReading& joint : frames[i].joints) joint.p_K_m.x() += 0.005 * static_cast<double>(i);
  EXPECT_NE(FitStanding(frames, {}).error().message.find("stand still"), std::string::npos);
  frames.assign(60, Standing());
  for (Skeleton& frame : frames) frame[Joint::kNeck].p_K_m.z() -= 0.3;
  EXPECT_NE(FitStanding(frames, {}).error().message.find("leans by"), std::string::npos);
  for (Skeleton& frame : frames) frame[Joint::kLeftFoot].confidence = 0;
  EXPECT_NE(FitStanding(frames, {}).error().message.find("step back"), std::string::npos);
}

TEST(Placement, RefusesSwappedSides) {
  // By its names the person looks away from the camera.
  const std::vector<Skeleton> swapped(60, SwappedSides(Standing()));
  const auto fit = FitStanding(swapped, {});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("--swap-sides"), std::string::npos);
  // A sender without a camera may look anywhere, but not with toes behind.
  EXPECT_TRUE(FitStanding(swapped, {}, false));
  Skeleton toes = Standing();
  toes.toes_K_m = Eigen::Vector3d(0, -0.1, -0.26);
  EXPECT_TRUE(FitStanding(std::vector<Skeleton>(60, toes), {}, false));
  for (const Skeleton& wrong : {SwappedSides(toes), SwappedSides(MirrorImage(toes))}) {
    const auto refused = FitStanding(std::vector<Skeleton>(60, wrong), {}, false);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("--swap-sides"), std::string::npos);
  }
  EXPECT_TRUE(FitStanding(std::vector<Skeleton>(60, MirrorImage(toes)), {}, false))
      << "of a true mirror image everything is in its place";
}

}  // namespace
}  // namespace footing::skeleton
