#include "daemon/offline/eval/claims.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/motion/signal.h"
#include "common/virtual/devices/derivative.h"
#include "daemon/simulation/momentum/paper_estimator.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

constexpr double kRunS = 0.05;
constexpr double kLeastSpeedMps = 0.05;
constexpr double kCutoffHz = 6;
constexpr std::array kAccelerationsMps2{0.1, 0.2, 0.35, 0.5};
constexpr std::array kAfterS{1.0, 5.0, 10.0};
constexpr double kOutlierN = 50;
constexpr double kOutlierAtS = 2;  // After the evaluated part begins.

ordered_json ConstantVelocity(const pose_run::PoseRun& simulated, std::size_t start) {
  const auto count = static_cast<Eigen::Index>(simulated.frames.size() - start);
  Eigen::MatrixXd com(3, count);
  for (Eigen::Index i = 0; i < count; ++i)
    com.col(i) = simulated.frames[start + static_cast<std::size_t>(i)].com_m;
  const double rate = simulated.rate_hz;
  const Eigen::MatrixXd smooth = motion::LowPass(com, rate, kCutoffHz);
  const Eigen::MatrixXd velocity = virtual_sensors::Derivative(smooth, rate);
  const Eigen::MatrixXd acceleration = virtual_sensors::Derivative(velocity, rate);
  ordered_json out = {
      {"definition",
       "percent of frames in runs of more than 0.05 s with |v| > 0.05 m/s and |a| under the limit; "
       "COM of the motion, low-passed at 6 Hz"},
      {"seconds", static_cast<double>(count) / rate},
      {"paper_percent", 0.5}};
  for (const double limit : kAccelerationsMps2) {
    out["rows"].push_back(
        {{"acceleration_under_mps2", limit},
         {"vertical_percent", 100 * ConstantVelocityShare(velocity.row(2), acceleration.row(2),
                                                          rate, kLeastSpeedMps, limit, kRunS)},
         {"all_axes_percent", 100 * ConstantVelocityShare(velocity, acceleration, rate,
                                                          kLeastSpeedMps, limit, kRunS)}});
  }
  return out;
}

/// Heights by equation (2) of these loads.
std::vector<double> Heights(const std::vector<double>& loads_n, double mass_kg, double rate_hz,
                            bool decay, std::optional<std::size_t> outlier) {
  momentum::PaperConfig config;
  config.vertical.enabled = decay;
  momentum::PaperVertical vertical(config.vertical, config.load_filter, mass_kg, 0);
  std::vector<double> heights;
  for (std::size_t i = 0; i < loads_n.size(); ++i) {
    vertical.Advance(loads_n[i] + (outlier == i ? kOutlierN : 0), 1 / rate_hz);
    heights.push_back(vertical.height_m());
  }
  return heights;
}

ordered_json Outlier(const std::vector<double>& loads_n, const std::vector<double>& true_m,
                     double mass_kg, double rate_hz) {
  const auto at = static_cast<std::size_t>(kOutlierAtS * rate_hz);
  ordered_json rows = ordered_json::array();
  for (const bool decay : {true, false}) {
    const auto clean = Heights(loads_n, mass_kg, rate_hz, decay, std::nullopt);
    const auto hit = Heights(loads_n, mass_kg, rate_hz, decay, at);
    for (const double after_s : kAfterS) {
      const std::size_t then = at + static_cast<std::size_t>(after_s * rate_hz);
      if (then >= clean.size()) continue;
      rows.push_back({{"decay", decay},
                      {"after_s", after_s},
                      {"drift_cm", 100 * (hit[then] - clean[then])},
                      {"own_error_cm", 100 * (clean[then] - true_m[then] + true_m[0])}});
    }
  }
  return rows;
}

}  // namespace

double ConstantVelocityShare(const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& acceleration,
                             double rate_hz, double least_speed, double most_acceleration,
                             double least_run_s) {
  Eigen::Index counted = 0, run = 0;
  const auto close = [&] {
    if (static_cast<double>(run) / rate_hz > least_run_s) counted += run;
    run = 0;
  };
  for (Eigen::Index i = 0; i < velocity.cols(); ++i) {
    const bool constant =
        velocity.col(i).norm() > least_speed && acceleration.col(i).norm() < most_acceleration;
    if (constant) {
      ++run;
    } else {
      close();
    }
  }
  close();
  return velocity.cols() > 0 ? static_cast<double>(counted) / static_cast<double>(velocity.cols())
                             : 0;
}

ordered_json CheckClaims(const pose_run::PoseRun& simulated) {
  const auto start = static_cast<std::size_t>(pose_run::kStandS * simulated.rate_hz);
  std::vector<double> loads_n, true_m;
  double weight_n = 0;
  for (std::size_t i = 0; i < simulated.frames.size(); ++i) {
    const auto& frame = simulated.frames[i];
    const double total_n = momentum::PressureOf(frame.inputs.loads, 1).total_n;
    if (i < start) weight_n += total_n / static_cast<double>(start);
    if (i < start) continue;
    loads_n.push_back(total_n);
    true_m.push_back(frame.com_m.z());
  }
  const double mass_kg = NewtonsToKilograms(weight_n);
  const std::vector<double> still_n(static_cast<std::size_t>(13 * simulated.rate_hz), weight_n);
  const std::vector<double> still_m(still_n.size(), 0);
  return {{"constant_velocity", ConstantVelocity(simulated, start)},
          {"outlier",
           {{"definition",
             "one frame of 50 N too much; difference of the height by equation (2) from the same "
             "run without it, and that run's own error"},
            {"standing", Outlier(still_n, still_m, mass_kg, simulated.rate_hz)},
            {"in_motion", Outlier(loads_n, true_m, mass_kg, simulated.rate_hz)}}}};
}

}  // namespace footing::eval
