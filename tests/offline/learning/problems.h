#pragma once

#include "daemon/offline/learning/mlp.h"

/// The field's test problems.
namespace footing::learning {

/// All patterns of `bits` inputs of +-1/2 -> +1/2 where an odd number of them is up.
Examples Parity(int bits);

/// A smooth function of three inputs with noise: sin(2 a) + b c + 0.3 a^2, inputs uniform within
/// +-1.
Examples Curved(int rows, double noise_sd, std::uint64_t seed);

}  // namespace footing::learning
