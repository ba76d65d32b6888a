#pragma once

#include <vector>

#include "common/sphere/disc_model.h"
#include "common/sphere/settings.h"

namespace footing::sphere::disc {

/// Variance of a pixel's value, DN².
double Variance(const PixelNoise& noise, double value);

/// Sets `behind` of each sample. Where what is behind the sphere is not the same all around, as a
/// coloured thing beyond part of its edge, a sector gets a level of its own, of the ring around it;
/// sectors on a border of two levels are taken out, with their samples at the edge. `beyond` of the
/// samples is used.
void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                std::vector<bool>& sectors);

}  // namespace footing::sphere::disc
