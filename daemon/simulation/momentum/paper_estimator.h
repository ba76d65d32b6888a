#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/momentum/angular_momentum.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/paper_foot.h"

namespace footing::momentum {

struct PaperConfig {
  LoadFilter::Config load_filter;
  DecayRule vertical{true, 0.35, 0.02, 0.9};
  DecayRule angular{true, 3.0, 0.05, 0.9};
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
  Subject subject_;
  TPose pose_;
  double step_s_;
  PaperVertical vertical_;
  AngularMomentum angular_;
  std::array<PaperFoot, kFeet> feet_;
  std::array<LoadFilter, kFeet> loads_;
  std::array<Eigen::Vector2d, 3> com_m_{};  // Of this frame and the two before.
  int frames_ = 0;
  Estimate estimate_;
};

}  // namespace footing::momentum
