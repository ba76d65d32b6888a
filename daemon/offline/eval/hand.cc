#include "daemon/offline/eval/hand.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "common/body/kinematics.h"
#include "common/virtual/devices/held_device.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/edit.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/pose/inertial_track.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

const Eigen::Vector3d kCamera_W_m(2.2, 0, 1.2);
constexpr double kFrameS = 1.0 / 60, kTickS = 0.01;
constexpr double kCameraLateS = 0.025, kReadingLateS = 0.008;
constexpr double kTimeSdS = 0.001;  // Standard deviation of an exposure's time stamp.
constexpr double kSettledS = 8;     // The T-pose and the way out of it do not count.
constexpr double kRestMps = 0.05;

/// docs/evaluation/camera.md: lateral and depth by distance, one frame.
Eigen::Matrix3d CameraCovariance(const Eigen::Vector3d& p_W_m) {
  const Eigen::Vector3d sight = p_W_m - kCamera_W_m;
  const double distance_m = sight.norm();
  const double lateral_m = 0.03e-3 * std::pow(distance_m, 1.45) / std::sqrt(2.0);
  const double depth_m = 0.8e-3 * std::pow(distance_m, 2.3);
  const Eigen::Vector3d along = sight / distance_m;
  return lateral_m * lateral_m * Eigen::Matrix3d::Identity() +
         (depth_m * depth_m - lateral_m * lateral_m) * along * along.transpose();
}

struct HandScore {
  int count = 0, invalid = 0;
  double square_m2 = 0, nees = 0, speed_square = 0;

  void Add(bool valid, const Eigen::Vector3d& off_m, const Eigen::Matrix3d& covariance_m2,
           double speed_off_mps = 0) {
    if (!valid) {
      ++invalid;
      return;
    }
    ++count;
    square_m2 += off_m.squaredNorm();
    nees += off_m.dot(covariance_m2.ldlt().solve(off_m)) / 3;
    speed_square += speed_off_mps * speed_off_mps;
  }
  ordered_json Json() const {
    return {{"count", count},
            {"not_valid", invalid},
            {"rms_mm", 1e3 * std::sqrt(square_m2 / std::max(1, count))},
            {"nees", nees / std::max(1, count)},
            {"speed_rms_mps", std::sqrt(speed_square / std::max(1, count))}};
  }
};

struct Scores {
  HandScore rest, motion, hidden, last;
  ordered_json Json(bool is_hidden) const {
    if (!is_hidden) return {{"at_rest", rest.Json()}, {"in_motion", motion.Json()}};
    return {{"at_rest", rest.Json()},
            {"in_motion", motion.Json()},
            {"hidden", hidden.Json()},
            {"at_its_end", last.Json()}};
  }
};

struct Frame {
  double exposed_s, arrives_s;
  Eigen::Vector3d p_W_m;
  Eigen::Matrix3d covariance_m2;
};

/// One hand, hidden again and again for the same time.
class HandRun {
 public:
  HandRun(const HandCourse& course, const HandTrialOptions& options, double hidden_s,
          std::uint64_t seed)
      : course_(course),
        options_(options),
        hidden_s_(hidden_s),
        random_(seed),
        p_SP_m_(options.sphere_m, 0, 0),
        inertial_(p_SP_m_),
        common_{random_.Normal(), random_.Normal(), random_.Normal()} {}

  void Run() {
    const double end_s = static_cast<double>(course_.count() - 2) / course_.rate_hz;
    double frame_s = random_.Uniform(0, kFrameS);
    std::size_t reading = 0;
    for (double now_s = kTickS; now_s < end_s; now_s += kTickS) {
      for (; frame_s < now_s; frame_s += kFrameS) Expose(frame_s);
      for (; frames_.size() > 0 && frames_.front().arrives_s <= now_s; frames_.pop_front())
        Take(frames_.front());
      for (; static_cast<double>(reading) / course_.rate_hz <= now_s - kReadingLateS; ++reading)
        inertial_.Feel(1 + static_cast<double>(reading) / course_.rate_hz,
                       course_.readings[reading]);
      if (now_s > kSettledS) Compare(now_s);
    }
  }

  Scores alone, with_readings;
  std::size_t refused() const { return inertial_.refused(); }

 private:
  bool IsHidden(double time_s) const { return HiddenFor(time_s) >= 0; }
  /// Since it is hidden; negative when it is seen.
  double HiddenFor(double time_s) const {
    return std::fmod(time_s, options_.seen_s + hidden_s_) - options_.seen_s;
  }

  void Expose(double time_s) {
    Eigen::Vector3d p_W_m = course_.PointAt(p_SP_m_, time_s);
    if (IsHidden(time_s)) {
      if (options_.lamp_m <= 0) return;
      p_W_m.z() += options_.lamp_m;
    }
    const Eigen::Matrix3d covariance = CameraCovariance(p_W_m);
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    Eigen::Vector3d white;
    for (double& value : white) value = random_.Normal();
    const double share = options_.common_share;
    p_W_m += root * (std::sqrt(1 - share) * white + std::sqrt(share) * common_);
    frames_.push_back(
        {time_s + kTimeSdS * random_.Normal(), time_s + kCameraLateS, p_W_m, covariance});
  }

  void Take(const Frame& frame) {
    camera_.Add(frame.exposed_s, frame.p_W_m, frame.covariance_m2.diagonal().cwiseSqrt(),
                {frame.covariance_m2(0, 1), frame.covariance_m2(0, 2), frame.covariance_m2(1, 2)});
    seen_s_ = frame.exposed_s;
    inertial_.See(1 + frame.exposed_s, {frame.p_W_m, frame.covariance_m2});
  }

  void Compare(double now_s) {
    const Eigen::Vector3d truth_m = course_.At(course_.p_W_m, now_s);
    const Eigen::Vector3d v_mps = course_.At(course_.v_W_mps, now_s);
    const auto estimate = inertial_.At(1 + now_s);
    const auto hand = camera_.At(now_s);
    Eigen::Matrix3d covariance = hand.sd_m.cwiseAbs2().asDiagonal();
    covariance(0, 1) = covariance(1, 0) = hand.covariance_m2(0);
    covariance(0, 2) = covariance(2, 0) = hand.covariance_m2(1);
    covariance(1, 2) = covariance(2, 1) = hand.covariance_m2(2);
    const auto add = [&](HandScore Scores::*which) {
      (with_readings.*which)
          .Add(estimate.valid, estimate.p_W_m - truth_m, estimate.covariance.topLeftCorner<3, 3>(),
               (estimate.v_W_mps - v_mps).norm());
      (alone.*which)
          .Add(hand.valid && now_s - seen_s_ < 0.55, hand.p_W_m - course_.PointAt(p_SP_m_, now_s),
               covariance);
    };
    const double hidden_for_s = hidden_s_ > 0 ? HiddenFor(now_s - kCameraLateS) : -1;
    if (hidden_for_s < 0) {
      add(v_mps.norm() < kRestMps ? &Scores::rest : &Scores::motion);
      return;
    }
    add(&Scores::hidden);
    if (hidden_for_s > hidden_s_ - 1.5 * kTickS) add(&Scores::last);
  }

  const HandCourse& course_;
  const HandTrialOptions& options_;
  double hidden_s_;
  noise::Random random_;
  Eigen::Vector3d p_SP_m_;
  inertial::Track inertial_;
  reconstruction::HandTrack camera_;
  Eigen::Vector3d common_;
  std::deque<Frame> frames_;
  double seen_s_ = 0;
};

}  // namespace

ordered_json RunHandTrial(const pose_run::ArmRun& run, const HandTrialOptions& options) {
  ordered_json rows = ordered_json::array();
  std::vector<HandCourse> courses;
  for (int side = 0; side < 2; ++side)
    courses.push_back(FollowHand(run, side, 2 * options.seed + static_cast<std::uint64_t>(side)));
  for (const double hidden_s : options.hidden_s) {
    for (int side = 0; side < 2; ++side) {
      HandRun one(courses[static_cast<std::size_t>(side)], options, hidden_s,
                  100 * options.seed + static_cast<std::uint64_t>(side));
      one.Run();
      rows.push_back({{"hidden_s", hidden_s},
                      {"hand", side == 0 ? "left" : "right"},
                      {"camera_alone", one.alone.Json(hidden_s > 0)},
                      {"with_inertial", one.with_readings.Json(hidden_s > 0)},
                      {"refused", one.refused()}});
    }
  }
  return {{"rows", rows}};
}

namespace {

struct HandFlags {
  PoseSceneOptions scene;
  HandTrialOptions trial;
};

Result<nlohmann::ordered_json> Evaluate(HandFlags flags) {
  flags.scene.settings.rate_hz = 120;
  flags.trial.seed = flags.scene.settings.seed;
  const auto run = MakeArmScene(flags.scene, pose_run::kFists);
  if (!run) return run.error();
  return RunHandTrial(*run, flags.trial);
}

}  // namespace

void AddHandCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "hand",
      "Hands that a camera sees, between its frames and while they are hidden: by the camera alone "
      "and with the inertial sensors of a PS Move");
  const auto flags = std::make_shared<HandFlags>();
  HandTrialOptions& trial = flags->trial;
  AddMotionOptions(*command, flags->scene);
  command
      ->add_option("--hidden-s", trial.hidden_s,
                   "Durations for which a hand is hidden, s, each in a run of its own")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 5.0));
  command->add_option("--seen-s", trial.seen_s, "Duration between them, s")
      ->check(CLI::Range(0.2, 60.0));
  command
      ->add_option("--sphere-m", trial.sphere_m,
                   "Distance of the sphere from the device's sensors, along its x, m")
      ->check(CLI::Range(0.0, 0.3));
  command
      ->add_option("--lamp-m", trial.lamp_m,
                   "While a hand is hidden, a lamp so far above it is taken for it, m; 0: none")
      ->check(CLI::Range(0.0, 2.0));
  command
      ->add_option("--common-share", trial.common_share,
                   "Share of the camera's variance that all frames have in common")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--seed", flags->scene.settings.seed, "Seed of the errors");
  command->callback(
      [flags, &shared] { shared.exit_code = PrintResult(Evaluate(*flags), shared.json); });
}

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
