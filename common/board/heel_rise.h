#pragma once

namespace footing::board {

/// What a heel rise must exceed.
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

}  // namespace footing::board
