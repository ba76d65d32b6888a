#include "common/statistics/relabelling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footing::statistics {
namespace {

/// Kahan's sum: millions of equal terms keep all digits.
class Sum {
 public:
  void Add(double term) {
    const double corrected = term - lost_;
    const double next = value_ + corrected;
    lost_ = (next - value_) - corrected;
    value_ = next;
  }
  double value() const { return value_; }

 private:
  double value_ = 0;
  double lost_ = 0;
};

/// Adds to each threshold's sum when the greatest evidence reaches it.
void AddReached(const std::vector<double>& thresholds, double greatest, double weight,
                std::vector<Sum>& sums) {
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    if (greatest >= thresholds[i]) sums[i].Add(weight);
  }
}

double Greatest(const std::vector<double>& evidence) {
  return *std::max_element(evidence.begin(), evidence.end());
}

std::vector<double> Lowered(std::vector<double> values, double by) {
  for (double& value : values) value -= by;
  return values;
}

/// Probabilities from logarithms do not quite sum to 1.
double Share(const Sum& sum, const Sum& total) {
  return std::min(1.0, sum.value() / total.value());
}

std::optional<Relabelled> Exact(const std::vector<double>& observed, double tolerance,
                                std::size_t most, const RunThroughAll& run_through_all) {
  constexpr double kLeast = -std::numeric_limits<double>::infinity();
  const std::size_t count = observed.size();
  const std::vector<double> thresholds = Lowered(observed, tolerance);
  std::vector<Sum> reached(count);
  std::vector<double> strongest(count, kLeast);
  Sum total;
  Relabelled result;
  const bool complete =
      run_through_all(most, [&](const std::vector<double>& evidence, double probability) {
        total.Add(probability);
        ++result.relabellings;
        AddReached(thresholds, Greatest(evidence), probability, reached);
        for (std::size_t i = 0; i < count; ++i) {
          strongest[i] = std::max(strongest[i], evidence[i]);
        }
      });
  if (!complete) return std::nullopt;
  const std::vector<double> ceilings = Lowered(strongest, tolerance);
  std::vector<Sum> at_ceiling(count);
  run_through_all(most, [&](const std::vector<double>& evidence, double probability) {
    AddReached(ceilings, Greatest(evidence), probability, at_ceiling);
  });
  for (std::size_t i = 0; i < count; ++i) {
    result.rows.push_back({Share(reached[i], total), 0, Share(at_ceiling[i], total)});
  }
  return result;
}

/// p = (b + 1) / (B + 1): the observed labels are one more relabelling, so p is never 0 and the
/// test keeps its level.
Relabelled Random(const std::vector<double>& observed, double tolerance,
                  const Relabelling& relabelling, const DrawEvidence& draw) {
  Relabelled result;
  result.method = Method::kPermutation;
  result.relabellings = static_cast<double>(relabelling.permutations);
  const std::vector<double> thresholds = Lowered(observed, tolerance);
  std::vector<Sum> reached(observed.size());
  std::mt19937_64 engine(relabelling.seed);
  for (std::size_t i = 0; i < relabelling.permutations; ++i) {
    AddReached(thresholds, Greatest(draw(engine)), 1, reached);
  }
  for (const Sum& sum : reached) {
    const double p = (sum.value() + 1) / (result.relabellings + 1);
    result.rows.push_back({p, std::sqrt(p * (1 - p) / result.relabellings), 0});
  }
  return result;
}

}  // namespace

Result<Relabelled> CompareWithRelabellings(const std::vector<double>& observed, double tolerance,
                                           const Relabelling& relabelling,
                                           const RunThroughAll& run_through_all,
                                           const DrawEvidence& draw) {
  FOOTING_CHECK(!observed.empty() && relabelling.permutations > 0);
  FOOTING_CHECK(relabelling.method != Method::kAsymptotic);
  if (relabelling.method != Method::kPermutation) {
    const auto exact = Exact(observed, tolerance, relabelling.most_tables, run_through_all);
    if (exact) return *exact;
    if (relabelling.method == Method::kExact) {
      return UsageError("the exact p needs more than " + std::to_string(relabelling.most_tables) +
                        " tables; choose random relabelling (--method permutation)");
    }
  }
  return Random(observed, tolerance, relabelling, draw);
}

std::size_t DrawBelow(std::mt19937_64& engine, std::size_t count) {
  // 53 bits against fewer than 2^32 places: no visible bias.
  return static_cast<std::size_t>(static_cast<double>(engine() >> 11) * 0x1p-53 *
                                  static_cast<double>(count));
}

}  // namespace footing::statistics
