#include <algorithm>
#include <cmath>
#include <vector>

#include "common/statistics/ranks.h"
#include "common/statistics/special.h"
#include "common/statistics/within_subject.h"

namespace footing::statistics {
namespace {

constexpr std::size_t kMostExact = 200;
constexpr std::size_t kExactInR = 50;  // wilcox.test is normal from here on.

/// Sizes that differ by rounding only are tied: 0.3 - 0.1 and 0.2.
MeanRanks RankSizes(std::vector<double> differences) {
  constexpr double kSizeRounding = 1e-12;
  for (double& difference : differences) difference = std::abs(difference);
  return RankWithTies(differences, kSizeRounding);
}

/// P(V <= v) and P(V >= v).
struct BothTails {
  double lower = 1;
  double upper = 1;
};

/// Over all signs of these ranks. Twice a mean rank is a whole number.
BothTails ExactTails(const std::vector<double>& ranks, double v) {
  std::size_t greatest = 0;
  std::vector<std::size_t> doubled;
  for (const double rank : ranks) {
    doubled.push_back(static_cast<std::size_t>(std::lround(2 * rank)));
    greatest += doubled.back();
  }
  std::vector<double> shares(greatest + 1, 0.0);
  shares[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t rank : doubled) {
    reached += rank;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      shares[sum] = shares[sum] / 2 + (sum >= rank ? shares[sum - rank] / 2 : 0);
    }
  }
  const auto observed = static_cast<std::size_t>(std::lround(2 * v));
  BothTails tails{0, 0};
  for (std::size_t sum = 0; sum <= greatest; ++sum) {
    if (sum <= observed) tails.lower += shares[sum];
    if (sum >= observed) tails.upper += shares[sum];
  }
  return tails;
}

double Chosen(const BothTails& tails, Alternative alternative) {
  switch (alternative) {
    case Alternative::kTwoSided:
      return std::min(1.0, 2 * std::min(tails.lower, tails.upper));
    case Alternative::kGreater:
      return std::min(1.0, tails.upper);
    case Alternative::kLess:
      return std::min(1.0, tails.lower);
  }
  return 1;
}

/// With the correction for continuity: v is moved half a rank towards its mean.
double NormalP(double n, double tie_sum, double v, Alternative alternative) {
  const double distance = v - n * (n + 1) / 4;
  const double deviation = std::sqrt(n * (n + 1) * (2 * n + 1) / 24 - tie_sum / 48);
  if (!(deviation > 0)) return 1;
  switch (alternative) {
    case Alternative::kTwoSided: {
      const double step = distance > 0 ? 0.5 : distance < 0 ? -0.5 : 0;
      return std::min(1.0, 2 * NormalTail(std::abs(distance - step) / deviation));
    }
    case Alternative::kGreater:
      return NormalTail((distance - 0.5) / deviation);
    case Alternative::kLess:
      return NormalTail((-distance - 0.5) / deviation);
  }
  return 1;
}

}  // namespace

SignedRanks WilcoxonTest(const std::vector<double>& differences, Alternative alternative) {
  std::vector<double> full;
  for (const double difference : differences) {
    if (difference != 0) full.push_back(difference);
  }
  SignedRanks test;
  if (full.empty()) return test;
  const MeanRanks sizes = RankSizes(full);
  for (std::size_t i = 0; i < full.size(); ++i) {
    if (full[i] > 0) test.v += sizes.ranks[i];
  }
  const double normal_p =
      NormalP(static_cast<double>(full.size()), sizes.tie_sum, test.v, alternative);
  test.exact_p =
      full.size() <= kMostExact ? Chosen(ExactTails(sizes.ranks, test.v), alternative) : normal_p;
  const bool plain = sizes.tie_sum == 0 && full.size() == differences.size();
  test.p = plain && full.size() < kExactInR ? test.exact_p : normal_p;
  return test;
}

}  // namespace footing::statistics
