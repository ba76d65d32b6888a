#include "daemon/offline/eval/sphere_errors.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace footing::eval {

using nlohmann::ordered_json;

void SphereErrors::Add(const sphere::Estimate& found, const Eigen::Vector3d& truth_m) {
  const Eigen::Vector3d error = found.p_C_m - truth_m, along = truth_m.normalized();
  const double depth = error.dot(along);
  confidence_ += found.confidence;
  ++found_;
  // A wrong place is a false sphere, not an error of measurement.
  if (error.norm() > 0.25 * truth_m.norm()) {
    ++wrong_;
    return;
  }
  depth_mm_.push_back(1000 * depth);
  lateral_mm2_ += 1e6 * (error - depth * along).squaredNorm();
  nees_ += error.dot(found.covariance_m2.ldlt().solve(error)) / 3;
  const double variance_m2 = along.dot(found.covariance_m2 * along);
  depth_nees_ += depth * depth / variance_m2;
  variance_mm2_ += 1e6 * variance_m2;
}

ordered_json SphereErrors::Json() const {
  const double count = std::max<double>(1, static_cast<double>(depth_mm_.size()));
  double bias = 0, square = 0, largest = 0;
  for (const double value : depth_mm_) {
    bias += value / count;
    square += value * value / count;
    largest = std::max(largest, std::abs(value));
  }
  return {{"found", found_},
          {"wrong", wrong_},
          {"lateral_rms_mm", std::sqrt(lateral_mm2_ / count)},
          {"depth_bias_mm", bias},
          {"depth_sd_mm", std::sqrt(std::max(0.0, square - bias * bias))},
          {"depth_sd_reported_mm", std::sqrt(variance_mm2_ / count)},
          {"depth_largest_mm", largest},
          {"nees", nees_ / count},
          {"nees_depth", depth_nees_ / count},
          {"confidence_mean", confidence_ / std::max(1, found_)}};
}

Result<void> EstimateRows::Open(const std::string& path, const std::string& condition) {
  condition_ = condition;
  if (path.empty()) return {};
  file_.open(path, std::ios::app);
  if (!file_) return Failure("cannot write " + path);
  if (file_.tellp() == 0)
    file_ << "condition,frame,sphere,range_m,found,range_found_m,lateral_mm,depth_mm,depth_sd_mm,"
             "nees,"
             "confidence,seen_share,misfit,residual_share,colour_off,radius_px,saturated\n";
  return {};
}

void EstimateRows::Add(int frame, std::size_t sphere, const std::optional<sphere::Estimate>& found,
                       const std::optional<virtual_camera::Seen>& seen) {
  if (!file_.is_open()) return;
  const sphere::Estimate none, &one = found ? *found : none;
  double lateral_mm = 0, depth_mm = 0, sd_mm = 0, nees = 0;
  if (found && seen) {
    const Eigen::Vector3d error = one.p_C_m - seen->p_C_m, along = seen->p_C_m.normalized();
    depth_mm = 1000 * error.dot(along);
    lateral_mm = 1000 * (error - error.dot(along) * along).norm();
    sd_mm = 1000 * std::sqrt(along.dot(one.covariance_m2 * along));
    nees = error.dot(one.covariance_m2.ldlt().solve(error)) / 3;
  }
  file_ << condition_ << ',' << frame << ',' << sphere << ',' << (seen ? seen->p_C_m.norm() : 0)
        << ',' << found.has_value() << ',' << one.p_C_m.norm() << ',' << lateral_mm << ','
        << depth_mm << ',' << sd_mm << ',' << nees << ',' << one.confidence << ',' << one.seen_share
        << ',' << one.misfit << ',' << one.residual_share << ',' << one.colour_off << ','
        << one.radius_px << ',' << one.is_saturated << '\n';
}

}  // namespace footing::eval
