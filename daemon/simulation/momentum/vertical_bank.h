#pragma once

#include "daemon/simulation/momentum/vertical_com.h"

namespace footing::momentum {

/// For cells whose only error is white noise: the loads are trusted for many seconds.
VerticalConfig TrustingVertical(double arms_hang_m, double cell_noise_n);
/// For cells with gains and slow errors as real boards have them.
VerticalConfig DoubtfulVertical(double arms_hang_m, double cell_noise_n);

/// Two filters of the height side by side, one that trusts the cells and one that doubts them. The
/// one that foresaw the last minute's events better speaks; a trusting filter that lost its way is
/// set right by the doubtful one. A plain value.
class VerticalBank {
 public:
  VerticalBank(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n);

  void Start(const VerticalInput& mean);
  void Advance(const VerticalInput& input);
  void Coast();

  const VerticalCom& chosen() const { return trusts_ ? trusting_ : doubtful_; }
  bool trusts() const { return trusts_; }
  /// Mean and variance, with what the anchor itself may be wrong by in it.
  VerticalCom::Filter::Scalar Height(int lag_steps) const;

 private:
  VerticalCom trusting_;
  VerticalCom doubtful_;
  bool trusts_ = false;
  double adopted_s_ = 0;
  double step_s_;
};

}  // namespace footing::momentum
