#pragma once

#include "common/virtual/devices/random.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// A joint or a limb on its way to where it is wanted: critically damped, so that forces stay
/// finite. Arrives within a tenth after about 4 time constants.
struct Follower {
  double value = 0;
  double rate = 0;

  void Advance(double target, double time_constant_s, double step_s);
};

/// Left and right limb of a rhythmic motion: common tempo with the person's slow drift, a phase
/// between them, and an amplitude that grows from rest. A plain value.
class Rhythm {
 public:
  Rhythm(const Style& style, std::uint64_t seed) : style_(style), random_(seed) {}

  /// How the limbs are to move; frequency of one limb. `together`: in phase, else alternately.
  struct Aim {
    bool moves = false;
    bool together = false;
    double frequency_hz = 1;
    double amplitude = 1;  ///< Share of the motion's own.
  };
  void Advance(const Aim& aim, double step_s);

  /// Cycles since the start, of the left and of the right limb.
  double left_cycles() const { return cycles_; }
  double right_cycles() const { return cycles_ + phase_.value; }
  double left_amplitude() const { return amplitude_.value * (1 + style_.asymmetry); }
  double right_amplitude() const { return amplitude_.value * (1 - style_.asymmetry); }
  /// 0 at rest to 1 in full motion.
  double activity() const { return activity_.value; }
  double frequency_hz() const { return frequency_.value; }

 private:
  Style style_;
  noise::Random random_;
  double cycles_ = 0;
  double drift_ = 0;
  Follower frequency_{1, 0};
  Follower phase_{0.5, 0};  ///< Right minus left, cycles.
  Follower amplitude_;
  Follower activity_;
};

}  // namespace footing::users
