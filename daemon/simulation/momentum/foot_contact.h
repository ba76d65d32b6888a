#pragma once

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::momentum {

struct FootContactConfig {
  double on_n = 20;   ///< Over what the cells read when nobody stands on them.
  double off_n = 12;  ///< Below: the foot is off.
  double tare_time_s = 2;
  double most_tare_n = 10;  ///< An offset above this is a weight, not a drift.
};

/// Whether a foot is on its cells: hysteresis about the cells' own zero, which is tracked while
/// the foot is off. A plain value.
class FootContact {
 public:
  explicit FootContact(const FootContactConfig& config = {}) : config_(config) {}

  /// Total load of the foot's cells. Returns the state after it.
  bool Advance(double total_n, double step_s);

  bool contact() const { return contact_; }
  double since_s() const { return since_s_; }  ///< Time in this state.
  double tare_n() const { return tare_n_; }

 private:
  FootContactConfig config_;
  bool contact_ = false;
  double since_s_ = 0;
  double tare_n_ = 0;
};

}  // namespace footing::momentum
