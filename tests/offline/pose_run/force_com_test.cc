#include "daemon/offline/pose_run/force_com.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::pose_run {
namespace {

constexpr double kHeavyKg = 60, kCourseHz = 60, kCourseS = 13;
constexpr double kSwayRadps = 2 * kPi * 0.3, kSquatRadps = 2 * kPi * 0.4;

/// A body that squats and sways, and the forces under it.
struct Squatting {
  ForceCourse course;
  Eigen::Matrix3Xd com_m;
};

/// Forward c = 0.1 + 0.02 cos(w t), left c = -0.3 + 0.01 sin(w t), z = 0.9 + 0.1 cos(u t); the
/// forces are m times their second derivatives, with the weight. `turning_m` is the amplitude of
/// what the angular momentum adds to the COP; it changes to and fro with the squats.
Squatting Squat(double turning_m) {
  Squatting squat;
  const auto frames = static_cast<Eigen::Index>(kCourseS * kCourseHz);
  squat.course = {kCourseHz, Eigen::Matrix3Xd(3, frames), Eigen::Matrix2Xd(2, frames)};
  squat.com_m.resize(3, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    const double t_s = static_cast<double>(i) / kCourseHz;
    const double sway = kSwayRadps * t_s, bend = kSquatRadps * t_s;
    const Eigen::Vector3d c(0.1 + 0.02 * std::cos(sway), -0.3 + 0.01 * std::sin(sway),
                            0.9 + 0.1 * std::cos(bend));
    const Eigen::Vector3d a(-0.02 * kSwayRadps * kSwayRadps * std::cos(sway),
                            -0.01 * kSwayRadps * kSwayRadps * std::sin(sway),
                            -0.1 * kSquatRadps * kSquatRadps * std::cos(bend));
    squat.com_m.col(i) = c;
    const double lift_mps2 = kStandardGravityMps2 + a.z();
    squat.course.force_n.col(i) = kHeavyKg * Eigen::Vector3d(a.x(), a.y(), lift_mps2);
    squat.course.cop_m.col(i) = c.head<2>() - c.z() / lift_mps2 * a.head<2>();
    squat.course.cop_m(0, i) += turning_m * std::sin(bend) * kStandardGravityMps2 / lift_mps2;
  }
  return squat;
}

double MostOffM(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(ForceCom, FindsTheConstantsOfTheIntegrationByTheCop) {
  Squatting squat = Squat(0);
  const Eigen::VectorXd height_m = squat.com_m.row(2);
  // Trapezoids of 1/60 s are off by (w dt)^2 / 12 of an amplitude, 0.02 % here.
  EXPECT_LT(MostOffM(ComByForce(squat.course, height_m), squat.com_m), 2e-4);
  // A plate's shear that is not 0 without a load moves nobody away: 3 N would be 4 m in 13 s.
  squat.course.force_n.row(0).array() += 3;
  EXPECT_LT(MostOffM(ComByForce(squat.course, height_m), squat.com_m), 1e-3);
}

TEST(ForceCom, TakesTheWeightFromTheForcesAndNoMassFromTheHeights) {
  Squatting squat = Squat(0);
  squat.course.force_n *= 1.05;  // Of a heavier person, who moves the same way.
  Eigen::VectorXd height_m = squat.com_m.row(2);
  EXPECT_LT(MostOffM(ComByForce(squat.course, height_m), squat.com_m), 2e-4);
  // Heights that are too low in the squats, as wrong segment masses have them, by 2 cm: a sixth of
  // that remains in the constants.
  height_m.array() -= 0.02 * (0.5 - 0.5 * (height_m.array() - 0.9) / 0.1);
  const Eigen::Matrix3Xd com_m = ComByForce(squat.course, height_m);
  EXPECT_NEAR(com_m.row(2).maxCoeff() - com_m.row(2).minCoeff(), 0.2, 4e-3);
  EXPECT_LT((com_m - squat.com_m).topRows<2>().cwiseAbs().maxCoeff(), 1e-3);
}

TEST(ForceCom, IsNotMovedByAngularMomentumThatComesAndGoes) {
  const Squatting squat = Squat(0.04);
  const Eigen::VectorXd height_m = squat.com_m.row(2);
  const Eigen::Matrix3Xd com_m = ComByForce(squat.course, height_m);
  EXPECT_GT((squat.course.cop_m.row(0) - squat.com_m.row(0)).cwiseAbs().maxCoeff(), 0.04);
  EXPECT_LT((com_m.row(0) - squat.com_m.row(0)).cwiseAbs().maxCoeff(), 0.015);
}

TEST(ForceCom, PassesOverFramesInTheAir) {
  Squatting squat = Squat(0);
  const Eigen::VectorXd height_m = squat.com_m.row(2);
  squat.course.force_n.middleCols(300, 2).setZero();
  squat.course.cop_m.middleCols(300, 2).setZero();
  EXPECT_TRUE(ComByForce(squat.course, height_m).allFinite());
}

}  // namespace
}  // namespace footing::pose_run
