#include "daemon/offline/eval/attitude_trial.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

// How well the mean rate of a rest gives a bias: VQF's figure for a rest.
constexpr double kStillBiasSd = DegreesToRadians(0.03);

double MeanSquare(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Errors of the attitude in W, split into inclination and heading (Laidig et al. 2021, section 4).
class Score {
 public:
  void Add(const Eigen::Matrix3d& R_WS, const Eigen::Quaterniond& truth, double heading_sd_rad,
           double inclination_sd_rad) {
    const Eigen::Quaterniond error = Eigen::Quaterniond(R_WS) * truth.conjugate();
    const double inclination = 2 * std::acos(std::min(1.0, std::hypot(error.w(), error.z())));
    const double heading = 2 * std::atan2(error.z(), error.w());
    if (count_ == 0) {
      first_heading_ = heading;
      first_variance_ = heading_sd_rad * heading_sd_rad;
    }
    const double off = WrapAngle(heading - first_heading_);
    const double variance = heading_sd_rad * heading_sd_rad - first_variance_;
    ++count_;
    squares_ += inclination * inclination;
    most_ = std::max(most_, inclination);
    heading_squares_ += off * off;
    heading_most_ = std::max(heading_most_, std::abs(off));
    last_heading_ = off;
    last_sd_ = std::sqrt(std::max(0.0, variance));
    inclination_ratio_ += inclination * inclination / (2 * inclination_sd_rad * inclination_sd_rad);
  }

  ordered_json Json() const {
    return {{"scored", count_},
            {"inclination_rmse_deg", RadiansToDegrees(std::sqrt(MeanSquare(squares_, count_)))},
            {"inclination_max_deg", RadiansToDegrees(most_)},
            {"inclination_nees", MeanSquare(inclination_ratio_, count_)},
            {"heading_rmse_deg", RadiansToDegrees(std::sqrt(MeanSquare(heading_squares_, count_)))},
            {"heading_max_deg", RadiansToDegrees(heading_most_)},
            {"heading_end_deg", RadiansToDegrees(last_heading_)},
            {"heading_end_sd_deg", RadiansToDegrees(last_sd_)}};
  }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0;
  double squares_ = 0, most_ = 0, inclination_ratio_ = 0;
  double first_heading_ = 0, first_variance_ = 0, last_heading_ = 0, last_sd_ = 0;
  double heading_squares_ = 0, heading_most_ = 0;
};

void Start(const std::vector<ImuSample>& samples, const AttitudeTrialOptions& options,
           arms::AttitudeFilter& filter) {
  const auto count = std::clamp<std::size_t>(
      static_cast<std::size_t>(options.still_s * options.rate_hz), 1, samples.size());
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    force += samples[i].reading.specific_force_S_mps2;
    turn += samples[i].reading.angular_velocity_S_radps;
  }
  if (force.norm() == 0) force = Eigen::Vector3d::UnitZ();
  filter.Start(force / static_cast<double>(count), turn / static_cast<double>(count), kStillBiasSd);
}

}  // namespace

ordered_json RunAttitudeTrial(const std::vector<ImuSample>& samples,
                              const AttitudeTrialOptions& options) {
  arms::AttitudeFilter filter(options.filter);
  Start(samples, options, filter);
  Score score;
  std::size_t clipped = 0;
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    filter.Advance(samples[i].reading, 1 / options.rate_hz);
    clipped += samples[i].reading.clipped ? 1 : 0;
    const double heading_sd = filter.heading_sd_rad(), inclination_sd = filter.inclination_sd_rad();
    if (samples[i].truth && samples[i].scored)
      score.Add(filter.R_WS(), *samples[i].truth, heading_sd, inclination_sd);
    if (!options.rows) continue;
    const Eigen::Quaterniond q(filter.R_WS());
    rows.push_back({{"t_s", static_cast<double>(i) / options.rate_hz},
                    {"qw", q.w()},
                    {"qx", q.x()},
                    {"qy", q.y()},
                    {"qz", q.z()},
                    {"heading_sd_rad", heading_sd},
                    {"inclination_sd_rad", inclination_sd}});
  }
  ordered_json json = {{"samples", samples.size()},
                       {"rate_hz", options.rate_hz},
                       {"clipped_share", MeanSquare(static_cast<double>(clipped), samples.size())}};
  if (score.count() > 0) json.update(score.Json());
  if (options.rows) json["rows"] = std::move(rows);
  return json;
}

}  // namespace footing::eval
