#pragma once

#include <array>

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::momentum {

/// Whether a foot has stepped ahead or back, as in a lunge: it stands far from where it stood in
/// the mean of the last seconds. Who moves in place does not do that, and the filters of the
/// horizontal COM know no other bodies. A plain value.
class StepWatch {
 public:
  /// Places of the feet along W's x axis.
  void Start(const std::array<double, kFeet>& forward_m);
  void Advance(const std::array<double, kFeet>& forward_m, double step_s);
  bool stepped() const { return stepped_; }

 private:
  std::array<double, kFeet> mean_m_{};
  bool stepped_ = false;
};

}  // namespace footing::momentum
