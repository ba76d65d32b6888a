#include "common/sphere/profile_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace footing::sphere {
namespace {

/// exp(-x) I0(x), x >= 0: Abramowitz & Stegun 9.8.1 and 9.8.2, errors below 2e-7.
double ScaledBessel(double x) {
  if (x < 3.75) {
    const double t = (x / 3.75) * (x / 3.75);
    const double value =
        1 +
        t * (3.5156229 +
             t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
    return std::exp(-x) * value;
  }
  const double t = 3.75 / x;
  const double value =
      0.39894228 +
      t * (0.01328592 +
           t * (0.00225319 +
                t * (-0.00157565 +
                     t * (0.00916281 +
                          t * (-0.02057706 +
                               t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))));
  return value / std::sqrt(x);
}

struct Discs {
  double disc, limb;
};

/// At distance x from the middle of a unit disc blurred by b: the integral over radius q of
/// L(q) q/b² exp(-(x - q)²/2b²) exp(-z) I0(z), z = x q / b². With q = sin(a) the limb is smooth.
Discs Blurred(double x, double b) {
  const double reach = 6 * b;
  const double low = std::asin(std::clamp(x - reach, 0.0, 1.0));
  const double high = std::asin(std::clamp(x + reach, 0.0, 1.0));
  constexpr int kSteps = 120;  // Even; Simpson's rule.
  const double step = (high - low) / kSteps;
  Discs sum{0, 0};
  if (!(step > 0)) return sum;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = low + i * step, q = std::sin(a), cosine = std::cos(a);
    const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
    const double apart = (x - q) / b;
    const double value = weight * cosine * q / (b * b) * std::exp(-0.5 * apart * apart) *
                         ScaledBessel(x * q / (b * b));
    sum.disc += value;
    sum.limb += value * (1 - cosine);
  }
  return {sum.disc * step / 3, sum.limb * step / 3};
}

}  // namespace

ProfileTable::ProfileTable() {
  cells_.reserve(static_cast<std::size_t>(kBlurs) * kDistances);
  for (int j = 0; j < kBlurs; ++j) {
    const double blur = kLeastBlur + j * kBlurStep;
    for (int i = 0; i < kDistances; ++i) {
      const double x = 1 + blur * (-kReach + i * kDistanceStep);
      // Left of the middle there is nothing to look up; the table goes on as its mirror image.
      const Discs discs = Blurred(std::abs(x), blur);
      cells_.push_back({static_cast<float>(discs.disc), static_cast<float>(discs.limb)});
    }
  }
}

ProfileValue ProfileTable::At(double beyond, double blur) const {
  ProfileValue value;
  if (beyond >= kReach) return value;
  const double b = std::clamp(blur, kLeastBlur, kLeastBlur + (kBlurs - 1.001) * kBlurStep);
  if (beyond <= -kReach) {
    const double q = std::clamp(1 + b * beyond, 0.0, 0.999);
    const double cosine = std::sqrt(1 - q * q);
    // Blur adds half its variance times the Laplacian.
    const double laplacian = 1 / cosine + 1 / (cosine * cosine * cosine);
    value.disc = 1;
    value.limb = 1 - cosine + 0.5 * b * b * laplacian;
    value.limb_d = b * q / cosine;
    value.limb_blur = beyond * q / cosine + b * laplacian;
    return value;
  }
  const double row = (b - kLeastBlur) / kBlurStep, column = (beyond + kReach) / kDistanceStep;
  const int j = static_cast<int>(row), i = std::min(static_cast<int>(column), kDistances - 2);
  const double p = row - j, q = column - i;
  const Cell &a = Node(j, i), &c = Node(j, i + 1), &e = Node(j + 1, i), &g = Node(j + 1, i + 1);
  const auto mix = [](double from, double to, double share) { return from + share * (to - from); };
  value.disc = mix(mix(a.disc, c.disc, q), mix(e.disc, g.disc, q), p);
  value.limb = mix(mix(a.limb, c.limb, q), mix(e.limb, g.limb, q), p);
  value.disc_d = mix(c.disc - a.disc, g.disc - e.disc, p) / kDistanceStep;
  value.limb_d = mix(c.limb - a.limb, g.limb - e.limb, p) / kDistanceStep;
  value.disc_blur = mix(e.disc - a.disc, g.disc - c.disc, q) / kBlurStep;
  value.limb_blur = mix(e.limb - a.limb, g.limb - c.limb, q) / kBlurStep;
  return value;
}

}  // namespace footing::sphere
