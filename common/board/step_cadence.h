#pragma once

#include <optional>

namespace footing::board {

/// Borders that a heel rise must exceed.
struct HeelRiseBorders {
  double forward_m = 0;   ///< How far the COP goes towards the toes.
  double overshoot = 0;   ///< By which share of the weight the load exceeds it.
  double together_s = 0;  ///< Both within this time.
  double standing_s = 0;  ///< Time for which both feet were loaded alike before.
};

/// A quick heel rise of a person who stands on both feet: the pressure goes to the toes while the
/// push carries more than the weight. A slow one pushes too little, a bend of the knees moves the
/// pressure too little. A plain value.
class HeelRise {
 public:
  explicit HeelRise(const HeelRiseBorders& borders) : borders_(borders) {}

  /// True when a rise is complete. `load_share`: load over weight. `forward_m`: COP in W.
  /// `even_s`: for how long both feet have been loaded alike. Times must not decrease.
  bool Advance(double time_s, double load_share, double forward_m, double even_s);
  void Reset() { *this = HeelRise(borders_); }

  /// Largest load of the last push, above the weight, as its share.
  double overshoot() const { return peak_ - 1; }

 private:
  HeelRiseBorders borders_;
  bool started_ = false;
  double time_s_ = 0;
  double heels_m_ = 0;       ///< Where the COP is while the heels are down.
  bool down_ = true;         ///< The pressure has been back since the last rise,
  double down_s_ = -1e9;     ///< from this time on.
  double forward_s_ = -1e9;  ///< When the COP was last on the toes ...
  double pushed_s_ = -1e9;   ///< ... and the load above the weight.
  double peak_ = 1;
};

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
  double forward_m = 0;  ///< COP along x of W; 0 where neither foot has one.
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
  /// Frequency of one foot, half the steps a second; meaningful while stepping. A step that takes
  /// longer than those before shows it before its end.
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
