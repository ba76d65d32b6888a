#include "daemon/offline/learning/own_take.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"

namespace footing::learning {
namespace {

constexpr double kYawRad = 0.3;
const Eigen::Vector2d kShiftM(0.4, -1.1);

Eigen::Vector2d Moved(const Eigen::Vector2d& p) {
  return Eigen::Vector2d(std::cos(kYawRad) * p.x() - std::sin(kYawRad) * p.y(),
                         std::sin(kYawRad) * p.x() + std::cos(kYawRad) * p.y()) +
         kShiftM;
}

TEST(PlaceFloor, FindsTheTurnAndTheShiftAmongFeetBeyondTheEdge) {
  // GIVEN two feet 30 cm apart with 5 mm of noise, every fifth pair held at a board's edge.
  noise::Random random(3);
  Eigen::Matrix2Xd from(2, 400), to(2, 400);
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    from.col(i) << 0.03 * random.Normal(), (i % 2 == 0 ? 0.15 : -0.15) + 0.01 * random.Normal();
    to.col(i) = Moved(from.col(i)) + 0.005 * Eigen::Vector2d(random.Normal(), random.Normal());
    if (i % 5 == 0) to.col(i).x() += 0.15;
  }
  const FloorPlacement placement = PlaceFloor(from, to);
  EXPECT_NEAR(placement.yaw_rad, kYawRad, 0.01);
  EXPECT_LT((placement.shift_m - kShiftM).norm(), 0.002);
  EXPECT_LT(placement.rms_m, 0.01);
  EXPECT_GT(placement.points, 300);
  EXPECT_LE(placement.points, 320);
}

TEST(Placed, TurnsAndMovesTheWholeBody) {
  const body::Skeleton skeleton = body::StandardPerson(1.7);
  const auto landmarks = body::FindLandmarks(skeleton).value();
  motion::Motion motion{.skeleton = skeleton, .rate_hz = 100, .start_s = 0, .q = {}};
  motion.q = body::TPose(skeleton, landmarks).replicate(1, 3);
  motion.q.row(0) << 0, 0.1, 0.2;
  const motion::Motion placed = Placed(motion, {.yaw_rad = kYawRad, .shift_m = kShiftM});
  body::Kinematics before(skeleton), after(skeleton);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    body::ComputeKinematics(skeleton, motion.q.col(t), before);
    body::ComputeKinematics(skeleton, placed.q.col(t), after);
    for (std::size_t joint = 0; joint < before.p_WJ.size(); ++joint) {
      EXPECT_LT((after.p_WJ[joint].head<2>() - Moved(before.p_WJ[joint].head<2>())).norm(), 1e-9);
      EXPECT_NEAR(after.p_WJ[joint].z(), before.p_WJ[joint].z(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace footing::learning
