#pragma once

#include <vector>

#include "common/camera/disc_rows.h"
#include "common/camera/settings.h"

namespace footing::sphere::disc {

/// Variance of a pixel's value, DN².
double Variance(const PixelNoise& noise, double value);

/// Sets `behind` of each sample. Where what is behind the sphere is not the same all around, as a
/// coloured thing beyond part of its edge, a sector gets a level of its own, of the ring around it;
/// sectors on a border of two levels are taken out, with their samples at the edge. `beyond` of the
/// samples is used. `more_blurs`: how much farther out the ring begins, beyond a sphere's travel.
void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                double more_blurs, std::vector<bool>& sectors);

/// Sectors whose edge is seen, less those beside a hidden part of it: what hides it darkens the
/// edge there too, as far as the blur reaches, which is `beside` sectors. One or two unseen sectors
/// are noise, and hidden by nothing.
std::vector<bool> WithoutBorders(const std::vector<bool>& seen, double beside);

}  // namespace footing::sphere::disc
