#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/foot_place.h"

namespace footing::momentum {

/// All that the loads of one frame show before anything is known of the body above the feet.
/// Everything is finite at all times.
struct ContactFrame {
  double time_s = 0;
  bool gap = false;    ///< A source is not valid, or its values are not finite: all else is older.
  bool valid = false;  ///< No gap, and somebody has stood on the cells within the last second.
  std::array<FootEstimate, kFeet> feet{};
  std::array<Pressure, kFeet> pressures{};
  Pressure both;            ///< Pressure of both feet together.
  VerticalInput groups;     ///< The loads by groups of cells.
  bool returned = false;    ///< Somebody stands on the cells, after more than a second of nobody.
  bool landed = false;      ///< A flight has ended.
  bool was_silent = false;  ///< The frame before was a gap.
  double load_share = 1;    ///< As in Estimate, as the next two.
  bool whole_weight = true;
  bool stepped = false;

  /// Middle between the places of both feet.
  Eigen::Vector2d centre_m() const { return 0.5 * (feet[0].p_WF_m + feet[1].p_WF_m).head<2>(); }
};

/// The first step from loads to momentum: feet as places with covariance, who stands on the cells,
/// flights, steps, and the share of the weight. Loads are read here and nowhere after. A plain
/// value that allocates nothing.
class ContactEstimator {
 public:
  ContactEstimator(const Subject& subject, const TPose& pose, double step_s);

  /// One frame, `step_s` after the one before.
  const ContactFrame& Advance(const ContactLoads& loads);
  const ContactFrame& frame() const { return frame_; }

 private:
  void AdvanceFeet(const ContactLoads& loads);
  void WatchFlight(double total_n);
  std::array<double, kFeet> FeetForward() const;

  double weight_n_;
  double step_s_;
  std::array<FootContact, kFeet> contacts_;
  std::array<FootPlace, kFeet> places_;
  LoadShare load_share_;
  StepWatch step_watch_;
  double away_s_ = 0;   ///< Since the feet had load, or the sources were valid.
  double aloft_s_ = 0;  ///< Since the feet had any load.
  ContactFrame frame_;
};

}  // namespace footing::momentum
