#include "daemon/offline/eval/hand_trial.h"

#include <Eigen/Dense>
#include <cmath>
#include <deque>

#include "common/virtual/devices/random.h"
#include "daemon/offline/eval/hand_course.h"
#include "daemon/simulation/pose/track.h"
#include "daemon/simulation/reconstruction/hand_track.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

const Eigen::Vector3d kCamera_W_m(2.2, 0, 1.2);
constexpr double kFrameS = 1.0 / 60, kTickS = 0.01;
constexpr double kCameraLateS = 0.025, kReadingLateS = 0.008;
constexpr double kTimeSdS = 0.001;  // Of an exposure.
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

struct Score {
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
  Score rest, motion, hidden, last;
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
    const auto add = [&](Score Scores::*which) {
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

}  // namespace footing::eval
