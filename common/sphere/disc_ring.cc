#include "common/sphere/disc_ring.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footing::sphere::disc {
namespace {

constexpr double kRingBlurs = 2.5;  // Farther out there is no light of the sphere.
constexpr double kWidestRange = 8;  // Of one level's noise; ten pixels reach three or four.
constexpr double kLeastApart = 5;   // Deviations; below that, one level for all has less noise.

}  // namespace

double Variance(const PixelNoise& noise, double value) {
  return noise.read_dn * noise.read_dn + 1.0 / 12 + noise.dn_per_electron * std::max(0.0, value);
}

void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                double more_blurs, std::vector<bool>& sectors) {
  const std::size_t count = sectors.size();
  std::vector<std::array<std::vector<double>, 3>> ring(count);
  for (const Sample& sample : samples) {
    if (sample.beyond < kRingBlurs + more_blurs) continue;
    for (const std::size_t turn : {count - 1, count, count + 1}) {
      const std::size_t s = (static_cast<std::size_t>(sample.sector) + turn) % count;
      ring[s][static_cast<std::size_t>(sample.channel)].push_back(sample.value);
    }
  }
  std::vector<std::array<double, 3>> behind(count);
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double>& values = ring[s][c];
      if (values.empty()) continue;
      std::sort(values.begin(), values.end());
      const double median = values[values.size() / 2];
      const double sd = std::sqrt(Variance(noise, median));
      if (values.back() - values.front() > kWidestRange * sd) sectors[s] = false;
      const double apart = median - state.outside[c];
      if (std::abs(apart) > kLeastApart * sd) behind[s][c] = apart;
    }
  }
  for (Sample& sample : samples) {
    const auto s = static_cast<std::size_t>(sample.sector);
    sample.behind = behind[s][static_cast<std::size_t>(sample.channel)];
  }
  std::erase_if(samples, [&](const Sample& sample) {
    return !sectors[static_cast<std::size_t>(sample.sector)] && sample.beyond > -2.5;
  });
}

std::vector<bool> WithoutBorders(const std::vector<bool>& seen, double beside) {
  const auto count = static_cast<int>(seen.size());
  const auto is_seen = [&](int s) { return seen[static_cast<std::size_t>((s + count) % count)]; };
  std::vector<bool> sectors = seen;
  for (int s = 0; s < count; ++s) {
    if (is_seen(s - 1) || is_seen(s) || is_seen(s + 1)) continue;
    for (int i = 1; i <= std::min(count / 2, 1 + static_cast<int>(std::ceil(beside))); ++i) {
      sectors[static_cast<std::size_t>((s + i) % count)] = false;
      sectors[static_cast<std::size_t>((s + count - i) % count)] = false;
    }
  }
  return sectors;
}

}  // namespace footing::sphere::disc
