#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/options.h"
#include "daemon/simulation/reconstruction/output.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// The last step: what is reported of a solved pose.
namespace footing::reconstruction {

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

/// What the last solution was drawn to: a basis about `likely_q`. Borrowed.
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
