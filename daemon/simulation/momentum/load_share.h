#pragma once

namespace footing::momentum {

/// How much of a body's weight its cells carry, in the mean of seconds. A body that neither falls
/// nor rises without end has all of it there, in leaps and hops too; less stands on something else,
/// such as the floor beside a board. A plain value.
class LoadShare {
 public:
  /// `share`: load over the T-pose's weight.
  void Advance(double share, double step_s);
  double share() const { return share_; }
  /// False from well outside of what bodies have until well inside of it again.
  bool whole() const { return whole_; }

 private:
  double early_ = 1, share_ = 1;  ///< Smoothed once, and twice.
  bool whole_ = true;
};

}  // namespace footing::momentum
