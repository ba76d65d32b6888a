#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::eval {

/// Which joints a pose is evaluated by: hips, knees, ankles, balls of the feet; root, chest, neck,
/// base and top of the head; shoulders, elbows, end of the forearm's upper two thirds where there
/// is one (CMU), wrists. Those that the skeleton has, at most 21.
struct JudgedJoints {
  std::vector<int> legs, torso, arms;
  explicit JudgedJoints(const body::Body& body);
};

/// Numbers whose distribution is asked for.
class Spread {
 public:
  void Add(double value) { values_.push_back(value); }
  double mean() const;
  double rms() const;
  /// 0.5: the median. 0 where there is nothing.
  double Quantile(double share) const;
  std::size_t size() const { return values_.size(); }
  /// There is one.
  double last() const { return values_.back(); }

 private:
  std::vector<double> values_;
};

/// Errors of the legs' angles, degrees: of the hip as a whole, of the direction of the thigh in the
/// pelvis and of its turn about itself, and of the knee; then of the hip's three angles
/// (HipAngles).
struct LegAngles {
  double hip = 0, swing = 0, twist = 0, knee = 0;
  double flexion = 0, abduction = 0, rotation = 0;
};

/// Poses against the truth, frame by frame.
class PoseScore {
 public:
  /// `body` must outlive it.
  explicit PoseScore(const body::Body& body);

  void Add(const Eigen::VectorXd& q, const Eigen::VectorXd& true_q);
  /// The last frame's errors by joint, of all joints, m.
  const std::vector<Eigen::Vector3d>& errors_m() const { return errors_m_; }
  const body::Kinematics& at() const { return at_; }
  const body::Kinematics& truth() const { return truth_; }

  double mpjpe_cm() const { return frames_.mean(); }
  double last_mpjpe_cm() const { return frames_.last(); }
  LegAngles leg_angles_deg() const {
    return {angles_[0].mean(), hips_[0].mean(), hips_[1].mean(), angles_[1].mean(),
            hips_[5].mean(),   hips_[6].mean(), hips_[7].mean()};
  }
  /// Samples behind hip_about_mean_deg: left and right, one vector a frame.
  const std::array<std::vector<Eigen::Vector3d>, 2>& hip_turns_rad() const {
    return hip_turns_rad_;
  }
  nlohmann::ordered_json Json() const;

 private:
  double Mean(const std::vector<int>& joints, const Eigen::Vector3d& shift) const;
  void AddAngles();
  void AddHips();

  const body::Body& body_;
  JudgedJoints joints_;
  body::Kinematics at_, truth_;
  std::vector<Eigen::Vector3d> errors_m_;
  Spread frames_, relative_, legs_, torso_, arms_;  ///< cm.
  std::array<Spread, 5> angles_;                    ///< Degrees: hip, knee, shoulder, elbow, chest.
  /// Degrees. Of the thigh in the pelvis: its direction; its turn about itself, of all frames and
  /// of those with a bent knee. Then the pelvis and the thigh's direction in W, and HipAngles.
  std::array<Spread, 8> hips_;
  body::Kinematics t_pose_;  ///< Where HipAngles are 0.
  /// From the true hip to the estimated one, rad along the axis in the thigh; left and right. Their
  /// mean is what a person's markers or way of standing turn in all frames alike.
  std::array<std::vector<Eigen::Vector3d>, 2> hip_turns_rad_;
};

/// A hip as gait analysis reports it, degrees; 0 in the T-pose, in which the thighs hang straight
/// down. Flexion is positive forwards, abduction outwards, rotation inwards.
struct HipAngles {
  double flexion = 0;    ///< Angle of the thigh in the sagittal plane of the pelvis.
  double abduction = 0;  ///< Angle of the thigh out of that plane.
  /// Turn of the thigh about itself, beyond the least turn that brings it down to where it points.
  /// The cardan angles of Grood & Suntay (1983) differ from this when the hip is both bent and
  /// spread, and have no rotation where the thigh points sideways.
  double rotation = 0;
};

/// `R_PT`: how the thigh has turned in the pelvis since the T-pose, in axes of the pelvis that are
/// W's in the T-pose (x forward, y left, z up). Side 0 is left.
HipAngles HipAnglesDeg(const Eigen::Matrix3d& R_PT, int side);

/// Magnitudes of the differences, each 180 degrees at most.
HipAngles Difference(const HipAngles& a, const HipAngles& b);

}  // namespace footing::eval
