#include "daemon/offline/eval/hand_course.h"

#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/devices/held_device.h"

namespace footing::eval {
namespace {

namespace sensors = virtual_sensors;

constexpr double kMoveRateHz = 175;  // 87.5 reports with two readings each.
constexpr double kCutoffHz = 10;     // Recorded poses are not fit to be differentiated twice.

}  // namespace

HandCourse::Between HandCourse::Find(double time_s) const {
  const double place = std::clamp(time_s * rate_hz, 0.0, static_cast<double>(count()) - 1.001);
  const auto before = static_cast<Eigen::Index>(place);
  return {before, place - static_cast<double>(before)};
}

Eigen::Vector3d HandCourse::At(const Eigen::Matrix3Xd& values, double time_s) const {
  const auto [before, share] = Find(time_s);
  return (1 - share) * values.col(before) + share * values.col(before + 1);
}

Eigen::Vector3d HandCourse::PointAt(const Eigen::Vector3d& p_SP_m, double time_s) const {
  const auto [before, share] = Find(time_s);
  const auto at = static_cast<std::size_t>(before);
  return At(p_W_m, time_s) + (1 - share) * (R_WS[at] * p_SP_m) + share * (R_WS[at + 1] * p_SP_m);
}

HandCourse FollowHand(const pose_run::ArmRun& run, int side, std::uint64_t seed) {
  motion::Motion motion{run.body.skeleton, run.rate_hz, 0, {}};
  motion.q.resize(run.frames.front().q.size(), static_cast<Eigen::Index>(run.frames.size()));
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    motion.q.col(static_cast<Eigen::Index>(i)) = run.frames[i].q;
  motion = motion::Resampled(motion::Smoothed(motion, kCutoffHz), kMoveRateHz);
  // Already smooth: this filter is there so as to leave it alone.
  const auto felt = sensors::FollowFist(run.body, motion, side, kMoveRateHz);

  sensors::HeldErrorConfig config;
  config.grip_tilt_rad = config.grip_heading_rad = 0;  // The track knows no attitude beforehand.
  config.seed = seed;
  sensors::HeldErrors errors(config);
  HandCourse course;
  course.rate_hz = kMoveRateHz;
  course.p_W_m.resize(3, motion.frames());
  course.v_W_mps.resize(3, motion.frames());
  const body::Point fist = body::Fist(run.body, side);
  const auto joint = static_cast<std::size_t>(fist.joint);
  body::Kinematics at(run.body.skeleton);
  body::ComputeKinematics(run.body.skeleton, body::TPose(run.body.skeleton, run.body.landmarks),
                          at);
  const Eigen::Matrix3d R_JS = at.R_WJ[joint].transpose();
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    body::ComputeKinematics(run.body.skeleton, motion.q.col(i), at);
    course.p_W_m.col(i) = body::Place(fist, at);
    course.R_WS.push_back(at.R_WJ[joint] * R_JS);
    const auto reading = errors.Advance(felt.specific_force_S_mps2.col(i),
                                        felt.angular_velocity_S_radps.col(i), 1 / kMoveRateHz);
    course.readings.push_back(
        {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped});
  }
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const Eigen::Index before = std::max<Eigen::Index>(0, i - 1);
    const Eigen::Index after = std::min(motion.frames() - 1, i + 1);
    course.v_W_mps.col(i) = (course.p_W_m.col(after) - course.p_W_m.col(before)) * kMoveRateHz /
                            static_cast<double>(after - before);
  }
  return course;
}

}  // namespace footing::eval
