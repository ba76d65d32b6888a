#include "daemon/offline/eval/com_score.h"

#include <algorithm>
#include <cmath>

#include "common/body/momentum.h"

namespace footing::eval {

void ComScore::Add(const body::Body& body, const reconstruction::Output& output,
                   const PoseScore& score, const pose_run::Frame& truth) {
  const Eigen::Vector3d error_m = output.com_W_m - truth.com_m;
  vertical_.Add(100 * error_m.z());
  horizontal_.Add(100 * error_m.head<2>().norm());
  forward_.Add(100 * error_m.x());
  lateral_.Add(100 * error_m.y());
  const double t_s = truth.inputs.loads.time_s;
  vertical_drift_.Add(t_s, 100 * std::abs(error_m.z()));
  horizontal_drift_.Add(t_s, 100 * error_m.head<2>().norm());
  const Eigen::Vector3d com = body::CentreOfMass(body, score.at());
  pose_vertical_.Add(100 * (com.z() - truth.com_m.z()));
  loads_vertical_.Add(100 * (output.momentum.p_WC_m.z() - truth.com_m.z()));
  nees_ += error_m.z() * error_m.z() / output.com_variance_m2.z();
  ++frames_;
  if (output.posture_com_W_m) {
    const Eigen::Vector3d off_m = *output.posture_com_W_m - truth.com_m;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      posture_[static_cast<std::size_t>(axis)].Add(100 * off_m(axis));
    }
  }
  pose_horizontal_.Add(100 * (com - truth.com_m).head<2>().norm());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    angular_[static_cast<std::size_t>(axis)].Add(output.momentum.angular_momentum_kgm2ps(axis) -
                                                 truth.angular_momentum(axis));
  }
}

void ComScore::WriteTo(nlohmann::ordered_json& json) const {
  json["com_vertical_rms_cm"] = vertical_.rms();
  json["com_horizontal_rms_cm"] = horizontal_.rms();
  json["com_forward_rms_cm"] = forward_.rms();
  json["com_lateral_rms_cm"] = lateral_.rms();
  json["com_forward_bias_cm"] = forward_.mean();
  json["com_forward_sd_cm"] =
      std::sqrt(std::max(0.0, std::pow(forward_.rms(), 2) - std::pow(forward_.mean(), 2)));
  json["com_vertical_drift_cm_per_min"] = vertical_drift_.PerMinute();
  json["com_horizontal_drift_cm_per_min"] = horizontal_drift_.PerMinute();
  json["loads_com_vertical_rms_cm"] = loads_vertical_.rms();
  json["com_vertical_nees"] = nees_ / static_cast<double>(std::max(frames_, std::size_t{1}));
  json["pose_com_vertical_rms_cm"] = pose_vertical_.rms();
  json["pose_com_horizontal_rms_cm"] = pose_horizontal_.rms();
  for (const Spread& axis : posture_) json["posture_com_rms_cm"].push_back(axis.rms());
  for (const Spread& axis : posture_) json["posture_com_bias_cm"].push_back(axis.mean());
  for (const Spread& axis : angular_) json["angular_momentum_error_kgm2ps"].push_back(axis.rms());
}

}  // namespace footing::eval
