#pragma once

namespace footing::board {

/// One foot's load and its place.
struct FootLoad {
  double load_n = 0;
  bool cop_valid = false;
  double cop_x_m = 0;  ///< In W: forward.
};

/// Load and COP of both feet together.
struct Stance {
  double load_n = 0;
  double left_share = 0.5;
  double forward_m = 0;  ///< Of the COP, in W; 0 where neither foot has one.
};
Stance StanceOn(const FootLoad& left, const FootLoad& right);

/// The weight of who stands on the boards: the mean load over the last 3 s. The first ones count in
/// full, so that a weight is known at once. A plain value.
class Weight {
 public:
  void Advance(double load_n, double elapsed_s);
  /// The same person goes on after a pause: what comes counts in full again.
  void WeighAgain() { weighed_s_ = 0; }
  double n() const { return weight_n_; }  ///< 0: nobody yet.

 private:
  double weight_n_ = 0;
  double weighed_s_ = 0;  ///< At most 3 s.
};

}  // namespace footing::board
