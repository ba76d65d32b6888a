#include "daemon/offline/eval/arm_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/units.h"

namespace footing::eval {
namespace {

double RootMeanSquare(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double squares = 0;
  for (std::size_t i = from; i < to; ++i) squares += values[i] * values[i];
  return to > from ? std::sqrt(squares / static_cast<double>(to - from)) : 0;
}

}  // namespace

void ArmScore::Add(const arms::ArmGeometry& geometry, const arms::ArmDirections& estimate,
                   const arms::ArmDirections& truth, const Eigen::Vector3d& hand_m) {
  shoulder_.Add(RadiansToDegrees(arms::ShoulderError(estimate, truth)));
  elbow_.Add(RadiansToDegrees(arms::ElbowError(estimate, truth)));
  cm_.push_back(100 * (geometry.Hand(estimate) - hand_m).norm());
  hand_.Add(cm_.back());
}

nlohmann::ordered_json ArmScore::Json() const {
  const std::size_t half = cm_.size() / 2;
  return {{"shoulder_error_deg", shoulder_.mean()},
          {"elbow_error_deg", elbow_.mean()},
          {"hand_position_rms_cm", hand_.rms()},
          {"hand_position_p95_cm", hand_.Quantile(0.95)},
          {"hand_position_rms_halves_cm",
           {RootMeanSquare(cm_, 0, half), RootMeanSquare(cm_, half, cm_.size())}}};
}

void TurnScore::Add(const Eigen::Matrix3d& estimate, const Eigen::Matrix3d& truth) {
  const double cosine = ((estimate.transpose() * truth).trace() - 1) / 2;
  all_.Add(RadiansToDegrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
  const double level = estimate.row(2).dot(truth.row(2));
  inclination_.Add(RadiansToDegrees(std::acos(std::clamp(level, -1.0, 1.0))));
}

void NeesScore::Add(const arms::ArmEstimate& estimate, const arms::ArmDirections& truth) {
  const auto squares = [](const Eigen::Vector3d& error, const Eigen::Vector3d& sd) {
    return error.cwiseQuotient(sd).squaredNorm();
  };
  nees_.push_back((squares(estimate.directions.upper - truth.upper, estimate.upper_sd) +
                   squares(estimate.directions.hinge - truth.hinge, estimate.hinge_sd) +
                   squares(estimate.directions.forearm - truth.forearm, estimate.forearm_sd)) /
                  arms::kDirections);
}

double NeesScore::mean() const {
  return std::accumulate(nees_.begin(), nees_.end(), 0.0) / static_cast<double>(nees_.size());
}

std::vector<double> NeesScore::Parts(std::size_t count) const {
  std::vector<double> means;
  for (std::size_t part = 0; part < count; ++part) {
    const auto at = [&](std::size_t k) {
      return nees_.begin() + static_cast<std::ptrdiff_t>(k * nees_.size() / count);
    };
    means.push_back(std::accumulate(at(part), at(part + 1), 0.0) /
                    static_cast<double>(at(part + 1) - at(part)));
  }
  return means;
}

}  // namespace footing::eval
