#pragma once

#include <vector>

#include "common/sphere/disc_fitter.h"

namespace footing::sphere::disc {

/// An explanation of the light.
struct Mode {
  Solution solution;
  bool moves = false;
};

/// Those that are likely, the likeliest last.
void KeepLikely(std::vector<Mode>& modes);

/// Akaike's: each pixel of `all` that is left out has a level of its own, which is a parameter.
double Cost(const Solution& solution, std::size_t all);

/// Some two hundred of them; four pixels of a quad stay together.
std::vector<Sample> Thinned(const std::vector<Sample>& all);

}  // namespace footing::sphere::disc
