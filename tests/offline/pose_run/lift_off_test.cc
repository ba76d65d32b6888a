#include "daemon/offline/pose_run/lift_off.h"

#include <gtest/gtest.h>

namespace footing::pose_run {
namespace {

constexpr double kStepS = 0.05;
constexpr double kCarriesN = 300;

LegError Off(double hip_m, double knee_m, double foot_m, double sd_m) {
  LegError leg;
  leg.error_m = {Eigen::Vector3d(hip_m, 0, 0), Eigen::Vector3d(0, knee_m, 0),
                 Eigen::Vector3d(0, 0, foot_m)};
  leg.sd_m = {sd_m, sd_m, sd_m};
  return leg;
}

void Stand(LiftOffs& lifts, double seconds, std::size_t foot = 0) {
  for (double t_s = 0; t_s < seconds - 1e-9; t_s += kStepS)
    lifts.Add(foot, kCarriesN, Eigen::Vector3d::Zero(), Off(1, 1, 1, 0.1));
}

/// In the air for so many frames; the foot's error is a centimetre for each frame since it left.
void Lift(LiftOffs& lifts, int frames, std::size_t foot = 0) {
  for (int i = 0; i < frames; ++i)
    lifts.Add(foot, 0, Eigen::Vector3d::Zero(), Off(0, 0, 0.01 * i, 0.1));
}

TEST(LegScore, TellsRootMeanSquaresAndHowTheyFitWhatWasTold) {
  LegScore score;
  score.Add(Off(0.03, 0, 0, 0.1));
  score.Add(Off(0.04, 0, 0.3, 0.2));
  EXPECT_EQ(score.count(), 2u);
  EXPECT_NEAR(score.error_cm(0), std::sqrt((9 + 16) / 2.0), 1e-9);
  EXPECT_NEAR(score.sd_cm(0), std::sqrt((100 + 400) / 2.0), 1e-9);
  // |0.3|^2 / (3 0.2^2) = 0.75 in one of two.
  EXPECT_NEAR(score.nees(2), 0.375, 1e-9);
  EXPECT_NEAR(score.nees(), (score.nees(0) + score.nees(1) + score.nees(2)) / 3, 1e-12);
}

TEST(LegScore, IsOneWhereErrorsAreAsTold) {
  LegScore score;
  const double error_m = 0.1 * std::sqrt(3.0);  // 10 cm along each axis.
  score.Add(Off(error_m, error_m, error_m, 0.1));
  EXPECT_NEAR(score.nees(), 1, 1e-9);
}

TEST(LegScore, OfNothingIsZero) {
  EXPECT_EQ(LegScore().error_cm(0), 0);
  EXPECT_EQ(LegScore().nees(), 0);
}

TEST(LiftOffs, LookAtTheFootAtItsTimesWhileItIsOff) {
  LiftOffs lifts(kStepS);
  Stand(lifts, 0.5);
  Lift(lifts, 13);  // 0.6 s from the first frame off to the last.
  Stand(lifts, 0.5);
  EXPECT_EQ(lifts.count(), 1u);
  EXPECT_EQ(lifts.after(0).count(), 1u);
  EXPECT_NEAR(lifts.after(0).error_cm(2), 5, 1e-9);  // 0.25 s are five frames.
  EXPECT_EQ(lifts.after(1).count(), 1u);
  EXPECT_NEAR(lifts.after(1).error_cm(2), 10, 1e-9);
  EXPECT_EQ(lifts.after(2).count(), 0u);
  EXPECT_EQ(lifts.aloft().count(), 13u);
}

TEST(LiftOffs, CountEachFootAndEachTime) {
  LiftOffs lifts(kStepS);
  for (const std::size_t foot : {0, 1, 0}) {
    Stand(lifts, 0.3, foot);
    Lift(lifts, 6, foot);
  }
  EXPECT_EQ(lifts.count(), 3u);
  EXPECT_EQ(lifts.after(0).count(), 3u);
}

TEST(LiftOffs, TakeNoTouchForStanding) {
  LiftOffs lifts(kStepS);
  Lift(lifts, 10);  // Has not stood: nobody knows when it left.
  EXPECT_EQ(lifts.count(), 0u);
  EXPECT_EQ(lifts.aloft().count(), 0u);
  Stand(lifts, kStepS);  // One frame: less than 0.1 s.
  Lift(lifts, 10);
  EXPECT_EQ(lifts.count(), 0u);
  Stand(lifts, 2 * kStepS);
  Lift(lifts, 1);
  EXPECT_EQ(lifts.count(), 1u);
}

TEST(LiftOffs, SeeAKickInAFootThatIsFastAndOff) {
  LiftOffs lifts(kStepS);
  double x_m = 0;
  const auto move = [&](double load_n, double mps, int frames) {
    for (int i = 0; i < frames; ++i) {
      x_m += mps * kStepS;
      lifts.Add(1, load_n, {x_m, 0, 0}, Off(0, 0, 0.2, 0.1));
    }
  };
  move(kCarriesN, 0, 10);
  move(kCarriesN, 3, 4);  // Slides.
  EXPECT_EQ(lifts.kicks(), 0u);
  move(0, 1, 4);
  move(0, 3, 4);
  move(0, 1.9, 4);
  move(0, 2.1, 2);
  EXPECT_EQ(lifts.kicks(), 2u);
  EXPECT_EQ(lifts.kick().count(), 6u);
  EXPECT_EQ(lifts.aloft().count(), 14u);
}

}  // namespace
}  // namespace footing::pose_run
