#include "common/camera/profile_table.h"

#include <Eigen/Core>
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

ProfileValue ProfileTable::At(float beyond, float blur) const {
  ProfileValue value;
  if (beyond >= kReach) return value;
  const float b = std::clamp(blur, kLeastBlur, kLeastBlur + (kBlurs - 1.001F) * kBlurStep);
  if (beyond <= -kReach) {
    const float q = std::clamp(1 + b * beyond, 0.0F, 0.999F);
    const float cosine = std::sqrt(1 - q * q);
    // Blur adds half its variance times the Laplacian.
    const float laplacian = 1 / cosine + 1 / (cosine * cosine * cosine);
    value.disc = 1;
    value.limb = 1 - cosine + 0.5F * b * b * laplacian;
    value.limb_d = b * q / cosine;
    value.limb_blur = beyond * q / cosine + b * laplacian;
    return value;
  }
  const float row = (b - kLeastBlur) * (1 / kBlurStep);
  const float column = (beyond + kReach) * (1 / kDistanceStep);
  const int j = static_cast<int>(row), i = std::min(static_cast<int>(column), kDistances - 2);
  const float p = row - static_cast<float>(j), q = column - static_cast<float>(i);
  // Two nodes side by side: disc and limb of the nearer one, disc and limb of the farther one.
  const Cell* node = cells_.data() + static_cast<std::size_t>(j * kDistances + i);
  const Eigen::Map<const Eigen::Array4f> low(&node[0].disc), high(&node[kDistances].disc);
  const Eigen::Array4f apart = high - low, middle = low + p * apart;
  const Eigen::Array2f along = middle.tail<2>() - middle.head<2>();
  const Eigen::Array2f at = middle.head<2>() + q * along;
  const Eigen::Array2f along_blur = apart.head<2>() + q * (apart.tail<2>() - apart.head<2>());
  value.disc = at[0];
  value.limb = at[1];
  value.disc_d = along[0] * (1 / kDistanceStep);
  value.limb_d = along[1] * (1 / kDistanceStep);
  value.disc_blur = along_blur[0] * (1 / kBlurStep);
  value.limb_blur = along_blur[1] * (1 / kBlurStep);
  return value;
}

}  // namespace footing::sphere
