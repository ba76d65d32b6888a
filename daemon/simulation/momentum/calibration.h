#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "daemon/simulation/momentum/cell_play.h"
#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::momentum {

/// Result of a T-pose on the cells (section 6): weight, and where each foot stands.
struct TPose {
  double mass_kg = 0;
  std::array<double, kFeet> load_n{};
  std::array<Eigen::Vector3d, kFeet> p_WP_m{};      ///< Mean centre of pressure of each foot.
  Eigen::Vector3d cop_m = Eigen::Vector3d::Zero();  ///< COP of both feet, W: under the COM.
  VerticalInput mean_loads;
  double cell_noise_n = 0;  ///< Standard deviation of one cell from frame to frame.
};

/// Five seconds of standing still. Restarts, and counts it, when the body moves, a foot has too
/// little load or stands at the edge of its board, or a source is lost. A plain value.
class TPoseCalibration {
 public:
  static constexpr double kSeconds = 5;
  static constexpr double kLeastMassKg = 15;
  static constexpr double kLeastFootShare = 0.2;

  /// Takes the next frame, `step_s` after the one before. True once it is complete; then it stays.
  bool Advance(const ContactLoads& loads, double step_s);

  bool complete() const { return complete_; }
  double progress() const { return complete_ ? 1 : held_s_ / kSeconds; }
  std::uint32_t restarts() const { return restarts_; }
  /// Only when complete.
  const TPose& result() const { return result_; }

 private:
  void Restart();

  bool complete_ = false;
  double held_s_ = 0;
  double frames_ = 0;
  std::uint32_t restarts_ = 0;
  double total_sum_n_ = 0;
  Eigen::Vector3d first_cop_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_sum_nm_ = Eigen::Vector3d::Zero();
  std::array<double, kFeet> load_sum_n_{};
  std::array<Eigen::Vector3d, kFeet> foot_moment_sum_nm_{};
  VerticalInput group_sum_;
  VerticalInput last_;
  double difference_sum_n2_ = 0;
  TPose result_;
};

/// The loads by groups of cells: four of each foot, in the order of its cells. `both`: their
/// pressure.
VerticalInput ToVerticalInput(const ContactLoads& loads, const Pressure& both);

}  // namespace footing::momentum
