#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/offline/pose_run/plates.h"
#include "daemon/offline/pose_run/pose_run.h"

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
  squat.course.force_n *= 1.05;  // Forces of a heavier person, who moves the same way.
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

namespace sensors = virtual_sensors;

constexpr double kMassKg = 75;

/// Sways to the left and right and up and down by centimetres, on straight legs.
motion::Motion Swaying(Eigen::Index frames = 400) {
  motion::Motion motion;
  motion.skeleton = body::StandardPerson(1.75);
  const body::Landmarks landmarks = body::FindLandmarks(motion.skeleton).value();
  motion.rate_hz = 100;
  motion.q = body::TPose(motion.skeleton, landmarks).replicate(1, frames);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double t_s = static_cast<double>(i) / motion.rate_hz;
    motion.q(1, i) += 0.02 * std::sin(2 * kPi * 0.5 * t_s);
    motion.q(2, i) += 0.01 * (1 - std::cos(2 * kPi * 1.0 * t_s));
  }
  return motion;
}

/// The clip somewhere else in its laboratory, walking off to `yaw_rad`.
motion::Motion Moved(motion::Motion clip, double yaw_rad, const Eigen::Vector3d& by_m) {
  const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kZ, yaw_rad);
  const body::Joint& root = clip.skeleton.joint(0);
  for (Eigen::Index i = 0; i < clip.frames(); ++i) {
    Eigen::VectorXd q = clip.q.col(i);
    body::SetJointRotation(root, turn * body::JointRotation(root, q), q);
    q.head<3>() = turn * clip.q.col(i).head<3>() + by_m;
    clip.q.col(i) = q;
  }
  return clip;
}

/// Forces on plates under the clip, one under each foot, the left foot's being the second. W of the
/// file is W of the clip.
motion::GroundForces Plates(const motion::Motion& clip, double begin_s = 0) {
  const auto scene = Stage(clip, {}, "swaying").value();
  const Eigen::Index before = scene.motion.frames() - clip.frames();
  const body::Joint& root = clip.skeleton.joint(0);
  const Eigen::Matrix3d turn = body::JointRotation(root, clip.q.col(0)) *
                               body::JointRotation(root, scene.motion.q.col(before)).transpose();
  const Eigen::Vector3d by = clip.q.col(0).head<3>() - turn * scene.motion.q.col(before).head<3>();
  motion::GroundForces forces;
  forces.rate_hz = 200;
  forces.start_s = begin_s;
  const auto count = 2 * clip.frames() - 1 - static_cast<Eigen::Index>(forces.rate_hz * begin_s);
  for (const char* name : {"under_right", "under_left"}) {
    const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, count);
    forces.plates.push_back({name, none, none, none});
  }
  Eigen::Index last = -1;
  std::array<sensors::FootForce, sensors::kFeet> felt;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double clip_s = static_cast<double>(i) / forces.rate_hz + begin_s;
    const Eigen::Index column =
        before + std::clamp<Eigen::Index>(std::lround(clip_s * clip.rate_hz), 0, clip.frames() - 1);
    if (column != last) felt = sensors::ShareBetweenFeet(scene.course, scene.reaction, column);
    last = column;
    for (std::size_t f = 0; f < felt.size(); ++f) {
      motion::PlateForces& plate = forces.plates[1 - f];
      plate.force_W(2, i) = felt[f].load_n;
      const Eigen::Vector3d force_n = scene.reaction.force_n.col(column);
      plate.force_W.col(i).head<2>() = felt[f].load_n / force_n.z() * (turn * force_n).head<2>();
      plate.cop_W.col(i) = turn * Eigen::Vector3d(felt[f].cop_m.x(), felt[f].cop_m.y(), 0) + by;
    }
  }
  return forces;
}

Result<PlateRun> OnPlates(const motion::Motion& clip, const motion::GroundForces& forces) {
  Settings settings;
  settings.mass_kg = kMassKg;
  return RunOnPlates(clip, forces, settings, "clip.trc", "forces.mot");
}

TEST(Plates, AreFoundUnderTheFeetWhereverTheLaboratoryIs) {
  const motion::Motion clip = Moved(Swaying(), 0.8, {3, -2, 0.1});
  const auto made = OnPlates(clip, Plates(clip));
  ASSERT_TRUE(made.ok()) << made.error().message;
  const PlateReport& report = made->report;
  ASSERT_EQ(report.plates.size(), 2u);
  EXPECT_EQ(report.plates[0].plate, "under_right");
  EXPECT_EQ(report.plates[0].loaded_s[0], 0);
  EXPECT_NEAR(report.plates[0].loaded_s[1], 4, 0.02);
  EXPECT_EQ(report.plates[1].loaded_s[1], 0);
  EXPECT_NEAR(report.plates[1].loaded_s[0], 4, 0.02);
  EXPECT_LT(report.plates[0].beside_m, 0.04);  // No further than a sole is wide.
  EXPECT_NEAR(report.mass_kg, kMassKg, 1);
  EXPECT_EQ(report.supported_share, 1);
  EXPECT_TRUE(report.warnings.empty());
  // Forces that inverse dynamics made are those that it makes: within what half a step of the
  // coarser rate changes.
  EXPECT_LT(report.force_rms_n, 0.01 * kMassKg * kStandardGravityMps2);
  EXPECT_LT(report.cop_rms_m.maxCoeff(), 0.01);
  ASSERT_EQ(made->measured.frames.size(), made->simulated.frames.size());
  EXPECT_GT(made->measured.judged_from, std::size_t{7 * 60});  // Behind the T-pose.
}

TEST(Plates, DriveTheCells) {
  const motion::Motion clip = Swaying();
  motion::GroundForces forces = Plates(clip);
  for (auto& plate : forces.plates) plate.force_W.row(2) *= 1.04;
  const auto made = OnPlates(clip, forces);
  ASSERT_TRUE(made.ok()) << made.error().message;
  const auto total = [](const PoseRun& run, std::size_t i) {
    return momentum::PressureOf(run.frames[i].inputs.loads, 10).total_n;
  };
  EXPECT_NEAR(total(made->measured, 100), total(made->simulated, 100), 1e-9);  // The T-pose.
  for (std::size_t i = made->measured.judged_from; i < made->measured.frames.size(); ++i) {
    EXPECT_NEAR(total(made->measured, i) / total(made->simulated, i), 1.04, 0.02);
  }
  EXPECT_NEAR(made->report.force_rms_n, 0.04 * kMassKg * kStandardGravityMps2, 3);
}

TEST(Plates, GoOverFromTheTPoseWithoutAStep) {
  const motion::Motion clip = Swaying();
  motion::GroundForces forces = Plates(clip);
  for (auto& plate : forces.plates) plate.cop_W.row(0).array() += 0.03;
  const auto made = OnPlates(clip, forces);
  ASSERT_TRUE(made.ok()) << made.error().message;
  double last = 0, most = 0;
  for (std::size_t i = 0; i < made->measured.frames.size(); ++i) {
    const auto cop = [i](const PoseRun& run) {
      return momentum::PressureOf(run.frames[i].inputs.loads, 10).p_WP_m.x();
    };
    const double off = cop(made->measured) - cop(made->simulated);
    if (i > 0) most = std::max(most, std::abs(off - last));
    last = off;
  }
  EXPECT_NEAR(last, 0.03, 0.002);
  // The quintic's steepest slope is 1.875 of its mean one: 3 cm in 1.5 s, a sixtieth at a time.
  EXPECT_LT(most, 1.5 * 1.875 * 0.03 / 1.5 / 60);
}

TEST(Plates, TellTheirOwnTime) {
  const motion::Motion clip = Swaying();
  const auto late = OnPlates(clip, Plates(clip, 1.5));
  ASSERT_TRUE(late.ok()) << late.error().message;
  EXPECT_NEAR(late->report.begin_s, 1.5, 1e-9);
  EXPECT_NEAR(late->report.end_s, 3.99, 1e-9);
  EXPECT_LT(late->report.cop_rms_m.y(), 0.004);  // The body sways by 2 cm.
  const auto early = OnPlates(clip, Plates(clip, -1));
  ASSERT_TRUE(early.ok()) << early.error().message;
  EXPECT_EQ(early->report.begin_s, 0);
  EXPECT_LT(early->report.cop_rms_m.y(), 0.004);
}

TEST(Plates, PerformOnlyWhatTheyCarry) {
  const motion::Motion clip = Swaying();
  motion::GroundForces forces = Plates(clip);
  for (auto& plate : forces.plates) {
    plate.force_W.row(2).head(400) *= 0.5;  // On a chair for two seconds of four.
  }
  const auto made = OnPlates(clip, forces);
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_NEAR(made->report.supported_share, 0.5, 0.03);
  EXPECT_NEAR(made->report.begin_s, 2, 0.11);
  ASSERT_FALSE(made->report.warnings.empty());
  EXPECT_NE(made->report.warnings[0].find("chair"), std::string::npos);
  for (auto& plate : forces.plates) plate.force_W.row(2) *= 0.5;
  const auto never = OnPlates(clip, forces);
  ASSERT_FALSE(never.ok());
  EXPECT_EQ(never.error().kind, ErrorKind::kInvalidData);
}

TEST(Plates, WarnOfAnotherWeightAndOfTwoFeetOnOne) {
  const motion::Motion clip = Swaying();
  motion::GroundForces heavy = Plates(clip);
  for (auto& plate : heavy.plates) plate.force_W.row(2) *= 1.1;
  const auto made = OnPlates(clip, heavy);
  ASSERT_TRUE(made.ok()) << made.error().message;
  ASSERT_EQ(made->report.warnings.size(), 1u);
  EXPECT_NE(made->report.warnings[0].find("--mass-kg"), std::string::npos);

  motion::GroundForces one = Plates(clip);
  motion::PlateForces& right = one.plates[0];
  const motion::PlateForces left = one.plates[1];
  for (Eigen::Index i = 0; i < right.force_W.cols(); ++i) {
    const double share = left.force_W(2, i) / (left.force_W(2, i) + right.force_W(2, i));
    right.cop_W.col(i) += share * (left.cop_W.col(i) - right.cop_W.col(i));
  }
  right.force_W += left.force_W;
  one.plates.pop_back();
  const auto shared = OnPlates(clip, one);
  ASSERT_TRUE(shared.ok()) << shared.error().message;
  EXPECT_GT(shared->report.plates[0].beside_m, 0.08);
  ASSERT_EQ(shared->report.warnings.size(), 1u);
  EXPECT_NE(shared->report.warnings[0].find("both feet"), std::string::npos);
}

TEST(Plates, HaveTheComOfTheirOwnForceInALongTrial) {
  // Shear counts in the axes of the laboratory, so a person who looks elsewhere shows its turn.
  const motion::Motion clip = Moved(Swaying(800), 0.8, {3, -2, 0.1});
  const auto made = OnPlates(clip, Plates(clip));
  ASSERT_TRUE(made.ok()) << made.error().message;
  const std::size_t first = made->measured.judged_from;
  ASSERT_EQ(made->com_by_force_m.cols(),
            static_cast<Eigen::Index>(made->measured.frames.size() - first));
  double most_m = 0, moved_m = 0;
  for (Eigen::Index i = 0; i < made->com_by_force_m.cols(); ++i) {
    const Eigen::Vector3d com_m = made->measured.frames[first + static_cast<std::size_t>(i)].com_m;
    most_m = std::max(most_m, (made->com_by_force_m.col(i) - com_m).norm());
    moved_m = std::max(moved_m, std::abs(com_m.y() - made->measured.frames[first].com_m.y()));
  }
  EXPECT_GT(moved_m, 0.015);
  EXPECT_LT(most_m, 0.003);
  // Four seconds do not fix the constants of the integration.
  EXPECT_EQ(OnPlates(Swaying(), Plates(Swaying()))->com_by_force_m.cols(), 0);
}

TEST(Plates, RefuseForcesOfAnotherPlaceOrTimeAndALoop) {
  const motion::Motion clip = Swaying();
  motion::GroundForces forces = Plates(clip);
  forces.start_s = 100;
  const auto later = OnPlates(clip, forces);
  ASSERT_FALSE(later.ok());
  EXPECT_EQ(later.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(later.error().message.find("100.00 to 103.99 s"), std::string::npos)
      << later.error().message;

  forces.start_s = 0;
  for (auto& plate : forces.plates) plate.cop_W.row(1).array() += 2;
  const auto elsewhere = OnPlates(clip, forces);
  ASSERT_FALSE(elsewhere.ok());
  EXPECT_EQ(elsewhere.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(elsewhere.error().message.find("under_right"), std::string::npos);

  Settings loop;
  loop.loop_s = 60;
  const auto looped = RunOnPlates(clip, Plates(clip), loop, "clip.trc", "forces.mot");
  ASSERT_FALSE(looped.ok());
  EXPECT_EQ(looped.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace footing::pose_run
