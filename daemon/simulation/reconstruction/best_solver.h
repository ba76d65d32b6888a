#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/clean_up.h"
#include "daemon/simulation/reconstruction/features.h"
#include "daemon/simulation/reconstruction/measurement.h"
#include "daemon/simulation/reconstruction/options.h"
#include "daemon/simulation/reconstruction/posture.h"
#include "daemon/simulation/reconstruction/report.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// The fourth step of best mode: Gauss-Newton about the pose that the regression of the features
/// makes likely. While the momentum is not trusted, or left out, about the pose that hands and feet
/// alone make likely. While a hand is neither seen nor known by its arm, where nothing is learned
/// of either, and while a skeleton's joints show the pose, about the mean of all poses: what is
/// learned knows no joints, and poses of other people are nearer to it than to what they show.
class BestSolver {
 public:
  /// `model` must outlive it.
  BestSolver(const SubjectModel& model, const Options& options);

  void Start(double mass_kg);
  /// One frame. `targets` are from `origin_m`, and so is the pose.
  void Solve(const Measurement& then, const pose::PoseTargets& targets,
             const Eigen::Vector3d& origin_m, SolvedPose& pose);
  /// The next frame starts at the mean.
  void Reset();

  /// Of the last frame.
  pose::GaussNewton& solver() { return Solver(source_); }
  PriorOfPose prior() const;
  const Features& features() const { return features_; }

 private:
  /// About which pose a solution is.
  enum class Source { kMean, kPosture, kRegression };

  /// What is learned has seen both hands at all times.
  Source Choose(const Measurement& then) const;
  pose::GaussNewton& Solver(Source source);
  /// Where hands that only their arms show are: where a solution without the regression has them.
  void PlaceHandsByArms(const Measurement& then, const pose::PoseTargets& targets,
                        const Eigen::Vector3d& origin_m);
  void SolveAboutRegression(const Measurement& then, const pose::PoseTargets& targets,
                            const Eigen::Vector3d& origin_m);

  const SubjectModel* model_;
  Options options_;
  pose::GaussNewton plain_;
  std::optional<pose::GaussNewton> regressed_;  ///< Over the errors of the regression.
  std::optional<pose::GaussNewton> posed_;      ///< The same of hands and feet alone.
  Features features_;
  LikelyPosture posture_;
  std::array<Eigen::Vector3d, kHands> hands_W_m_;  ///< Where they were last.
  PoseRegression::Workspace workspace_;
  Eigen::VectorXd likely_q_;
  bool first_ = true;              ///< No frame since Start.
  Source source_ = Source::kMean;  ///< Of the last frame.
  bool placed_by_arms_ = false;    ///< In the last frame.
};

}  // namespace footing::reconstruction
