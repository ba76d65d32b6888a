#include "daemon/offline/bench/pairs.h"

#include <algorithm>

#include "common/base/quantile.h"

namespace footing::bench {

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
  return {name, text::Median(a), text::Median(b), text::Median(ratios), unit};
}

}  // namespace footing::bench
