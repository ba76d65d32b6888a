#pragma once

#include <optional>

namespace footing::board {

/// From where on a foot counts as the standing one, and a step as none.
struct StepBorders {
  double stance_above = 0;    ///< Share of the load on a foot above which it alone bears it.
  double longest_step_s = 0;  ///< Without a change of the foot for longer: standing.
};

/// Stepping in place, from the share of the load on the left foot: which foot bears it, how fast
/// they alternate, and to which side the person leans. A plain value.
class StepCadence {
 public:
  explicit StepCadence(const StepBorders& borders) : borders_(borders) {}

  /// Times must not decrease.
  void Advance(double time_s, double left_share);
  void Reset() { *this = StepCadence(borders_); }

  /// Whether the person steps: the feet have taken turns, and the next change is not overdue.
  bool stepping() const { return steps_ >= 2; }
  /// Whether this step takes no longer than those before so far.
  bool on_time() const { return time_s_ - changed_s_ <= step_s_; }
  /// Of one foot, half the steps a second; meaningful while stepping. A step that takes longer than
  /// those before shows it before its end.
  double frequency_hz() const;
  /// The same of the last two steps alone, without the present one.
  double last_frequency_hz() const { return 1 / (2 * step_s_); }
  /// How the load leans to the right, -1 to 1: stepping, its mean over the last two steps;
  /// standing, over 0.4 s. None while a step says nothing yet.
  std::optional<double> lean_right() const;
  /// For how long both feet have been loaded about alike, s.
  double even_s() const { return even_s_; }

 private:
  void ChangeFoot(double time_s, int foot);

  StepBorders borders_;
  bool started_ = false;
  double time_s_ = 0;
  int foot_ = 0;          ///< That bore the load alone last: -1 left, 1 right, 0 none.
  double changed_s_ = 0;  ///< When it began to.
  int steps_ = 0;         ///< Changes of the foot in a row, at most 3.
  double step_s_ = 1;     ///< Mean duration of the last two steps.
  double last_step_s_ = 0;
  double lean_now_s_ = 0, lean_before_s_ = 0;  ///< Integral over this step and the last one.
  double stepping_lean_ = 0;
  double standing_lean_ = 0;
  double both_s_ = 0;  ///< For how long both feet have been loaded at all.
  double even_s_ = 0;
};

}  // namespace footing::board
