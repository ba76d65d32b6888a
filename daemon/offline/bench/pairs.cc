#include "daemon/offline/bench/pairs.h"

#include <algorithm>

namespace footing::bench {

double Quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto index = std::min(
      values.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index),
                   values.end());
  return values[index];
}

Row RunPairs(const std::string& name, const std::string& unit, int pairs,
             const std::function<double()>& ours, const std::function<double()>& baseline) {
  ours();  // The first run of each warms caches and branch predictors and is not counted.
  baseline();
  std::vector<double> a;
  std::vector<double> b;
  std::vector<double> ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    const bool ours_first = pair % 2 == 0;
    if (ours_first) a.push_back(ours());
    b.push_back(baseline());
    if (!ours_first) a.push_back(ours());
    ratios.push_back(b.back() > 0 ? a.back() / b.back() : 0);
  }
  return {name, Quantile(a, 0.5), Quantile(b, 0.5), Quantile(ratios, 0.5), unit};
}

}  // namespace footing::bench
