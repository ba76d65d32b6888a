#include "daemon/offline/eval/foot_score.h"

#include <algorithm>
#include <cmath>

namespace footing::eval {
namespace {

const Eigen::Vector3d& JointPlace(const body::Kinematics& at, int joint) {
  return at.p_WJ[static_cast<std::size_t>(joint)];
}

}  // namespace

FootScore::FootScore(const pose_run::PoseRun& run, std::size_t lag)
    : run_(run), lag_(lag), step_s_(1 / run.rate_hz) {
  const auto geometry = reconstruction::StandingFeet(run.body);
  for (int side = 0; side < 2; ++side) {
    const auto f = static_cast<std::size_t>(side);
    feet_[f].geometry = geometry[f];
    feet_[f].ankle = body::Ankle(run.body, side).joint;
    feet_[f].toe = body::Toe(run.body, side).joint;
  }
  first_on_feet_ =
      static_cast<std::size_t>(std::lround((pose_run::kStandS + pose_run::kLeaveS) * run.rate_hz));
}

void FootScore::Add(const reconstruction::Output& output, const PoseScore& score, std::size_t i) {
  const bool settled = i - lag_ >= first_on_feet_;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const bool contact = output.momentum.feet[f].contact;
    contacts_.Add(f, run_.frames[i].feet[f].load_n > kContactN, contact, step_s_);
    AddSkate(run_.frames[i - lag_].inputs.loads.feet[f], score, settled, feet_[f]);
    if (settled && contacts_.true_since_s[f] > kSettledContactS) AddPlace(score, feet_[f]);
    AddBallSpeed(score, contact, feet_[f]);
  }
}

void FootScore::AddPlace(const PoseScore& score, const Foot& foot) {
  const Eigen::Vector3d error_m =
      0.5 * (JointPlace(score.at(), foot.ankle) + JointPlace(score.at(), foot.toe) -
             JointPlace(score.truth(), foot.ankle) - JointPlace(score.truth(), foot.toe));
  place_.Add(100 * error_m.head<2>().norm());
}

void FootScore::AddBallSpeed(const PoseScore& score, bool contact, Foot& foot) {
  const Eigen::Vector3d toe_m = JointPlace(score.at(), foot.toe);
  const Eigen::Vector3d true_toe_m = JointPlace(score.truth(), foot.toe);
  if (contact && foot.contact) {
    ball_speed_.Add(100 * (toe_m - foot.toe_m).head<2>().norm() / step_s_);
    true_ball_speed_.Add(100 * (true_toe_m - foot.true_toe_m).head<2>().norm() / step_s_);
  }
  foot.toe_m = toe_m;
  foot.true_toe_m = true_toe_m;
  foot.contact = contact;
}

/// The point of the sole where the true foot has its COP, as it moves with either foot.
void FootScore::AddSkate(const momentum::FootLoads& loads, const PoseScore& score, bool settled,
                         Foot& foot) {
  const momentum::Pressure pressure = momentum::PressureOf(loads, kContactN);
  const SolePoints now{body::Place(foot.geometry.heel, score.at()),
                       body::Place(foot.geometry.toe, score.at())};
  const SolePoints true_now{body::Place(foot.geometry.heel, score.truth()),
                            body::Place(foot.geometry.toe, score.truth())};
  const Eigen::Vector2d along = (true_now[1] - true_now[0]).head<2>();
  const double from_heel = (pressure.p_WP_m - true_now[0]).head<2>().dot(along);
  const double share = pressure.cop_valid
                           ? std::clamp(from_heel / std::max(along.squaredNorm(), 1e-6), 0.0, 1.0)
                           : 0.5;
  const auto speed = [&](const SolePoints& after, const SolePoints& before) {
    const Eigen::Vector3d step_m =
        (1 - share) * (after[0] - before[0]) + share * (after[1] - before[1]);
    return 100 * step_m.head<2>().norm() / step_s_;
  };
  if (const auto oldest = foot.stance.Advance(
          settled && pressure.cop_valid,
          {speed(now, foot.sole_m), speed(true_now, foot.true_sole_m)}, step_s_)) {
    skate_.Add((*oldest)[0]);
    true_skate_.Add((*oldest)[1]);
  }
  foot.sole_m = now;
  foot.true_sole_m = true_now;
}

void FootScore::WriteTo(nlohmann::ordered_json& json) const {
  json["foot_skate_cm_per_s"] = skate_.mean();
  json["foot_skate_true_cm_per_s"] = true_skate_.mean();
  json["ball_speed_in_contact_cm_per_s"] = ball_speed_.mean();
  json["ball_speed_in_contact_true_cm_per_s"] = true_ball_speed_.mean();
  json["foot_position_rms_cm"] = place_.rms();
  json["contact_f1"] = contacts_.F1();
  json["landings"] = contacts_.landings;
  json["landing_delay_ms"] = 1000 * contacts_.mean_delay_s();
}

}  // namespace footing::eval
