#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "daemon/simulation/momentum/horizontal_com.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
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

  /// Solver of the last frame.
  pose::GaussNewton& solver() { return Solver(source_); }
  PriorOfPose prior() const;
  const Features& features() const { return features_; }

 private:
  /// About which pose a solution is.
  enum class Source { kMean, kPosture, kRegression };

  /// The learned sources need both hands, which their training had at all times.
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
  Source source_ = Source::kMean;  ///< Source of the last frame.
  bool placed_by_arms_ = false;    ///< In the last frame.
};

/// Values of the last frames, to go back to one of them. A value that allocates nothing.
template <typename T, std::size_t kSlots>
class Delay {
 public:
  void Clear() { count_ = 0; }
  void Add(const T& value) { values_[count_++ % kSlots] = value; }
  /// The value of `steps` (below kSlots) frames ago, or the first one where there are fewer. Not
  /// before the first Add.
  const T& Back(std::size_t steps) const {
    return values_[(count_ - std::min(count_, steps + 1)) % kSlots];
  }

 private:
  std::array<T, kSlots> values_{};
  std::size_t count_ = 0;
};

/// How high the joints of standing feet are: flat in the T-pose, where the heights are known, and
/// as in other poses once the hands have left their places in it. A plain value.
class StandingRise {
 public:
  void Start() { *this = StandingRise(); }

  /// One frame, the first one in the T-pose: `usual` with this frame's rises and deviations.
  /// `hands`: in W.
  FootSpread Advance(const std::array<HandInput, kHands>& hands, const FootSpread& usual);

 private:
  void FollowHands(const std::array<HandInput, kHands>& hands);

  bool first_ = true;
  bool known_ = false;  ///< Both hands were seen in the first frame.
  std::array<Eigen::Vector3d, kHands> t_pose_W_m_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double away_m_ = 0;  ///< Largest distance of the hands from there, in the mean of both.
};

/// Boards and hands by what goes beyond the paper (docs/pose.md): filters with covariances, a
/// regressed mean, Gauss-Newton. A value; `model` must outlive it.
class BestMode {
 public:
  BestMode(const SubjectModel& model, const Options& options);

  /// The T-pose is complete.
  void Start(const momentum::TPose& pose);
  /// One frame after it.
  void Advance(const Inputs& inputs, const Truth& truth, Output& output);
  const Features& features() const { return solver_.features(); }
  const LikelyPosture& posture() const { return estimate_.posture(); }

 private:
  template <typename T>
  using Lag = Delay<T, momentum::HorizontalCom::kSlots>;

  /// Measurement of the instant that is reconstructed, with what is known of it now.
  Measurement Delayed(const Measurement& now);
  /// Without what the joints are off by in common, and without those that are implausible.
  Inputs Plausible(const Inputs& inputs) const;
  /// Points that these joints show.
  const JointPoints& PointsOf(const JointInputs& joints) const;
  void SetTargets(const Measurement& then, const Truth& truth, const Output& output);
  void CleanUp(const Measurement& then, const Truth& truth);
  void Report(const Measurement& then, const Truth& truth, Output& output);

  ModeState state_;
  SkeletonOffset skeleton_;
  HeadSeat seat_;
  JointPoints lone_points_;  ///< Points of joints outside a skeleton.
  BestEstimate estimate_;
  Lag<Measurement> measured_;
  Lag<Truth> truth_;
  BestSolver solver_;
  StandingRise rise_;
  FootHold hold_;
  SolutionReport report_;
};

}  // namespace footing::reconstruction
