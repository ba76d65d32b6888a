#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "daemon/simulation/momentum/angular_momentum.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::momentum {

struct PaperFootConfig {
  double contact_n = 20;      ///< Less is "zero pressure".
  double zero_after_s = 0.1;  ///< "a noticeable period of zero pressure" (section 4.4).
  double static_mps = 0.05;   ///< COP slower than this for static_after_s is near-static.
  double static_after_s = 0.1;
  double lift_m = 0.15;    ///< Heel and toe rise by so much while the foot is off.
  double landing_s = 0.5;  ///< Interpolation to the new place, which the COP shows as it settles.
};

/// Place of one foot by the paper's rule (section 4.4): it stays where it is until the pressure has
/// been zero for a while; then, and when the COP is near-static, it follows the COP. A plain value.
class PaperFoot {
 public:
  PaperFoot(const PaperFootConfig& config, const Eigen::Vector3d& p_WF_m)
      : config_(config), place_m_(p_WF_m), from_m_(p_WF_m), to_m_(p_WF_m) {}

  void Advance(const Pressure& pressure, double step_s);

  bool contact() const { return contact_; }
  double airborne_s() const { return zero_s_; }
  const Eigen::Vector3d& position_m() const { return place_m_; }

 private:
  void Target(const Eigen::Vector3d& p_m);

  PaperFootConfig config_;
  Eigen::Vector3d place_m_;
  Eigen::Vector3d from_m_;
  Eigen::Vector3d to_m_;
  double since_target_s_ = 1e3;
  bool contact_ = true;
  bool lifted_ = false;
  bool had_cop_ = false;
  double zero_s_ = 0;
  double static_s_ = 0;
  Eigen::Vector3d last_cop_m_ = Eigen::Vector3d::Zero();
};

struct PaperConfig {
  LoadFilter::Config load_filter;
  DecayRule vertical{true, 0.1, 0.1, 0.2};
  DecayRule angular{true, 20, 0, 0.1};
  PaperFootConfig foot;
};

/// The paper's momentum, as it is, drift and all. The horizontal centre of mass is predicted by
/// somebody else (section 4.2: a cascade network); without one the centre of pressure stands in.
/// A plain value.
class PaperEstimator {
 public:
  PaperEstimator(const PaperConfig& config, const Subject& subject, const TPose& pose,
                 double step_s);

  /// One frame. `horizontal_com_m`: c_x and c_y of this time, in W.
  const Estimate& Advance(const ContactLoads& loads,
                          const std::optional<Eigen::Vector2d>& horizontal_com_m);
  const Estimate& estimate() const { return estimate_; }

 private:
  PaperConfig config_;
  TPose pose_;
  double step_s_;
  PaperVertical vertical_;
  AngularMomentum angular_;
  std::array<PaperFoot, kFeet> feet_;
  std::array<LoadFilter, kFeet> loads_;
  std::array<Eigen::Vector2d, 3> com_m_{};  // Horizontal COM of this frame and the two before, W.
  int frames_ = 0;
  Estimate estimate_;
};

}  // namespace footing::momentum
