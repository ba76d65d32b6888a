#pragma once

#include <array>

namespace footing::momentum {

/// Mean and variance of a scalar.
struct Moments {
  double mean = 0;
  double variance = 1;
};

/// A share of a mixture of normal densities.
struct Component {
  double share = 1;
  double mean = 0;
  double spread = 1;  ///< Standard deviation.
};

struct MixtureMoments {
  Moments moments;
  double log_evidence = 0;  ///< Log of the product's integral.
};

/// The first two moments of a normal density times a mixture of two, normalised. Finite for every
/// finite input with positive variances: far from both components the nearer one takes all.
MixtureMoments TimesMixture(const Moments& prior, const std::array<Component, 2>& mixture);

/// The first two moments of a normal density cut off above `limit`. Far above it the mass gathers
/// at the limit.
Moments Below(const Moments& prior, double limit);

}  // namespace footing::momentum
