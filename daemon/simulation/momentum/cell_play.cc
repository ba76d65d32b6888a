#include "daemon/simulation/momentum/cell_play.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace footing::momentum {
namespace {

constexpr double kNoiseSpreads = 3;    // A reading within so many deviations of its noise rests.
constexpr double kFlipSpreads = 2;     // A reading that moves by so many is at the end of its play.
constexpr double kMiddleTimeS = 0.08;  // In which the middle is taken for one that rests.

}  // namespace

double VerticalInput::total_n() const { return std::accumulate(load_n.begin(), load_n.end(), 0.0); }

double CellPlay::Advance(const std::array<double, VerticalInput::kGroups>& load_n, double step_s) {
  const double rests_n = kNoiseSpreads * noise_n_;
  double sum = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (!started_) group.reading_n = load_n[i];
    const double moved_n =
        std::clamp(group.reading_n, load_n[i] - rests_n, load_n[i] + rests_n) - group.reading_n;
    group.reading_n += moved_n;
    group.end = moved_n == 0
                    ? group.end * std::exp(-step_s / kMiddleTimeS)
                    : std::clamp(group.end + moved_n / (kFlipSpreads * noise_n_), -1.0, 1.0);
    sum += group.end;
  }
  started_ = true;
  return sum;
}

}  // namespace footing::momentum
