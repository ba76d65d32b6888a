#pragma once

#include <cmath>
#include <numbers>

namespace footing::arms {

/// A Butterworth low-pass of second order, of vectors or matrices. A value.
template <typename T>
class LowPass {
 public:
  /// At rest at this value.
  void Start(const T& value) { y1_ = y2_ = x1_ = x2_ = value; }

  /// `tau_s`: its step response is that of a critically damped mean over this time; the cutoff is
  /// sqrt(2) / (2 pi tau). `step_s` is far below it.
  const T& Advance(const T& value, double tau_s, double step_s) {
    const double c = std::tan(std::numbers::sqrt2 / (2 * tau_s) * step_s);
    const double d = c * c + std::numbers::sqrt2 * c + 1;
    const double b = c * c / d;
    const double a1 = 2 * (c * c - 1) / d, a2 = (1 - std::numbers::sqrt2 * c + c * c) / d;
    const T y = b * (value + 2 * x1_ + x2_) - a1 * y1_ - a2 * y2_;
    x2_ = x1_;
    x1_ = value;
    y2_ = y1_;
    y1_ = y;
    return y1_;
  }
  const T& value() const { return y1_; }

 private:
  T x1_ = T::Zero(), x2_ = T::Zero(), y1_ = T::Zero(), y2_ = T::Zero();
};

}  // namespace footing::arms
