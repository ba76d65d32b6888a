#include "common/camera/disc_ring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace footing::sphere::disc {
namespace {

constexpr double kRingBlurs = 2.5;  // Farther out there is no light of the sphere.
constexpr double kWidestRange = 8;  // Of one level's noise; ten pixels reach three or four.
constexpr double kLeastApart = 5;   // Deviations; below that, one level for all has less noise.

}  // namespace

double Variance(const PixelNoise& noise, double value) {
  return noise.DarkVariance() + noise.dn_per_electron * std::max(0.0, value);
}

void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                double more_blurs, std::vector<bool>& sectors) {
  const std::size_t count = sectors.size();
  // Values of each sector and channel, one after the other.
  const auto place = [](const Sample& sample) {
    return 3 * static_cast<std::size_t>(sample.sector) + static_cast<std::size_t>(sample.channel);
  };
  const auto is_behind = [&](const Sample& s) { return s.beyond >= kRingBlurs + more_blurs; };
  std::vector<std::size_t> ends(3 * count + 1, 0);
  for (const Sample& sample : samples) ends[place(sample) + 1] += is_behind(sample) ? 1 : 0;
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<double> ring(ends.back()), values;
  std::vector<std::size_t> next = ends;
  for (const Sample& sample : samples)
    if (is_behind(sample)) ring[next[place(sample)]++] = sample.value;
  std::vector<std::array<double, 3>> behind(count);
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t c = 0; c < 3; ++c) {
      values.clear();
      for (const std::size_t turn : {count - 1, count, count + 1}) {
        const std::size_t at = 3 * ((s + turn) % count) + c;
        values.insert(values.end(), ring.begin() + static_cast<std::ptrdiff_t>(ends[at]),
                      ring.begin() + static_cast<std::ptrdiff_t>(ends[at + 1]));
      }
      if (values.empty()) continue;
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      const double range = *most - *least;
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      const double sd = std::sqrt(Variance(noise, *middle));
      if (range > kWidestRange * sd) sectors[s] = false;
      const double apart = *middle - state.outside[c];
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
