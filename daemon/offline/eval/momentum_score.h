#pragma once

#include <nlohmann/json.hpp>

#include "daemon/offline/eval/momentum_scene.h"
#include "daemon/offline/analysis/contact_score.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::eval {

/// Root mean square of errors.
class Rms {
 public:
  void Add(double error) {
    sum_ += error * error;
    ++count_;
  }
  double value() const;
  double centimetres() const { return 100 * value(); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

/// Estimates of a scene against the truth, frame by frame.
class MomentumScore {
 public:
  /// The frames from `start` on. The scene is borrowed.
  MomentumScore(const MomentumScene& scene, const momentum::TPose& pose, std::size_t start);

  /// The estimate that came with frame `now`; its COM is that of frame `then`.
  void Add(std::size_t now, std::size_t then, const momentum::Estimate& estimate);

  std::size_t frames() const { return frames_; }
  void WriteTo(nlohmann::ordered_json& out) const;

 private:
  void AddCom(std::size_t now, const momentum::Estimate& estimate, const Eigen::Vector3d& com_m);
  void AddCentreOfPressure(const MomentumFrame& truth);
  void AddAngularMomentum(const MomentumFrame& truth, const momentum::Estimate& estimate);
  void AddFeet(const MomentumFrame& truth, const momentum::Estimate& estimate);

  const MomentumScene& scene_;
  const std::size_t start_;
  const double step_s_;
  /// From the place of the COP at rest to the sole's middle.
  std::array<Eigen::Vector3d, momentum::kFeet> rest_m_;

  std::size_t frames_ = 0;
  bool finite_ = true;
  std::array<Rms, 3> com_;
  Rms first_minute_, last_minute_;  ///< Of the COM, vertical.
  double nees_ = 0;                 ///< Summed.
  std::array<Rms, 2> cop_;
  std::array<Rms, 3> angular_error_, angular_true_;
  ContactScore contacts_;
  Rms foot_position_;
};

}  // namespace footing::eval
