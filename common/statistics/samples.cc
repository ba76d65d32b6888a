#include "common/statistics/samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/statistics/analysis.h"

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

namespace {

double TieSum(double t) { return t * t * t - t; }

/// The depth-first walk behind RunThroughTables.
class TableWalk {
 public:
  using Take = std::function<void(const RankCounts& counts, double probability)>;

  TableWalk(const RankedLabels& ranked, std::size_t most, const Take& take)
      : class_sizes_(ranked.class_sizes),
        left_(ranked.group_sizes),
        dealt_(ranked.class_sizes.size(), std::vector<std::int64_t>(ranked.group_sizes.size(), 0)),
        counts_(ranked.group_sizes.size()),
        most_(most),
        take_(take) {
    log_factorials_.push_back(0);
    for (std::size_t i = 1; i <= ranked.labels.size(); ++i) {
      log_factorials_.push_back(std::lgamma(static_cast<double>(i) + 1));
    }
  }

  /// At least so many: all assignments over the most that one table can stand for.
  double LogLeastTables(const std::vector<std::size_t>& group_sizes) const {
    double log_tables = 0;
    std::size_t all = 0;
    for (const std::size_t size : group_sizes) {
      log_tables -= log_factorials_[size];
      all += size;
    }
    log_tables += log_factorials_[all];
    for (const std::size_t size : class_sizes_) {
      // t! / (c_0! ... c_k!) is greatest where the c are as equal as can be.
      const std::size_t share = size / group_sizes.size(), rest = size % group_sizes.size();
      log_tables -= log_factorials_[size] -
                    log_factorials_[share] * static_cast<double>(group_sizes.size()) -
                    std::log(static_cast<double>(share + 1)) * static_cast<double>(rest);
    }
    return log_tables;
  }

  bool Run() {
    if (LogLeastTables(left_) > std::log(static_cast<double>(most_)) + 1e-9) return false;
    // A table has the product of t! / (c_0! ... c_k!) of the n! / (n_0! ... n_k!) assignments.
    double log_probability = 0;
    for (const std::size_t size : left_) log_probability += log_factorials_[size];
    std::size_t all = 0;
    for (const std::size_t size : class_sizes_) {
      log_probability += log_factorials_[size];
      all += size;
    }
    return Deal(0, 0, class_sizes_.empty() ? 0 : class_sizes_[0],
                log_probability - log_factorials_[all]);
  }

 private:
  /// Deals `rest` values of a class to `group` and those after it, then the classes after it.
  bool Deal(std::size_t equal, std::size_t group, std::size_t rest, double log_probability) {
    if (group + 1 == left_.size()) {
      if (rest > left_[group]) return true;  // They do not fit.
      return Give(equal, group, rest, rest, log_probability);
    }
    const std::size_t greatest = std::min(rest, left_[group]);
    for (std::size_t given = 0; given <= greatest; ++given) {
      if (!Give(equal, group, given, rest, log_probability)) return false;
    }
    return true;
  }

  bool Give(std::size_t equal, std::size_t group, std::size_t given, std::size_t rest,
            double log_probability) {
    left_[group] -= given;
    dealt_[equal][group] = static_cast<std::int64_t>(given);
    log_probability -= log_factorials_[given];
    bool complete = true;
    if (group + 1 < left_.size()) {
      complete = Deal(equal, group + 1, rest - given, log_probability);
    } else {
      counts_.Add(dealt_[equal]);
      complete = equal + 1 < class_sizes_.size()
                     ? Deal(equal + 1, 0, class_sizes_[equal + 1], log_probability)
                     : TakeTable(log_probability);
      counts_.Remove(dealt_[equal]);
    }
    left_[group] += given;
    return complete;
  }

  bool TakeTable(double log_probability) {
    if (++tables_ > most_) return false;
    take_(counts_, std::exp(log_probability));
    return true;
  }

  const std::vector<std::size_t>& class_sizes_;
  std::vector<std::size_t> left_;  ///< Labels of each group not yet dealt.
  std::vector<std::vector<std::int64_t>> dealt_;
  RankCounts counts_;
  std::vector<double> log_factorials_;
  std::size_t most_;
  std::size_t tables_ = 0;
  const Take& take_;
};

}  // namespace

RankedLabels Rank(const Groups& groups) {
  std::vector<std::pair<double, std::size_t>> all;
  RankedLabels ranked;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    FOOTING_CHECK(!groups[group].values.empty());
    for (const double value : groups[group].values) all.emplace_back(value, group);
    ranked.group_sizes.push_back(groups[group].values.size());
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool equal = i > 0 && all[i].first == all[i - 1].first;
    if (!equal) ranked.class_sizes.push_back(0);
    ++ranked.class_sizes.back();
    ranked.labels.push_back(all[i].second);
  }
  return ranked;
}

void RankCounts::Add(const std::vector<std::int64_t>& of_class) {
  for (std::size_t i = 1; i < below.size(); ++i) {
    twice_u[i] += of_class[i] * (2 * below[0] + of_class[0]);
    tie_sums[i] += TieSum(static_cast<double>(of_class[0] + of_class[i]));
  }
  for (std::size_t i = 0; i < below.size(); ++i) below[i] += of_class[i];
}

void RankCounts::Remove(const std::vector<std::int64_t>& of_class) {
  for (std::size_t i = 0; i < below.size(); ++i) below[i] -= of_class[i];
  for (std::size_t i = 1; i < below.size(); ++i) {
    twice_u[i] -= of_class[i] * (2 * below[0] + of_class[0]);
    tie_sums[i] -= TieSum(static_cast<double>(of_class[0] + of_class[i]));
  }
}

SteelScale::SteelScale(const RankedLabels& ranked, Ties ties) : ties_(ties) {
  for (const std::size_t size : ranked.group_sizes) sizes_.push_back(static_cast<double>(size));
  const double n = static_cast<double>(ranked.labels.size());
  double cubes = 0, squares = 0;
  for (const std::size_t size : ranked.class_sizes) {
    const double t = static_cast<double>(size);
    cubes += TieSum(t);
    squares += t * (t - 1);
  }
  const double psi_squares = (n * (n - 1) - squares) / 4;
  pair_variance_ = psi_squares / (n * (n - 1));
  // The sum of psi over a row of all pairs is the distance of a rank from the mean rank.
  if (n > 2) {
    shared_covariance_ = ((TieSum(n) - cubes) / 12 - psi_squares) / (n * (n - 1) * (n - 2));
  }
}

double SteelScale::JointVariance(std::size_t i) const {
  return sizes_[0] * sizes_[i] *
         (pair_variance_ + (sizes_[0] + sizes_[i] - 2) * shared_covariance_);
}

RankScore SteelScale::Score(std::size_t i, const RankCounts& counts) const {
  RankScore score;
  score.u = static_cast<double>(counts.twice_u[i]) / 2;
  score.mean = sizes_[0] * sizes_[i] / 2;
  const double m = sizes_[0] + sizes_[i];
  const double variance = ties_ == Ties::kJoint ? JointVariance(i)
                                                : sizes_[0] * sizes_[i] / 12 *
                                                      (m + 1 - counts.tie_sums[i] / (m * (m - 1)));
  // With all values equal the exact variance is 0; rounding may leave a little.
  score.deviation = variance > 1e-9 ? std::sqrt(variance) : 0;
  score.z = score.deviation > 0 ? (score.u - score.mean) / score.deviation : 0;
  return score;
}

RankCounts CountLabels(const RankedLabels& ranked, const std::vector<std::size_t>& labels) {
  RankCounts counts(ranked.group_sizes.size());
  std::vector<std::int64_t> of_class(ranked.group_sizes.size());
  std::size_t at = 0;
  for (const std::size_t size : ranked.class_sizes) {
    std::fill(of_class.begin(), of_class.end(), 0);
    for (std::size_t i = 0; i < size; ++i) ++of_class[labels[at++]];
    counts.Add(of_class);
  }
  return counts;
}

bool RunThroughTables(
    const RankedLabels& ranked, std::size_t most,
    const std::function<void(const RankCounts& counts, double probability)>& take) {
  return TableWalk(ranked, most, take).Run();
}

}  // namespace footing::statistics
