#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/angle_spread.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// Times and distances of a shown foot's lock to the ground.
struct FootLockConfig {
  double ease_s = 0.1;     ///< From where the foot was shown to where it landed (section 4.4).
  double free_s = 0.15;    ///< The estimate is followed for this time after a landing,
  double band_m = 0.018;   ///< then it is followed when it is further away than this,
  double follow_s = 0.05;  ///< with this time constant.
};

/// Where on the ground a foot is shown. Standing feet do not slide, but their estimated place
/// wanders while it takes in the centre of pressure: what is shown is held while the estimate stays
/// near. Heights are those that are estimated.
/// A plain value.
class FootLock {
 public:
  static constexpr std::size_t kPoints = 2;
  using Places = std::array<Eigen::Vector3d, kPoints>;  ///< Ankle and ball, W, m.

  explicit FootLock(const FootLockConfig& config = {}) : config_(config) {}

  /// `estimated`: where the points are estimated to be; `shown`: where they were shown in the frame
  /// before. Returns where to show them; off the ground that is where they are estimated to be.
  Places Advance(bool contact, const Places& estimated, const Places& shown, double step_s);

 private:
  FootLockConfig config_;
  bool held_ = false;
  double since_s_ = 0;                                               ///< The landing.
  Eigen::Vector2d place_m_ = Eigen::Vector2d::Zero();                ///< Place of the ankle.
  Places from_m_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< Beside the place.
};

/// One frame. All of it is finite at all times; `valid` says whether the pose means something.
struct Output {
  double time_s = 0;  ///< Time of the inputs; the pose is of `lag_s` before.
  bool calibrated = false;
  double calibration_progress = 0;  ///< 0 to 1.
  std::uint32_t calibration_restarts = 0;
  bool valid = false;
  double lag_s = 0;
  std::uint32_t resets = 0;
  double mass_kg = 0;
  momentum::Estimate momentum;  ///< By the loads, and by the posture of hands and feet.
  /// COM: in best mode its height is that of the pose, which hands and feet have a part in; the
  /// rest is the loads'.
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_variance_m2 = Eigen::Vector3d::Zero();
  /// COM by hands and feet alone; in best mode, while both hands are there.
  std::optional<Eigen::Vector3d> posture_com_W_m;
  /// How badly what is measured and what is known of people fit together, in best mode: square of
  /// what is left of the terms, by their deviations, a row, in the mean of the last half second. 1
  /// where all deviations are right. With more than 1.5 the pose's deviations grow, with more than
  /// 2 it is not valid: the person does what nothing here knows, such as walking on boards.
  double misfit = 0;
  Eigen::VectorXd q;  ///< Pose of the body's skeleton; a T-pose until calibrated.
  std::vector<Eigen::Matrix3d> R_WJ;
  std::vector<Eigen::Vector3d> p_WJ_m;
  std::vector<double> joint_sd_m;  ///< Standard deviation of each joint's position, along one axis.
  /// Standard deviations of angles of pelvis, trunk and legs; best mode and insoles.
  AngleSd angle_sd_rad = UnknownAngles();
};

// The fifth step: the solver's pose has the feet where they are most likely; the legs, and these
// alone, bring them to where they are shown.

/// A pose and where it has the joints.
struct SolvedPose {
  Eigen::VectorXd q;
  body::Kinematics at;
};

/// Shows the feet where the solver's targets have them.
void ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
              pose::PoseTargets& shown);

/// Shows feet on the ground where they stand, so that they do not slide while their estimate
/// wanders. A value.
class FootHold {
 public:
  void Start() { locks_.fill(FootLock()); }
  /// One frame: `targets` in W, `before` the frame before.
  void ShowFeet(const SubjectModel& model, const pose::PoseTargets& targets,
                const momentum::Estimate& momentum, const Output& before, double step_s,
                pose::PoseTargets& shown);

 private:
  std::array<FootLock, momentum::kFeet> locks_;
};

/// Both legs.
class LegCleanUp {
 public:
  /// `model` must outlive it.
  explicit LegCleanUp(const SubjectModel& model) : legs_{LegOf(model, 0), LegOf(model, 1)} {}

  void Solve(const pose::PoseTargets& shown, std::size_t foot, SolvedPose& pose);
  void SolveBoth(const pose::PoseTargets& shown, SolvedPose& pose);

 private:
  std::array<pose::LegIk, momentum::kFeet> legs_;
};

/// The last step: what is reported of a solved pose.
inline constexpr double kUnknownSdM = 1.0;  ///< Before anything is measured.

/// `output` has as many joints.
void ReportPose(const Eigen::VectorXd& q, const body::Kinematics& at, Output& output);
/// Estimates of this frame, before a pose is solved for.
void ReportEstimate(const momentum::Estimate& momentum, std::uint32_t solver_resets,
                    Output& output);
/// The COM of the loads.
void ReportCom(const momentum::Estimate& then, Output& output);
/// After ReportCom: the height is that of the pose; `doubt` by Doubt().
void ReportPoseHeight(const SubjectModel& model, const body::Kinematics& at, double height_sd_m,
                      double doubt, Output& output);

/// From the origin of the basis' poses to W.
void MoveToWorld(const Eigen::Vector3d& origin_m, SolvedPose& pose);

/// Prior of the last solution: a basis about `likely_q`. Borrowed.
struct PriorOfPose {
  const pose::PoseBasis& basis;
  double weight;
  const Eigen::VectorXd& likely_q;
  const Eigen::VectorXd& q;  ///< The solution.
};

/// How badly the terms of one frame fit together: square of what is left of them, by their
/// deviations, a row. `at` is in W, the targets are from `origin_m`.
double MisfitOf(const SubjectModel& model, const pose::PoseTargets& targets,
                const Eigen::Vector3d& origin_m, const body::Kinematics& at,
                const PriorOfPose& prior);

/// Output::misfit: the mean of half a second. A value.
class MeanMisfit {
 public:
  void Start() { mean_ = 0; }
  /// Over the limit the output is not valid.
  void Report(double now, double step_s, Output& output);

 private:
  double mean_ = 0;
};

/// Factor on reported deviations: errors of a model that does not hold grow faster than what is
/// left of its terms. Of a pose from hands and feet alone, whose momentum is not `trusted`, at
/// least what those of bodies that crouch or fly need: they show little of either.
double Doubt(double misfit, bool trusted);

/// Deviations of all joints and of the COM's height by the linearised terms, a few a frame. A
/// value.
class PoseSpread {
 public:
  PoseSpread(const SubjectModel& model, const BestConstants& best);

  void Start();
  /// At the solver's last solution.
  void Advance(pose::GaussNewton& solver);
  void Report(double doubt, Output& output) const;
  double com_height_sd_m() const { return com_height_sd_m_; }

 private:
  std::vector<double> joint_factor_;
  double com_factor_;
  std::size_t next_ = 0;
  std::vector<double> joint_sd_m_;
  double com_height_sd_m_ = kUnknownSdM;
};

/// After PoseSpread::Report: what the covariance of all frames leaves out of a leg in the air.
void AddAloftSpread(const SubjectModel& model, const momentum::Estimate& then,
                    const BestConstants& best, Output& output);

}  // namespace footing::reconstruction
