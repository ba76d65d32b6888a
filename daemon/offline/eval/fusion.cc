#include "daemon/offline/eval/fusion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton_points.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/reconstruction/pose_targets.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using reconstruction::Reconstruction;
using virtual_sensors::KinectSkeleton;

/// The four ways over the same frames.
class FusionTrial {
 public:
  FusionTrial(const pose_run::PoseRun& run, const reconstruction::SubjectModel& model,
              const reconstruction::Options& options)
      : run_(run),
        model_(model),
        options_(options),
        alone_(model.body, model.basis, reconstruction::BasisSolverOptions(options)),
        at_(run.body.skeleton) {
    // The basis has the origin of its poses between the feet of the T-pose.
    for (const auto& foot : run.frames.front().feet)
      origin_m_.head<2>() += 0.25 * (foot.ankle_m + foot.toe_m).head<2>();
  }

  FusionReport Run(Reconstruction& boards, Reconstruction& fused) {
    for (std::size_t i = 0; i < run_.frames.size(); ++i) Step(i, boards, fused);
    const auto ratio = [](double over, double under) { return under > 0 ? over / under : 0; };
    const FusedScore &skeleton = scores_[0], &both = scores_[3];
    return {{{"frames", run_.frames.size() - std::min(run_.judged_from, run_.frames.size())},
             {"squat_frames", squats_},
             {"hidden_joints", hidden_},
             {"skeleton", skeleton.Json()},
             {"skeleton_solved", scores_[1].Json()},
             {"boards_and_hands", scores_[2].Json()},
             {"fused", both.Json()},
             {"hip_ratio", ratio(both.hip_cm(), skeleton.hip_cm())},
             {"knee_ratio", ratio(both.knee_cm(), skeleton.knee_cm())},
             {"hidden_ratio", ratio(both.hidden_cm(), skeleton.hidden_cm())}},
            figure_.Svg()};
  }

 private:
  void Step(std::size_t i, Reconstruction& boards, Reconstruction& fused) {
    const pose_run::Frame& frame = run_.frames[i];
    reconstruction::Inputs without = frame.inputs;
    without.joints = {};
    for (reconstruction::HandInput& hand : without.hands) hand.of_skeleton = false;
    boards.Advance(without);
    if (!fused.Advance(frame.inputs).calibrated) return;
    SolveAlone(frame.inputs);
    if (i >= run_.judged_from) Score(frame, boards.output(), fused.output());
  }

  /// The skeleton without boards.
  void SolveAlone(const reconstruction::Inputs& inputs) {
    reconstruction::Measurement seen;
    seen.hands = inputs.hands;
    reconstruction::Clear(targets_);
    reconstruction::AddHandTargets(model_, seen, options_.best, targets_);
    reconstruction::AddJointTargets(model_.joints, inputs.joints, targets_);
    reconstruction::MoveOrigin(origin_m_, targets_);
    alone_.Solve(targets_);
  }

  void Score(const pose_run::Frame& frame, const reconstruction::Output& boards,
             const reconstruction::Output& fused) {
    StickPlaces then, reported;
    std::array<bool, stream::kBodyJoints> hidden;
    for (std::size_t i = 0; i < frame.kinect.size(); ++i) {
      const virtual_sensors::KinectPoint& point = frame.kinect[i];
      const bool is_hand = i < KinectSkeleton::kHands;
      (is_hand ? then.hands[i] : then.joints[i - KinectSkeleton::kHands]) = point.true_W_m;
      (is_hand ? reported.hands[i] : reported.joints[i - KinectSkeleton::kHands]) = point.p_W_m;
      if (!is_hand) hidden[i - KinectSkeleton::kHands] = point.hidden;
    }
    body::ComputeKinematics(run_.body.skeleton, frame.q, at_);
    const StickPlaces truth = PlacesOf(at_, Eigen::Vector3d::Zero());
    const StickPlaces of_fused = PlacesOf(fused);
    const bool squats = frame.kinect_crouches;
    scores_[0].Add(then.joints, reported.joints, hidden, squats);
    scores_[1].Add(truth.joints, PlacesOf(alone_.at(), origin_m_).joints, hidden, squats);
    scores_[2].Add(truth.joints, PlacesOf(boards).joints, hidden, squats);
    scores_[3].Add(truth.joints, of_fused.joints, hidden, squats);
    const auto count = static_cast<int>(std::count(hidden.begin(), hidden.end(), true));
    squats_ += squats ? 1 : 0;
    hidden_ += static_cast<std::size_t>(count);
    Figure7::Moment moment{0, frame.inputs.loads.time_s, count, truth, reported, of_fused};
    if (squats) {
      moment.weight = -truth.joints[body::IndexOf(stream::BodyJoint::kTorso)].z();
      figure_.AddSquat(moment);
    } else if (count > 0) {
      moment.weight = count;
      figure_.AddOther(moment);
    }
  }

  StickPlaces PlacesOf(const reconstruction::Output& output) {
    body::ComputeKinematics(run_.body.skeleton, output.q, at_);
    return PlacesOf(at_, Eigen::Vector3d::Zero());
  }

  StickPlaces PlacesOf(const body::Kinematics& at, const Eigen::Vector3d& origin_m) const {
    StickPlaces places;
    for (std::size_t i = 0; i < places.joints.size(); ++i) {
      places.joints[i] = origin_m + body::Place(model_.joints[i], at);
    }
    for (std::size_t side = 0; side < places.hands.size(); ++side) {
      places.hands[side] = origin_m + body::Place(model_.fists[side], at);
    }
    return places;
  }

  const pose_run::PoseRun& run_;
  const reconstruction::SubjectModel& model_;
  reconstruction::Options options_;
  pose::GaussNewton alone_;
  pose::PoseTargets targets_;
  body::Kinematics at_;
  std::array<FusedScore, 4> scores_;
  Figure7 figure_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::size_t squats_ = 0, hidden_ = 0;
};

}  // namespace

Result<FusionReport> RunFusionTrial(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options) {
  const auto model = reconstruction::BestSubjectModel(run.body, models, options);
  if (!model) return model.error();
  auto boards = Reconstruction::Create(run.body, models, options);
  if (!boards) return boards.error();
  auto fused = *boards;
  return FusionTrial(run, *model, options).Run(*boards, fused);
}

namespace {

struct FusionFlags {
  PoseSceneOptions scene;
  std::vector<std::string> models;
  double camera_yaw_deg = 0;
  std::string figure;
};

Result<nlohmann::ordered_json> Evaluate(FusionFlags flags) {
  flags.scene.standard_layout = flags.models.empty();
  pose_run::Settings& settings = flags.scene.settings;
  settings.hand_device = pose_run::HandDevice::kKinect;
  settings.joints = true;
  settings.kinect.yaw_rad = DegreesToRadians(flags.camera_yaw_deg);
  const auto models = ReadPoseModels(flags.models, flags.scene.motion);
  if (!models) return models.error();
  const auto run = MakePoseScene(flags.scene);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = run->rate_hz;
  auto report = RunFusionTrial(*run, *models, options);
  if (!report) return report.error();
  if (!flags.figure.empty()) {
    if (auto written = WriteText(flags.figure, report->figure); !written) return written.error();
  }
  return std::move(report->json);
}

}  // namespace

void AddFusionCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "fusion",
      "Joints that a body hides from a camera: its skeleton, boards, and both (paper, Figure 7)");
  const auto flags = std::make_shared<FusionFlags>();
  pose_run::Settings& settings = flags->scene.settings;
  AddMotionOptions(*command, flags->scene);
  command->add_option("--model", flags->models,
                      "Models, *.fmodel; may be repeated (default: the built-in ones)");
  command
      ->add_option("--squat-share", settings.kinect.crouch_share,
                   "Height of the hips below which the legs are hidden, as a share of standing")
      ->check(CLI::Range(0.3, 1.0));
  command
      ->add_option("--camera-yaw-deg", flags->camera_yaw_deg,
                   "Direction of the camera from the person, degrees: 0 ahead, 90 to the left")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--seed", settings.seed, "Seed of the skeleton's errors");
  command->add_option("--figure", flags->figure, "Write Figure 7 of the pose paper, SVG file");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

namespace {

using stream::BodyJoint;

bool IsBetween(std::size_t index, BodyJoint first, BodyJoint last) {
  return index >= body::IndexOf(first) && index <= body::IndexOf(last);
}

/// Left or right, by the left joint.
std::size_t OfSide(BodyJoint left, std::size_t side) { return body::IndexOf(left) + side; }

LegPlaces LegOf(const JointPlaces& places, std::size_t side) {
  return {places[OfSide(BodyJoint::kLeftHip, side)], places[OfSide(BodyJoint::kLeftKnee, side)],
          places[OfSide(BodyJoint::kLeftFoot, side)]};
}

}  // namespace

void FusedScore::AddKnee(const JointPlaces& truth, const JointPlaces& places, std::size_t side) {
  const LegPlaces is = LegOf(places, side), was = LegOf(truth, side);
  const KneeError knee = SplitKneeError(was, is);
  hip_heights_.Add(100 * std::abs(is.hip.z() - was.hip.z()));
  feet_.Add(100 * (is.ankle - was.ankle).norm());
  turns_.Add(RadiansToDegrees(std::abs(knee.turn_rad)));
  unturned_.Add(100 * knee.unturned_m);
}

void FusedScore::Add(const JointPlaces& truth, const JointPlaces& places,
                     const std::array<bool, stream::kBodyJoints>& hidden, bool squats) {
  for (std::size_t side = 0; squats && side < 2; ++side) AddKnee(truth, places, side);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off_cm = 100 * (places[i] - truth[i]).norm();
    if (squats && IsBetween(i, BodyJoint::kLeftHip, BodyJoint::kRightHip)) hips_.Add(off_cm);
    if (squats && IsBetween(i, BodyJoint::kLeftKnee, BodyJoint::kRightKnee)) knees_.Add(off_cm);
    if (!hidden[i]) {
      seen_.Add(off_cm);
      if (IsBetween(i, BodyJoint::kLeftShoulder, BodyJoint::kRightElbow)) seen_arms_.Add(off_cm);
      continue;
    }
    hidden_.Add(off_cm);
    if (IsBetween(i, BodyJoint::kLeftShoulder, BodyJoint::kRightElbow)) arms_.Add(off_cm);
    if (IsBetween(i, BodyJoint::kLeftHip, BodyJoint::kRightKnee)) legs_.Add(off_cm);
  }
}

nlohmann::ordered_json FusedScore::Json() const {
  return {{"hip_cm", hips_.mean()},
          {"hip_p95_cm", hips_.Quantile(0.95)},
          {"knee_cm", knees_.mean()},
          {"knee_p95_cm", knees_.Quantile(0.95)},
          {"knee_turn_deg", turns_.mean()},
          {"knee_unturned_cm", unturned_.mean()},
          {"hip_height_cm", hip_heights_.mean()},
          {"foot_cm", feet_.mean()},
          {"hidden_cm", hidden_.mean()},
          {"hidden_arms_cm", arms_.mean()},
          {"hidden_legs_cm", legs_.mean()},
          {"seen_cm", seen_.mean()},
          {"seen_arms_cm", seen_arms_.mean()}};
}

namespace {

constexpr double kLeastM = 1e-6;

struct Circle {
  Eigen::Vector3d axis;      ///< From hip to ankle, of length 1.
  Eigen::Vector3d centre_m;  ///< Where the knee's plane cuts the line.
  Eigen::Vector3d radius_m;  ///< From there to the knee.
};

Circle CircleOf(const LegPlaces& leg) {
  const Eigen::Vector3d axis = (leg.ankle - leg.hip).normalized();
  const Eigen::Vector3d centre_m = leg.hip + axis.dot(leg.knee - leg.hip) * axis;
  return {axis, centre_m, leg.knee - centre_m};
}

}  // namespace

KneeError SplitKneeError(const LegPlaces& truth, const LegPlaces& estimate) {
  const Circle was = CircleOf(truth), is = CircleOf(estimate);
  KneeError error{.turn_rad = 0, .unturned_m = (estimate.knee - truth.knee).norm()};
  if (was.radius_m.norm() < kLeastM || is.radius_m.norm() < kLeastM) return error;
  const Eigen::Vector3d expected =
      Eigen::Quaterniond::FromTwoVectors(was.axis, is.axis) * was.radius_m.normalized();
  error.turn_rad = std::atan2(is.axis.dot(expected.cross(is.radius_m)), expected.dot(is.radius_m));
  const Eigen::Vector3d turned_back_m = is.centre_m + is.radius_m.norm() * expected;
  error.unturned_m = (turned_back_m - truth.knee).norm();
  return error;
}

namespace {

constexpr double kSeenFromDeg = 35;  // From the front to the left, as the crouches of eval pose.

void AddMoment(const std::string& name, const Figure7::Moment& moment,
               std::vector<plot::Panel>& panels) {
  const plot::Sticks truth = SticksOf(moment.truth);
  const std::string hides = name + ", " + std::to_string(moment.hidden) + " joints hidden";
  panels.push_back({hides + ": Kinect alone", truth, SticksOf(moment.alone)});
  panels.push_back(
      {"with the boards, " + text::Fixed(moment.time_s, 1) + " s", truth, SticksOf(moment.fused)});
}

}  // namespace

plot::Sticks SticksOf(const StickPlaces& places) {
  constexpr std::array kBones{std::array{BodyJoint::kHead, BodyJoint::kNeck},
                              std::array{BodyJoint::kNeck, BodyJoint::kTorso},
                              std::array{BodyJoint::kNeck, BodyJoint::kLeftShoulder},
                              std::array{BodyJoint::kNeck, BodyJoint::kRightShoulder},
                              std::array{BodyJoint::kLeftShoulder, BodyJoint::kLeftElbow},
                              std::array{BodyJoint::kRightShoulder, BodyJoint::kRightElbow},
                              std::array{BodyJoint::kTorso, BodyJoint::kLeftHip},
                              std::array{BodyJoint::kTorso, BodyJoint::kRightHip},
                              std::array{BodyJoint::kLeftHip, BodyJoint::kLeftKnee},
                              std::array{BodyJoint::kRightHip, BodyJoint::kRightKnee},
                              std::array{BodyJoint::kLeftKnee, BodyJoint::kLeftFoot},
                              std::array{BodyJoint::kRightKnee, BodyJoint::kRightFoot}};
  const double yaw_rad = DegreesToRadians(kSeenFromDeg);
  const auto across = [&](const Eigen::Vector3d& p) {
    return std::cos(yaw_rad) * p.x() - std::sin(yaw_rad) * p.y();
  };
  plot::Sticks sticks;
  const auto add = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    sticks.push_back({across(from), from.z(), across(to), to.z()});
  };
  for (const auto& bone : kBones) {
    add(places.joints[body::IndexOf(bone[0])], places.joints[body::IndexOf(bone[1])]);
  }
  add(places.joints[body::IndexOf(BodyJoint::kLeftElbow)], places.hands[0]);
  add(places.joints[body::IndexOf(BodyJoint::kRightElbow)], places.hands[1]);
  return sticks;
}

std::string Figure7::Svg() const {
  std::vector<plot::Panel> panels;
  if (squat_) AddMoment("squat", *squat_, panels);
  if (other_) AddMoment("standing", *other_, panels);
  return plot::StickPlot(panels.empty() ? "Nothing is hidden from the camera"
                                        : "Where the camera loses joints; grey: the truth",
                         panels);
}

}  // namespace footing::eval
