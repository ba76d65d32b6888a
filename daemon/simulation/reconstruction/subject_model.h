#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton_points.h"
#include "common/stream/hands.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/paper_estimator.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/hand_attitude.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::reconstruction {

/// A foot flat on the ground: where ankle and ball are from F, the point where the centre of
/// pressure rests (momentum::FootShape). Foot frame: x to the toes, y left, z up.
struct FootGeometry {
  momentum::FootShape shape;
  body::Point ankle;
  body::Point toe;
  body::Point heel;  ///< Under and behind the ankle, on the ground.
  Eigen::Vector3d ankle_F_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_F_m = Eigen::Vector3d::Zero();
  /// From W: turned by shape.yaw_rad.
  Eigen::Matrix3d R_WF = Eigen::Matrix3d::Identity();

  /// How far F is ahead of the heel.
  double RestM() const { return shape.rest_share * shape.length_m; }
};

/// Geometry of both feet, from the body in its T-pose. Feet that point further ahead than people
/// stand are turned out to 7 degrees, half of the angle between the feet that people prefer
/// (McIlroy and Maki 1997, Clinical Biomechanics 12, 66).
std::array<FootGeometry, momentum::kFeet> StandingFeet(const body::Body& body);

/// Subject of the momentum filters: the person on the cells, by the body in its T-pose.
momentum::Subject SubjectOf(const body::Body& body);

/// Where a foot's joints are from its estimate, by how far recorded feet were off it
/// (docs/pose.md); m, and one standard deviation.
struct FootSpread {
  double along = 0.03;  ///< In contact, beside the variance of F itself.
  double across = 0.02;
  double ankle_up = 0.024;
  double toe_up = 0.02;
  double ankle_rise = 0.01, toe_rise = 0.008;  ///< Feet are not always flat;
  double flat_up = 0.005;     ///< In the T-pose they are: its deviation of both heights,
  double leave_m = 0.3;       ///< and the hands' way out of it with which they rise (StandingRise).
  double lift = 0.22;         ///< In the air, how high the foot is,
  double forward = 0.05;      ///< and how far ahead of where it stood,
  double lift_time_s = 0.12;  ///< with this time constant;
  double air_level = 0.20;    ///< and how far off that it is.
  double air_up = 0.17;
};

/// Adds targets of ankle and ball.
void AddFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                    const FootSpread& spread, pose::PoseTargets& targets);

/// The same as the paper has it: stiff constraints at the foot's estimate.
void AddPaperFootTargets(const FootGeometry& geometry, const momentum::FootEstimate& foot,
                         double sd_m, pose::PoseTargets& targets);

inline constexpr std::size_t kHands = 2;  ///< 0 is the left one.

/// A point of the body as a tracker sees it.
struct PointInput {
  bool valid = false;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_m = Eigen::Vector3d::Constant(0.01);
  /// Covariances of x and y, x and z, y and z; with sd_m the whole matrix.
  Eigen::Vector3d covariance_m2 = Eigen::Vector3d::Zero();
  bool of_skeleton = false;  ///< A hand that the tracker of the joints alone sees.
};
using HandInput = PointInput;   ///< Middle of the fist (body::Fist).
using JointInput = PointInput;  ///< A joint of a skeleton (body::SkeletonPoints).
using JointInputs = std::array<JointInput, stream::kBodyJoints>;  ///< By body::IndexOf.

/// Segments that may wear an inertial sensor, beside arms. Hands come last: theirs is what they
/// hold, and it counts where a tracker sees the hand, too.
enum class BodySite {
  kPelvis,  ///< On a belt.
  kChest,
  kHead,
  kLeftThigh,
  kRightThigh,
  kLeftShank,
  kRightShank,
  kLeftHand,
  kRightHand,
};
inline constexpr std::size_t kBodySites = 9;
inline constexpr std::array<const char*, kBodySites> kBodySiteNames = {
    "pelvis",     "chest",       "head",      "left_thigh", "right_thigh",
    "left_shank", "right_shank", "left_hand", "right_hand"};
inline constexpr bool IsHand(BodySite site) { return site >= BodySite::kLeftHand; }
/// The joint whose frame a segment turns with.
body::Landmark JointOf(BodySite site);
/// How a segment turns in a squat.
arms::SquatTurn SquatTurnOf(BodySite site);
/// How each segment has turned since the T-pose; by BodySite.
using BodyTurns = std::array<arms::HandState, kBodySites>;

/// Measurements of the sensors in one frame.
struct Inputs {
  momentum::ContactLoads loads;
  std::array<HandInput, kHands> hands;
  /// How the arms are held, where their hands are not seen.
  std::array<arms::ArmEstimate, kHands> arms = {};
  JointInputs joints = {};
  BodyTurns turns = {};
};

/// For evaluation: parts of the truth at the instant of the loads, in place of their estimates, to
/// see how much a better estimate would help. Empty in the daemon.
struct Truth {
  /// Joints of one foot, W.
  struct Foot {
    Eigen::Vector3d ankle_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d toe_W_m = Eigen::Vector3d::Zero();
  };
  std::optional<Eigen::Vector3d> com_W_m;
  std::optional<Eigen::Vector3d> angular_W;  ///< kg m^2/s, of the body's own mass.
  std::optional<std::array<Foot, momentum::kFeet>> feet;
};

/// Where the model of a walk expects the joints of one foot, with one standard deviation.
struct FootPrior {
  Eigen::Vector3d ankle_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_W_m = Eigen::Vector3d::Zero();
  double ankle_sd_m = 0, toe_sd_m = 0;
};

/// Prior of a frame by the model of a walk (InsoleWalk).
struct WalkPrior {
  struct Com {
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();
  };
  std::array<FootPrior, momentum::kFeet> feet;
  std::optional<Com> com;  ///< Where the hands show the place of the body.
};

/// The product's own mode, and the pose paper's.
enum class Mode { kBest, kPaper };

/// Standard deviations and weights of the best mode's terms.
struct BestConstants {
  double hand_sd_m = 0.008;  ///< Fist on the hand, beside what the input says.
  double arm_spread = 1.5;   ///< Factor on an arm's deviations: its errors persist for many frames.
  /// Standard deviation of a worn sensor on its bone, about each axis, beside what the attitude
  /// says: soft tissue and the way the segment was held in the T-pose, which last for many frames.
  double segment_sd_rad = 0.1;
  double hand_turn_sd_rad = 0.2;  ///< The same of a hand, whose wrist bends as it takes hold.
  /// Standard deviation of the pelvis's tilt between trunk and thighs that stay, beside what is
  /// learned: which tilt a skeleton has in a squat differs between laboratories (docs/pose.md).
  double pelvis_sd_rad = 0.2;
  FootSpread foot;
  double com_sd_m = 0.005;  ///< Error of the masses, beside what the filters say.
  /// kg m^2/s, beside what the estimate says; 0: the angular momentum is left out, since as it is
  /// estimated it helps no pose (docs/pose.md).
  double angular_sd = 0;
  double prior_weight = 0.6;
  double smooth_weight = 1;             ///< At 60 Hz.
  double regressed_prior_weight = 0.6;  ///< The same about the regression's pose.
  double regressed_smooth_weight = 1;
  /// Factor on the deviations of the linearised terms, whose errors persist for many frames.
  double spread = 1.3;
  double arm_joint_spread = 1.05;  ///< The same from the shoulders down: hands are measured.
  double com_spread = 1.75;        ///< The same for the height of the COM.
  /// Weight of what is known of people in the deviations of angles: upright, and with knees bent by
  /// kDeepBendRad or more, between them by the bend. Skeletons of laboratories and people's ways of
  /// crouching differ most in deep bends, more than those who trained a model.
  double angle_weight = 1.36;
  double bent_angle_weight = 0.3;
  /// Standard deviation that the covariance of all frames leaves out of the knee and the joints
  /// below it while the foot is in the air: m along one axis, reached with this time constant.
  double aloft_sd_m = 0.14;
  double aloft_time_s = 0.2;
};

/// Constants of paper mode that the paper does not give; how each was chosen: docs/pose.md. The
/// terms of equation (6) have different units: each is divided by its standard deviation.
struct PaperConstants {
  momentum::PaperConfig momentum;
  double variance_share = 0.99;   ///< Share of the recorded poses that the components hold.
  pose::FibonacciOptions search;  ///< Its frame_s is set by the rate.
  double hand_sd_m = 0.016;
  double arm_sd_rad = 0.2;
  double foot_sd_m = 0.02;
  double com_sd_m = 0.02;
  double height_sd_m = 0.05;
  double angular_sd = 100;  ///< kg m^2/s.
  /// For evaluation: the same of true values. Searches find no pose to match a change of momentum
  /// exactly: held closer, the pose stays behind.
  double true_com_sd_m = 0.01;
  double true_angular_sd = 10;
};

/// Options of a reconstruction.
struct Options {
  Mode mode = Mode::kBest;
  double rate_hz = 120;  ///< Frames a second.
  double lag_s = 0;      ///< 0 to 0.2: poses are reported with this delay, and are better.
  bool use_momentum = true;
  bool use_angular_momentum = true;
  /// For the best mode: the momentum's filters take where hands and feet alone place the COM.
  bool use_posture = true;
  bool clean_up = true;
  bool use_basis = true;
  BestConstants best;
  PaperConstants paper;

  double step_s() const { return 1 / rate_hz; }
  int lag_steps() const;
};

std::string NameOf(Mode mode);
/// Leaves exactly these parts out: angular_momentum, momentum, posture, basis, cleanup. A
/// UsageError lists them.
Result<void> LeaveOut(const std::vector<std::string>& parts, Options& options);
std::vector<std::string> LeftOut(const Options& options);
/// Both: the mode "best" or "paper", of which a UsageError lists both, and the parts to leave out.
Result<void> SetMode(const std::string& name, const std::vector<std::string>& left_out,
                     Options& options);

/// UsageError that names an option out of range.
Result<void> CheckOptions(const Options& options);

/// Options for the solver over the basis of all poses, and over the errors of the regression.
pose::GaussNewtonOptions BasisSolverOptions(const Options& options);
pose::GaussNewtonOptions RegressedSolverOptions(const Options& options);
/// Options for the solver of hands and feet alone.
pose::GaussNewtonOptions PostureSolverOptions(const Options& options);

using JointPoints = std::array<body::Point, stream::kBodyJoints>;  ///< By body::IndexOf.

/// Constants while one person is reconstructed; the steps of a mode point into it.
struct SubjectModel {
  body::Body body;
  Eigen::VectorXd t_pose;
  body::Kinematics t_pose_at{body::Skeleton{}};  ///< Where it has the joints.
  momentum::Subject subject;
  std::array<FootGeometry, momentum::kFeet> feet;
  std::array<std::vector<std::size_t>, momentum::kFeet> shanks;  ///< Joints from the knees down.
  std::array<std::vector<std::size_t>, kHands> arm_joints;       ///< From the shoulders down.
  std::array<body::Point, kHands> fists;
  JointPoints joints;                   ///< Those of a tracked skeleton.
  std::vector<arms::ArmGeometry> arms;  ///< kHands.
  pose::PoseBasis basis;
  PoseRegression regression;  ///< Empty where the mode does without.
  pose::PoseBasis rest;       ///< Errors of the regression.
  LikelyPoses posture;        ///< Hands and feet alone; empty likewise.
  std::optional<std::array<cascade::CascadeNetwork, 2>> horizontal;

  double root_height_m() const { return t_pose(2); }
};

/// The body with the learned poses at its size: as many components as each mode takes. Errors where
/// the poses have another layout than the body.
Result<SubjectModel> BestSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options);
Result<SubjectModel> PaperSubjectModel(const body::Body& body, const Models& models,
                                       const Options& options);
/// Best mode's, without the regression, whose people stay in place.
Result<SubjectModel> WalkSubjectModel(const body::Body& body, const Models& models,
                                      const Options& options);

/// Inverse kinematics of one leg.
pose::LegIk LegOf(const SubjectModel& model, std::size_t foot);

/// Where in W the basis has the origin of its poses: below the middle of the feet of the T-pose.
Eigen::Vector3d BasisOrigin(const SubjectModel& model, const momentum::TPose& pose);

/// The pose that hands and feet alone make likely, frame by frame: nothing of the loads but where
/// the feet are and that they stand. A value; `model` must outlive it.
class LikelyPosture {
 public:
  LikelyPosture(const SubjectModel& model, double step_s);

  void Start();
  /// The next frame: fists in W, left and right.
  void Advance(const std::array<Eigen::Vector3d, kHands>& hands_W_m,
               const std::array<momentum::FootEstimate, momentum::kFeet>& feet);
  /// Posture of the last frame, from `origin_m`; only where the model knows postures.
  const Eigen::VectorXd& Predict(const Eigen::Vector3d& origin_m);
  const Features& features() const { return features_; }
  /// From where the features' places are.
  const Eigen::Vector3d& middle_W_m() const { return middle_W_m_; }

 private:
  const SubjectModel* model_;
  double step_s_;
  Features features_;
  Eigen::Vector3d middle_W_m_ = Eigen::Vector3d::Zero();
  PoseRegression::Workspace workspace_;
  Eigen::VectorXd likely_q_;
};

/// Where a hand, or another point of the body, is by now, which a tracker measures with a delay: a
/// Kalman filter of place and velocity along each of W's axes; the velocity is white noise through
/// a first-order lag. Measurements count as if their errors were white; they need not be, so no
/// place is reported with a smaller deviation than the tracker's. A value.
class HandTrack {
 public:
  static constexpr double kFurthestS = 0.3;  ///< Nothing is known of a hand later than that.

  HandTrack() = default;
  /// Track of a point that is slower than hands are, by such a part of their speed.
  explicit HandTrack(double speed_share) : speed_share_(speed_share) {}

  /// The hand's place at `time_s`, which is later than the one before; after a pause or a step back
  /// of kFurthestS it starts again. Finite; deviations above 0.
  void Add(double time_s, const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& sd_m,
           const Eigen::Vector3d& covariance_m2 = Eigen::Vector3d::Zero());
  /// At `time_s`, if not before the last place then at that. Invalid before the first.
  HandInput At(double time_s) const;

 private:
  void Predict(double step_s);

  double speed_share_ = 1;
  bool started_ = false;
  double time_s_ = 0;
  Eigen::Array3d p_m_ = Eigen::Array3d::Zero(), v_mps_ = Eigen::Array3d::Zero();
  Eigen::Array3d pp_ = Eigen::Array3d::Zero(), pv_ = Eigen::Array3d::Zero(),
                 vv_ = Eigen::Array3d::Zero();  ///< Their covariance.
  Eigen::Array3d measured_variance_ = Eigen::Array3d::Ones();
  Eigen::Vector3d covariance_m2_ = Eigen::Vector3d::Zero();  ///< Between axes, of the last place.
};

/// Tracks of the joints of a skeleton, by body::IndexOf, which are slower than hands.
std::array<HandTrack, stream::kBodyJoints> JointTracks();

// Joints of a tracked skeleton, such as a Kinect's (pose paper, sections 5.3 and 7.3): what of
// them is believed, and the terms of the solver that they are.

/// Enough joints are valid to show the pose. Fewer, such as a tracked head, add to what boards and
/// hands show.
bool IsSkeleton(const JointInputs& joints);

/// A term for each valid joint, which shows its one of `points`, with its covariance. A joint that
/// is not seen has none.
void AddJointTargets(const JointPoints& points, const JointInputs& joints,
                     pose::PoseTargets& targets);

/// A joint that is far from where the last pose, `at` in W, has it counts less, the less the
/// further; one that is implausibly far, or not finite, is not valid. Where many are implausibly
/// far it is the pose that is wrong, and none is dropped for that.
void GateJoints(const JointPoints& points, const body::Kinematics& at, JointInputs& joints);

/// Common error of all joints, as a camera that stands not quite where it was found to
/// stand makes them. Feet and COM stand still in W, so it is learned from what the joints are off
/// from the pose that follows all of these. Of a few joints it would be what the pose is off by.
/// A value.
class SkeletonOffset {
 public:
  void Start() { offset_m_.setZero(); }
  /// The inputs without it: joints, and the hands that the same tracker alone
  /// sees: another one knows a hand better than the offset is known.
  Inputs Without(const Inputs& inputs) const;
  /// One frame: `joints` by Without, and gated; `at` in W is the pose that was solved for them.
  void Learn(const JointPoints& points, const JointInputs& joints, const body::Kinematics& at,
             double step_s);
  const Eigen::Vector3d& offset_m() const { return offset_m_; }

 private:
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();
};

inline constexpr std::size_t kHeadJoint = body::IndexOf(stream::BodyJoint::kHead);

/// Seat of a tracker on the head where no skeleton is tracked: the sphere of a cap is above the
/// head, by how much nobody measures. It is found in the half second after the T-pose, which the
/// person still holds: boards and hands show that pose better than any other. A value.
class HeadSeat {
 public:
  static constexpr double kSeconds = 0.5;

  /// Whether a head is seen by itself, outside a skeleton, and surely enough to have a seat: one
  /// that a tracker shows to a few centimetres, such as a Kinect's, is the middle of the head.
  static bool IsLone(const JointInputs& joints);

  /// `middle`: the middle of the head on the body.
  void Start(const body::Point& middle);
  /// Whether it is being found: meanwhile the head does not count for the pose.
  bool Seeks() const { return sought_s_ < kSeconds; }
  /// A frame of it: joints in W, and the pose that boards and hands alone show, in W. One that
  /// is not lone adds nothing.
  void See(const JointInputs& joints, const body::Kinematics& at, double step_s);

  /// The point that is seen: that of the seat where it was seen for most of the time, within 35 cm
  /// of the middle; else the middle.
  const body::Point& point() const { return point_; }
  bool found() const { return found_; }

 private:
  body::Point middle_, point_;
  bool found_ = false;
  double sought_s_ = 0, seen_s_ = 0;
  Eigen::Vector3d sum_J_m_ = Eigen::Vector3d::Zero();  ///< Times seconds.
};

}  // namespace footing::reconstruction
