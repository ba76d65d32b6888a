#include "common/virtual/motion/edit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/body/kinematics.h"
#include "common/base/quantile.h"
#include "common/base/angle.h"
#include "common/base/units.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/signal.h"

namespace footing::motion {
namespace {

constexpr double kCutoffOfNewRate = 0.4;

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// The rotations of a joint through the frames, a quaternion a column, signs continuous.
Eigen::MatrixXd QuaternionsOf(const body::Joint& joint, const Motion& motion) {
  Eigen::MatrixXd quaternions(4, motion.frames());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::Quaterniond turned(JointRotation(joint, motion.q.col(frame)));
    quaternions.col(frame) = turned.coeffs();
    if (frame > 0 && quaternions.col(frame).dot(quaternions.col(frame - 1)) < 0) {
      quaternions.col(frame) *= -1;
    }
  }
  return quaternions;
}

/// Low-passes a motion whose angles are continuous.
void LowPassPoses(double cutoff_hz, Motion& motion) {
  if (motion.frames() == 0) return;
  const Motion before = motion;
  motion.q = LowPass(before.q, motion.rate_hz, cutoff_hz);
  for (const body::Joint& joint : motion.skeleton.joints) {
    if (joint.rotations.size() != 3) continue;
    const Eigen::MatrixXd smooth = LowPass(QuaternionsOf(joint, before), motion.rate_hz, cutoff_hz);
    Eigen::VectorXd q = before.q.col(0);
    for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
      const Eigen::Quaterniond turned(Eigen::Vector4d(smooth.col(frame).normalized()));
      // Turns that cancel each other within the filter's time leave no rotation.
      if (smooth.col(frame).norm() > 0.01) SetJointRotation(joint, turned.toRotationMatrix(), q);
      motion.q.col(frame).segment<3>(joint.first_dof) = q.segment<3>(joint.first_dof);
    }
  }
}

}  // namespace

Eigen::VectorXd NearestPose(const body::Skeleton& skeleton, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& near_q) {
  Eigen::VectorXd nearest = near_q;
  nearest.head<3>() = q.head<3>();
  for (const body::Joint& joint : skeleton.joints) {
    if (joint.rotations.size() == 3) {
      SetJointRotation(joint, JointRotation(joint, q), nearest);
      continue;
    }
    for (std::size_t i = 0; i < joint.rotations.size(); ++i) {
      const int dof = joint.first_dof + static_cast<int>(i);
      nearest(dof) = NearestTurn(q(dof), near_q(dof));
    }
  }
  return nearest;
}

Motion Continuous(Motion motion) {
  for (Eigen::Index frame = 1; frame < motion.frames(); ++frame) {
    motion.q.col(frame) =
        NearestPose(motion.skeleton, motion.q.col(frame), motion.q.col(frame - 1));
  }
  return motion;
}

Motion Canonical(Motion motion) {
  if (motion.frames() > 0) {
    motion.q.col(0) =
        NearestPose(motion.skeleton, motion.q.col(0), Eigen::VectorXd::Zero(motion.skeleton.dof));
  }
  return Continuous(std::move(motion));
}

Motion Smoothed(const Motion& motion, double cutoff_hz) {
  Motion smooth = Continuous(motion);
  LowPassPoses(cutoff_hz, smooth);
  return smooth;
}

Motion Resampled(const Motion& motion, double rate_hz) {
  FOOTING_CHECK(IsRate(rate_hz));
  Motion out = Continuous(motion);
  if (rate_hz == motion.rate_hz) return out;
  if (rate_hz < motion.rate_hz) LowPassPoses(kCutoffOfNewRate * rate_hz, out);
  const Spline spline(std::move(out.q), motion.rate_hz);
  const double span_s = static_cast<double>(motion.frames() - 1) / motion.rate_hz;
  const auto frames = static_cast<Eigen::Index>(std::floor(span_s * rate_hz + 1e-9)) + 1;
  out.rate_hz = rate_hz;
  out.q.resize(motion.skeleton.dof, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    out.q.col(i) = spline.Value(static_cast<double>(i) / rate_hz);
  }
  return out;
}

MotionRates Rates(const Motion& motion) {
  const Spline spline(Continuous(motion).q, motion.rate_hz);
  MotionRates rates{Eigen::MatrixXd(motion.q.rows(), motion.frames()),
                    Eigen::MatrixXd(motion.q.rows(), motion.frames())};
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double t_s = static_cast<double>(i) / motion.rate_hz;
    rates.q_dot.col(i) = spline.FirstDerivative(t_s);
    rates.q_ddot.col(i) = spline.SecondDerivative(t_s);
  }
  return rates;
}

Motion Looped(const Motion& motion, double seconds, double ease_s) {
  FOOTING_CHECK(seconds >= 0 && ease_s >= 0);
  Motion out = Continuous(motion);
  const double span_s = static_cast<double>(motion.frames() - 1) / motion.rate_hz;
  const auto frames = static_cast<Eigen::Index>(std::floor(seconds * motion.rate_hz + 1e-9)) + 1;
  const Spline spline(std::move(out.q), motion.rate_hz);
  out.q.resize(motion.skeleton.dof, frames);
  // One way: speed 1 in the middle, linear to 0 over `ease` of clip at its ends. A stretch e of
  // clip at mean speed 1/2 takes 2 e.
  const double ease = std::min(ease_s, span_s / 2);
  const double way_s = span_s + 2 * ease;
  for (Eigen::Index i = 0; i < frames; ++i) {
    double at = 0;
    if (way_s > 0) {
      at = std::fmod(static_cast<double>(i) / motion.rate_hz, 2 * way_s);
      if (at > way_s) at = 2 * way_s - at;
      const bool late = at > way_s / 2;
      const double from_end = late ? way_s - at : at;
      const double along =
          ease > 0 && from_end < 2 * ease ? from_end * from_end / (4 * ease) : from_end - ease;
      at = late ? span_s - along : along;
    }
    out.q.col(i) = spline.Value(at);
  }
  return out;
}

Motion FacingForward(const Motion& motion, const body::Landmarks& landmarks) {
  body::Kinematics at(motion.skeleton);
  std::vector<double> x, y, turn_x, turn_y;
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    const Eigen::Vector3d left = at.p_WJ[Index(landmarks[body::Landmark::kLeftHip])];
    const Eigen::Vector3d right = at.p_WJ[Index(landmarks[body::Landmark::kRightHip])];
    const Eigen::Vector3d ahead = (left - right).cross(Eigen::Vector3d::UnitZ()).normalized();
    x.push_back((left.x() + right.x()) / 2);
    y.push_back((left.y() + right.y()) / 2);
    turn_x.push_back(ahead.x());
    turn_y.push_back(ahead.y());
  }
  const double heading_rad = std::atan2(text::Median(turn_y), text::Median(turn_x));
  const Eigen::Vector3d middle(text::Median(x), text::Median(y), 0);
  const Eigen::Matrix3d back = body::AxisRotation(body::Axis::kZ, -heading_rad);
  Motion out = motion;
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd before = motion.q.col(frame);
    Eigen::VectorXd q = before;
    if (frame > 0) {  // Near the frame before.
      const Eigen::VectorXd last = out.q.col(frame - 1);
      q.segment(root.first_dof, static_cast<int>(root.rotations.size())) =
          last.segment(root.first_dof, static_cast<int>(root.rotations.size()));
    }
    q.head<3>() = back * (before.head<3>() - middle);
    SetJointRotation(root, back * JointRotation(root, before), q);
    out.q.col(frame) = q;
  }
  return out;
}

}  // namespace footing::motion
