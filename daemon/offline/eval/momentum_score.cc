#include "daemon/offline/eval/momentum_score.h"

#include <cmath>

namespace footing::eval {

using momentum::kFeet;

double Rms::value() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0; }

MomentumScore::MomentumScore(const MomentumScene& scene, const momentum::TPose& pose,
                             std::size_t start)
    : scene_(scene), start_(start), step_s_(1 / scene.rate_hz) {
  for (std::size_t f = 0; f < kFeet; ++f) {
    rest_m_[f] = scene.frames[0].feet[f].middle_m - pose.p_WP_m[f];
  }
}

void MomentumScore::Add(std::size_t now, std::size_t then, const momentum::Estimate& estimate) {
  const MomentumFrame& truth = scene_.frames[now];
  ++frames_;
  AddCom(now, estimate, scene_.frames[then].com_m);
  AddCentreOfPressure(truth);
  AddAngularMomentum(truth, estimate);
  AddFeet(truth, estimate);
}

void MomentumScore::AddCom(std::size_t now, const momentum::Estimate& estimate,
                           const Eigen::Vector3d& com_m) {
  const auto minute = static_cast<std::size_t>(60 / step_s_);
  const Eigen::Vector3d error = estimate.p_WC_m - com_m;
  finite_ = finite_ && error.allFinite() && estimate.angular_momentum_kgm2ps.allFinite();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    com_[axis].Add(error(static_cast<Eigen::Index>(axis)));
  }
  if (now < start_ + minute) first_minute_.Add(error.z());
  if (now + minute >= scene_.frames.size()) last_minute_.Add(error.z());
  nees_ += error.z() * error.z() / estimate.position_variance_m2.z();
}

void MomentumScore::AddCentreOfPressure(const MomentumFrame& truth) {
  const auto cop = PressureOf(truth.loads, 100);
  if (!cop.cop_valid) return;
  cop_[0].Add(cop.p_WP_m.x() - truth.com_m.x());
  cop_[1].Add(cop.p_WP_m.y() - truth.com_m.y());
}

void MomentumScore::AddAngularMomentum(const MomentumFrame& truth,
                                       const momentum::Estimate& estimate) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    angular_error_[k].Add(estimate.angular_momentum_kgm2ps(axis) - truth.angular_momentum(axis));
    angular_true_[k].Add(truth.angular_momentum(axis));
  }
}

void MomentumScore::AddFeet(const MomentumFrame& truth, const momentum::Estimate& estimate) {
  for (std::size_t f = 0; f < kFeet; ++f) {
    contacts_.Add(f, truth.feet[f].load_n > kContactN, estimate.feet[f].contact, step_s_);
    if (contacts_.true_since_s[f] <= kSettledContactS) continue;
    const Eigen::Vector3d p_W_m = estimate.feet[f].p_WF_m + rest_m_[f];
    foot_position_.Add((p_W_m - truth.feet[f].middle_m).head<2>().norm());
  }
}

void MomentumScore::WriteTo(nlohmann::ordered_json& out) const {
  out["finite"] = finite_;
  out["cop_outside_sensors_share"] = scene_.outside_share;
  out["com_forward_rms_cm"] = com_[0].centimetres();
  out["com_lateral_rms_cm"] = com_[1].centimetres();
  out["com_horizontal_rms_cm"] = std::hypot(com_[0].centimetres(), com_[1].centimetres());
  out["com_vertical_rms_cm"] = com_[2].centimetres();
  out["com_vertical_first_minute_rms_cm"] = first_minute_.centimetres();
  out["com_vertical_last_minute_rms_cm"] = last_minute_.centimetres();
  out["com_vertical_nees"] = nees_ / static_cast<double>(frames_);
  out["cop_forward_rms_cm"] = cop_[0].centimetres();
  out["cop_lateral_rms_cm"] = cop_[1].centimetres();
  out["foot_position_rms_cm"] = foot_position_.centimetres();
  out["contact_f1"] = contacts_.F1();
  out["landings"] = contacts_.landings;
  out["landing_delay_ms"] = 1000 * contacts_.mean_delay_s();
  out["landing_delay_worst_ms"] = 1000 * contacts_.worst_delay_s;
  nlohmann::ordered_json& angular = out["angular_momentum_error_kgm2ps"];
  for (std::size_t k = 0; k < 3; ++k) {
    angular.push_back({{"error", angular_error_[k].value()}, {"true", angular_true_[k].value()}});
  }
}

}  // namespace footing::eval
