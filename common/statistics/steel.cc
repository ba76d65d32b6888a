#include "common/statistics/steel.h"

#include <algorithm>
#include <cmath>

#include "common/statistics/many_to_one.h"
#include "common/statistics/rank_tables.h"

namespace footing::statistics {
namespace {

/// z are equal when they differ by rounding only; the steps between different ones are far greater.
constexpr double kScoreTolerance = 1e-9;

std::vector<RankScore> AllScores(const SteelScale& scale, const RankCounts& counts) {
  std::vector<RankScore> scores;
  for (std::size_t i = 1; i < counts.below.size(); ++i) scores.push_back(scale.Score(i, counts));
  return scores;
}

/// Evidence of z with half a pair taken off.
double CorrectedEvidence(const RankScore& score, Alternative alternative) {
  if (score.deviation == 0) return 0;
  return (Evidence(score.u - score.mean, alternative) - 0.5) / score.deviation;
}

}  // namespace

std::vector<RankScore> SteelScores(const Groups& groups, Ties ties) {
  const RankedLabels ranked = Rank(groups);
  return AllScores(SteelScale(ranked, ties), CountLabels(ranked, ranked.labels));
}

std::vector<double> SteelAsymptotic(const Groups& groups, Alternative alternative,
                                    const SteelLimit& limit) {
  const RankedLabels ranked = Rank(groups);
  const SteelScale scale(ranked, limit.ties);
  const auto scores = AllScores(scale, CountLabels(ranked, ranked.labels));
  ManyToOne family;
  family.two_sided = alternative == Alternative::kTwoSided;
  const double n_0 = static_cast<double>(ranked.group_sizes[0]);
  for (std::size_t i = 1; i < groups.size(); ++i) {
    const double n_i = static_cast<double>(ranked.group_sizes[i]);
    double square = n_i / (n_i + n_0 + (limit.finite_sample ? 1 : 0));
    if (limit.ties == Ties::kJoint && scores[i - 1].deviation > 0) {
      // Cov(U_i, U_j) = n_0 n_i n_j E[psi(1, 2) psi(1, 3)].
      square = n_0 * n_i * n_i * scale.shared_covariance() / scale.JointVariance(i);
    }
    // With n_0 = 1 it can be 1; of two values alone the joint covariance is 0.
    constexpr double kLeast = 1e-12, kGreatest = 1 - 1e-9;
    family.loadings.push_back(std::sqrt(std::clamp(square, kLeast, kGreatest)));
  }
  std::vector<double> p;
  for (const RankScore& score : scores) {
    const double evidence =
        limit.continuity ? CorrectedEvidence(score, alternative) : Evidence(score.z, alternative);
    p.push_back(score.deviation > 0 ? MaxTail(family, evidence) : 1);
  }
  return p;
}

Result<Relabelled> SteelRelabelling(const Groups& groups, Alternative alternative, Ties ties,
                                    const Relabelling& relabelling) {
  const RankedLabels ranked = Rank(groups);
  const SteelScale scale(ranked, ties);
  std::vector<double> evidence(groups.size() - 1);
  const auto evidence_of = [&](const RankCounts& counts) -> const std::vector<double>& {
    for (std::size_t i = 1; i < groups.size(); ++i) {
      evidence[i - 1] = Evidence(scale.Score(i, counts).z, alternative);
    }
    return evidence;
  };
  const RankCounts observed = CountLabels(ranked, ranked.labels);
  const std::vector<double> observed_evidence = evidence_of(observed);
  std::vector<std::size_t> labels = ranked.labels;
  auto result = CompareWithRelabellings(
      observed_evidence, kScoreTolerance, relabelling,
      [&](std::size_t most, const TakeEvidence& take) {
        return RunThroughTables(ranked, most, [&](const RankCounts& counts, double probability) {
          take(evidence_of(counts), probability);
        });
      },
      [&](std::mt19937_64& engine) -> const std::vector<double>& {
        Shuffle(labels, engine);
        return evidence_of(CountLabels(ranked, labels));
      });
  if (!result) return result;
  for (std::size_t i = 1; i < groups.size(); ++i) {
    if (scale.Score(i, observed).deviation == 0) {
      result->rows[i - 1].p = 1;
      result->rows[i - 1].standard_error = 0;
    }
  }
  return result;
}

}  // namespace footing::statistics
