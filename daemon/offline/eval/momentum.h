#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/virtual/devices/board_cells.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::eval {

/// A motion file as two boards see it.
struct MomentumOptions {
  std::string motion;    ///< BVH, AMC, TRC or C3D.
  std::string skeleton;  ///< ASF, of an AMC.
  std::optional<double> bvh_unit_m = {};
  double mass_kg = 75;
  double rate_hz = 60;  ///< Rate of the cells and of the estimator.
  double loop_minutes = 0;
  bool unlimited = false;  ///< Boards without an edge.
  double lag_s = 0;
  bool paper = false;
  virtual_sensors::CellErrorConfig errors;
};

/// True load and place of a foot, W.
struct TrueFoot {
  double load_n = 0;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< Middle of the sole.
};

/// Cells' loads in one frame, beside the truth, W.
struct MomentumFrame {
  momentum::ContactLoads loads;
  Eigen::Vector3d com_m;
  Eigen::Vector3d angular_momentum;
  std::array<TrueFoot, momentum::kFeet> feet;
};

/// A person on cells, frame by frame.
struct MomentumScene {
  double rate_hz = 60;
  momentum::Subject subject;
  std::vector<MomentumFrame> frames;  ///< Begins with kCalibrationS in the T-pose.
  double outside_share = 0;           ///< Share of loaded feet whose COP is beyond the sensors.
};

/// Duration of the T-pose; the transition from it takes a second and a half.
inline constexpr double kCalibrationS = 6;

/// Errors name the file and what is wrong in it.
Result<MomentumScene> MakeMomentumScene(const MomentumOptions& options);

/// The offline smoothers over the frames from `start` on, where the T-pose was complete; evaluated
/// from `judged` on. Root mean squares along each axis, cm.
nlohmann::ordered_json OfflineJson(const MomentumScene& scene, const momentum::TPose& pose,
                                   std::size_t start, std::size_t judged);

/// `momentum`: centre of mass, angular momentum and feet from simulated boards under a motion.
void AddMomentumCommand(CLI::App& app, Shared& shared);

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
  Rms first_minute_, last_minute_;  ///< Errors of the COM, vertical.
  double nees_ = 0;                 ///< Summed.
  std::array<Rms, 2> cop_;
  std::array<Rms, 3> angular_error_, angular_true_;
  ContactScore contacts_;
  Rms foot_position_;
};

}  // namespace footing::eval
