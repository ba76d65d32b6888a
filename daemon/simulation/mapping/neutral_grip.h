#pragma once

#include <optional>

namespace footing::mapping {

/// How the controllers lie in both hands, rotated about the forearms, while the arms are not
/// twisted. The same rotation of both hands looks like a twist, so it is learned from the person:
/// from arms that hang still before the first stride, since elbows are never quite straight; else
/// from the first strides, which are straight on by definition. From then on it follows slowly
/// while the arms are near it. A plain value.
class NeutralGrip {
 public:
  /// Mean rotation of both hands, left side up, of arms that hang still. Times must not decrease.
  void Hang(double time_s, double rotation_rad);
  /// The same of arms in motion, and the frequency of their swings.
  void Stride(double time_s, double rotation_rad, double frequency_hz);
  /// The arms rest and their rotation is not known: strides that were too few do not count.
  void Rest();
  /// Nothing is known of the hands.
  void Forget() { *this = NeutralGrip(); }
  /// The hands may hold the controllers otherwise now: what the present rest has shown counts, else
  /// what comes.
  void Renew();

  bool known() const { return known_; }
  /// The twist in a rotation, in the same direction; none while the neutral is not known.
  std::optional<double> TwistOf(double rotation_rad) const;

 private:
  void TakeRest();

  /// Mean of readings from a time on.
  struct Block {
    double from_s = 0, sum_rad = 0;
    int count = 0;
  };

  bool known_ = false;
  double neutral_rad_ = 0;
  double seen_s_ = 0;      ///< Length of what the neutral is the mean of.
  double time_s_ = 0;      ///< Of the newest reading.
  bool striding_ = false;  ///< There is a reading of the present strides,
  bool strode_ = false;    ///< or of earlier ones: later rests do not count.
  bool hanging_ = false;
  Block block_;                        ///< The newest part of the present rest;
  std::optional<double> earlier_rad_;  ///< the mean of the one before,
  std::optional<double>
      rest_rad_;  ///< and of the one before that, from before a motion could begin.
};

}  // namespace footing::mapping
