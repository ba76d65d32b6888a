#include "common/sphere/disc_choice.h"

#include <algorithm>

namespace footing::sphere::disc {

void KeepLikely(std::vector<Mode>& modes) {
  constexpr double kUnlikely = 4;  // In the exponent, of a part of the pixels.
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    return a.solution.log_evidence < b.solution.log_evidence;
  });
  const double most = modes.empty() ? 0 : modes.back().solution.log_evidence;
  std::erase_if(modes,
                [&](const Mode& mode) { return mode.solution.log_evidence < most - kUnlikely; });
}

double Cost(const Solution& solution, std::size_t all) {
  return solution.misfit * static_cast<double>(solution.pixels) +
         2 * static_cast<double>(all - solution.pixels);
}

std::vector<Sample> Thinned(const std::vector<Sample>& all) {
  constexpr std::size_t kSomePixels = 200;
  const std::size_t every = 1 + all.size() / kSomePixels;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 4 % every == 0) some.push_back(all[i]);
  return some;
}

}  // namespace footing::sphere::disc
