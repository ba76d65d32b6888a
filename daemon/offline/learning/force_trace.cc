#include "daemon/offline/learning/force_trace.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"
#include "common/virtual/motion/signal.h"

namespace footing::learning {
namespace {

constexpr double kApartS = 0.25;

/// How long the push around `peak` is over half of what it is there.
double WidthS(const Eigen::VectorXd& total, Eigen::Index peak, double rate_hz) {
  const double half = 1 + 0.5 * (total(peak) - 1);
  Eigen::Index from = peak, to = peak;
  while (from > 0 && total(from - 1) > half) --from;
  while (to + 1 < total.size() && total(to + 1) > half) ++to;
  return static_cast<double>(to - from + 1) / rate_hz;
}

/// A foot that carries nothing shortly before, and where something is measured from then on.
bool ComesDown(const ForceTrace& trace, Eigen::Index peak) {
  const auto before = static_cast<Eigen::Index>(kUnloadedS * trace.rate_hz);
  bool unloaded = false;
  for (Eigen::Index i = std::max<Eigen::Index>(0, peak - before); i <= peak; ++i) {
    if (!trace.valid[static_cast<std::size_t>(i)]) return false;
    unloaded = unloaded || trace.load_n.col(i).minCoeff() < kUnloadedShare * trace.weight_n;
  }
  return unloaded;
}

}  // namespace

Eigen::VectorXd ForceTrace::Total(double cutoff_hz) const {
  FOOTING_CHECK(weight_n > 0);
  const Eigen::MatrixXd total = load_n.colwise().sum() / weight_n;
  return motion::LowPass(total, rate_hz, cutoff_hz).row(0);
}

std::vector<Stomp> FindStomps(const ForceTrace& trace) {
  std::vector<Stomp> stomps;
  if (trace.load_n.cols() < 3) return stomps;
  const Eigen::VectorXd total = trace.Total(kStompCutoffHz);
  for (Eigen::Index i = 1; i + 1 < total.size(); ++i) {
    const bool peak = total(i) > total(i - 1) && total(i) >= total(i + 1);
    if (!peak || total(i) < 1 + kStompOver || !ComesDown(trace, i)) continue;
    if (WidthS(total, i, trace.rate_hz) > kStompLongestS) continue;
    const Stomp stomp{static_cast<double>(i) / trace.rate_hz, total(i) - 1};
    if (!stomps.empty() && stomp.time_s - stomps.back().time_s < kApartS) {
      if (stomp.over > stomps.back().over) stomps.back() = stomp;
    } else {
      stomps.push_back(stomp);
    }
  }
  return stomps;
}

}  // namespace footing::learning
