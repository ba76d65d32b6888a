#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/result/result.h"
#include "daemon/simulation/arms/arm_geometry.h"
#include "daemon/simulation/arms/arm_model.h"
#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/horizontal_network.h"
#include "daemon/simulation/momentum/paper_estimator.h"
#include "daemon/simulation/pose/fibonacci.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/leg_ik.h"
#include "daemon/simulation/reconstruction/features.h"
#include "daemon/simulation/reconstruction/feet.h"
#include "daemon/simulation/reconstruction/foot_lock.h"
#include "daemon/simulation/reconstruction/models.h"

/// From the cells under two feet and the places of two hands to the pose of the whole body (Ha, Bai
/// & Liu 2011, section 6, and what goes beyond it: docs/pose.md).
namespace footing::reconstruction {

enum class Mode { kBest, kPaper };

inline constexpr std::size_t kHands = 2;  ///< 0 is the left one.

/// Middle of the fist (body::Fist), W.
struct HandInput {
  bool valid = false;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
};

/// What is known from elsewhere and takes the place of the estimate: to see how much a better one
/// would help. Empty in use. Of the same instant as the loads.
struct Known {
  std::optional<Eigen::Vector3d> com_W_m;
  Eigen::Vector3d com_sd_m = Eigen::Vector3d::Constant(0.01);
  std::optional<Eigen::Vector3d> angular_W;  ///< kg m^2/s, of the body's own mass.
  struct Foot {
    Eigen::Vector3d ankle_W_m, toe_W_m;
    double ankle_sd_m = 0.015, toe_sd_m = 0.015;
  };
  std::optional<std::array<Foot, momentum::kFeet>> feet;
};

struct Inputs {
  momentum::ContactLoads loads;
  std::array<HandInput, kHands> hands;
  Known known = {};
  /// How the arms are held, where their hands are not seen.
  std::array<arms::ArmEstimate, kHands> arms = {};
};

/// Standard deviations and weights of the best mode's terms.
struct BestConstants {
  double hand_sd_m = 0.008;  ///< Of the fist on the hand, beside what the input says.
  double arm_spread = 1.5;   ///< Of an arm's told deviations: its errors are alike for many frames.
  FootSpread foot;
  double com_sd_m = 0.005;  ///< Of the masses, beside what the filters say.
  /// kg m^2/s, beside what the estimate says; 0: the angular momentum is left out, since as it is
  /// estimated it helps no pose (docs/pose.md).
  double angular_sd = 0;
  double prior_weight = 0.6;
  double smooth_weight = 1;             ///< At 60 Hz.
  double regressed_prior_weight = 0.6;  ///< The same about the regression's pose.
  double regressed_smooth_weight = 1;
  /// The told deviations are so many times those of the linearised terms, whose errors are alike
  /// for many frames.
  double spread = 1.5;
  double com_spread = 1.75;  ///< The same for the height of C.
  /// What the covariance of all frames leaves out of the knee and what is below it while the foot
  /// is in the air: so much, m along one axis, reached with this time.
  double aloft_sd_m = 0.14;
  double aloft_time_s = 0.2;
};

struct Options {
  Mode mode = Mode::kBest;
  double rate_hz = 120;  ///< Frames a second.
  double lag_s = 0;      ///< 0 to 0.2: poses are told so much later, and better.
  bool use_momentum = true;
  bool use_angular_momentum = true;
  /// Of the best mode: the momentum's filters are told where hands and feet alone have C.
  bool use_posture = true;
  bool clean_up = true;
  bool use_basis = true;
  BestConstants best;
};

/// One frame. All of it is finite at all times; `valid` says whether the pose means something.
struct Output {
  double time_s = 0;  ///< Of the inputs; the pose is of `lag_s` before.
  bool calibrated = false;
  double calibration_progress = 0;  ///< 0 to 1.
  std::uint32_t calibration_restarts = 0;
  bool valid = false;
  double lag_s = 0;
  std::uint32_t resets = 0;
  double mass_kg = 0;
  momentum::Estimate momentum;  ///< What loads, and the posture of hands and feet, tell.
  /// C: in best mode its height is that of the pose, which hands and feet have a part in; the rest
  /// is the loads'.
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_variance_m2 = Eigen::Vector3d::Zero();
  /// How badly what is measured and what is known of people fit together, in best mode: square of
  /// what is left of the terms, by their deviations, a row, in the mean of the last half second. 1
  /// where all told deviations are right. With more than 1.5 the pose's deviations grow, with more
  /// than 2 it is not valid: the person does what nothing here knows, such as walking on boards.
  double misfit = 0;
  Eigen::VectorXd q;  ///< Pose of body().skeleton; a T-pose until calibrated.
  std::vector<Eigen::Matrix3d> R_WJ;
  std::vector<Eigen::Vector3d> p_WJ_m;
  std::vector<double> joint_sd_m;  ///< Of each joint's position, along one axis.
};

/// A person on the cells: calibrates in a T-pose, then reconstructs. A value that can be copied; no
/// allocation in Advance. The body's layout must be that of the basis
/// (motion::WithLandmarksOnly, body::StandardPerson).
class Reconstruction {
 public:
  static Result<Reconstruction> Create(const body::Body& body, const Models& models,
                                       const Options& options);

  /// One frame, 1 / rate_hz after the one before.
  const Output& Advance(const Inputs& inputs);
  /// Forgets the T-pose.
  void Recalibrate();

  const body::Body& body() const { return parts_->body; }
  const Output& output() const { return output_; }
  /// Of the last frame, for training; only when calibrated.
  const Features& features() const { return features_; }

 private:
  /// What never changes; copies share it, and the solvers point into it.
  struct Parts {
    body::Body body;
    pose::PoseBasis basis;
    momentum::Subject subject;
    std::array<FootGeometry, momentum::kFeet> feet;
    std::array<std::vector<std::size_t>, momentum::kFeet> shanks;  ///< From the knees down.
    std::array<body::Point, kHands> fists;
    std::vector<arms::ArmGeometry> arms;  ///< kHands.
    Eigen::VectorXd t_pose;
    std::optional<std::array<cascade::CascadeNetwork, 2>> horizontal;
    PoseRegression regression;
    pose::PoseBasis rest;
  };
  /// What is measured at one time.
  struct Moment {
    std::array<HandInput, kHands> hands;
    std::array<arms::ArmEstimate, kHands> arms;
    momentum::Estimate momentum;
    Known known;
  };
  static constexpr std::size_t kMostLag = momentum::HorizontalCom::kSlots;

  Reconstruction(std::shared_ptr<const Parts> parts, const Options& options);
  void Begin(const momentum::TPose& pose);
  std::optional<Eigen::Vector2d> PredictHorizontal(const momentum::ContactLoads& loads);
  void Remember(const Inputs& inputs);
  void SeePosture(const std::array<HandInput, kHands>& hands);
  /// What was measured then, with what is known of it now.
  void TakeLagged();
  void AdvanceFeatures();
  void PlaceTargets();
  void AddHandTarget(std::size_t side, const HandInput& hand);
  void AddArmTargets(std::size_t side);
  /// Hands that only their arms tell of: where a first solution has them.
  void PlaceHandsByArms();
  void AddFeet();
  void HoldFeet();
  void TakeOrigin(pose::PoseTargets& targets) const;
  void AddMomentumTargets();
  void Solve();
  void SolveBest();
  bool Regressed() const;
  void CleanUp();
  /// A pose whose joints at_ has.
  void Tell(const Eigen::VectorXd& q);
  void TellSpreads();
  void TellCom();
  void TellFit();
  double Doubt() const;

  std::shared_ptr<const Parts> parts_;
  Options options_;
  double step_s_;
  int lag_steps_;
  momentum::TPoseCalibration calibration_;
  std::optional<momentum::BestEstimator> best_;
  std::optional<momentum::PaperEstimator> paper_;
  std::optional<momentum::HorizontalNetwork> horizontal_;  ///< Of paper mode, where there is one.
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();     ///< Of the basis' poses, in W.
  std::array<Moment, kMostLag> past_;
  std::size_t frames_ = 0;  ///< Since the T-pose.
  Moment then_;             ///< The instant that is reconstructed.
  std::array<Eigen::Vector3d, kHands> last_hands_m_;
  Features features_;
  pose::PoseTargets targets_;
  pose::PoseTargets standing_;  ///< Of the clean-up: where feet on the ground are shown.
  std::array<FootLock, momentum::kFeet> locks_;
  pose::GaussNewton gauss_newton_;
  pose::GaussNewton posture_;  ///< Of hands and feet alone.
  pose::FibonacciSearch fibonacci_;
  std::optional<pose::GaussNewton> regressed_;  ///< Over the errors of the regression.
  bool was_regressed_ = false;
  bool placed_by_arms_ = false;  ///< In the last frame.
  PoseRegression::Room room_;
  Eigen::VectorXd likely_q_;
  std::array<pose::LegIk, momentum::kFeet> legs_;
  Eigen::VectorXd q_;
  body::Kinematics at_;
  std::size_t next_spread_ = 0;
  std::vector<double> linear_sd_m_;  ///< Of each joint, by the linearised terms.
  double com_height_sd_m_ = 0;       ///< The same of C.
  std::uint32_t solver_resets_ = 0;
  Output output_;
};

}  // namespace footing::reconstruction
