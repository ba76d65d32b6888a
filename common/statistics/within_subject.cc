#include "common/statistics/within_subject.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/statistics/moments.h"
#include "common/statistics/ranks.h"
#include "common/statistics/special.h"

namespace footing::statistics {
namespace {

using Rows = std::vector<std::vector<double>>;
/// The evidence in the sums of the columns.
using EvidenceOfSums =
    std::function<void(const std::vector<double>& sums, std::vector<double>& evidence)>;

/// The distinct orders of each row, each as likely as the others of its row.
class RowOrders {
 public:
  explicit RowOrders(const Rows& rows) : rows_(rows), sums_(rows.front().size(), 0.0) {
    for (std::vector<double>& row : rows_) std::sort(row.begin(), row.end());
  }

  /// False when there are more than `most`.
  bool RunThrough(std::size_t most, const EvidenceOfSums& evidence_of, const TakeEvidence& take) {
    double count = 1;
    for (const std::vector<double>& row : rows_) count *= CountOrders(row);
    if (count > static_cast<double>(most)) return false;
    probability_ = 1 / count;
    Descend(0, evidence_of, take);
    return true;
  }

 private:
  /// n! over the factorials of the numbers of equal values.
  static double CountOrders(const std::vector<double>& sorted) {
    double count = 1, equal = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      equal = i > 0 && sorted[i] == sorted[i - 1] ? equal + 1 : 1;
      count *= static_cast<double>(i + 1) / equal;
    }
    return count;
  }

  void Descend(std::size_t subject, const EvidenceOfSums& evidence_of, const TakeEvidence& take) {
    if (subject == rows_.size()) {
      evidence_of(sums_, evidence_);
      take(evidence_, probability_);
      return;
    }
    std::vector<double> row = rows_[subject];
    const std::vector<double> before = sums_;
    do {
      for (std::size_t i = 0; i < row.size(); ++i) sums_[i] = before[i] + row[i];
      Descend(subject + 1, evidence_of, take);
    } while (std::next_permutation(row.begin(), row.end()));
    sums_ = before;
  }

  Rows rows_;
  std::vector<double> sums_;
  std::vector<double> evidence_;
  double probability_ = 1;
};

std::vector<double> ColumnSums(const Rows& rows) {
  std::vector<double> sums(rows.front().size(), 0.0);
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) sums[i] += row[i];
  }
  return sums;
}

Result<Relabelled> RelabelRows(const Rows& rows, double tolerance, const Relabelling& relabelling,
                               const EvidenceOfSums& evidence_of) {
  RowOrders orders(rows);
  Rows shuffled = rows;
  std::vector<double> observed, drawn;
  evidence_of(ColumnSums(rows), observed);
  return CompareWithRelabellings(
      observed, tolerance, relabelling,
      [&](std::size_t most, const TakeEvidence& take) {
        return orders.RunThrough(most, evidence_of, take);
      },
      [&](std::mt19937_64& engine) -> const std::vector<double>& {
        for (std::vector<double>& row : shuffled) Shuffle(row, engine);
        evidence_of(ColumnSums(shuffled), drawn);
        return drawn;
      });
}

/// Square distances of rank sums from their mean: all that varies in Friedman's statistic.
double SquareDistances(const std::vector<double>& sums) {
  const double mean = Mean(sums);
  double squares = 0;
  for (const double sum : sums) squares += (sum - mean) * (sum - mean);
  return squares;
}

}  // namespace

Result<MeanDifferences> PermuteWithinSubjects(const Blocks& blocks, Alternative alternative,
                                              const Relabelling& relabelling) {
  FOOTING_CHECK(!blocks.values.empty() && blocks.groups.size() > 1);
  // A subject's own level is the same under all its relabellings.
  Rows rows = blocks.values;
  double widths = 0;
  for (std::vector<double>& row : rows) {
    const auto [least, greatest] = std::minmax_element(row.begin(), row.end());
    widths += *greatest - *least;
    const double level = *least;
    for (double& value : row) value -= level;
  }
  const double n = static_cast<double>(rows.size());
  const auto evidence_of = [&](const std::vector<double>& sums, std::vector<double>& evidence) {
    evidence.clear();
    for (std::size_t i = 1; i < sums.size(); ++i) {
      evidence.push_back(Evidence((sums[i] - sums[0]) / n, alternative));
    }
  };
  constexpr double kRounding = 1e-12;
  auto relabelled = RelabelRows(rows, kRounding * widths / n, relabelling, evidence_of);
  if (!relabelled) return relabelled.error();
  MeanDifferences result;
  result.relabelled = std::move(relabelled).value();
  for (std::size_t i = 1; i < blocks.groups.size(); ++i) {
    result.estimates.push_back(Mean(Differences(blocks, i)));
  }
  return result;
}

Result<Friedman> FriedmanTest(const Blocks& blocks, const Relabelling& relabelling) {
  FOOTING_CHECK(!blocks.values.empty() && blocks.groups.size() > 1);
  Rows ranks;
  double tie_sums = 0;
  for (const std::vector<double>& row : blocks.values) {
    MeanRanks ranked = RankWithTies(row);
    ranks.push_back(std::move(ranked.ranks));
    tie_sums += ranked.tie_sum;
  }
  const std::vector<double> sums = ColumnSums(ranks);
  const double n = static_cast<double>(ranks.size());
  const double groups = static_cast<double>(blocks.groups.size());
  Friedman test;
  test.degrees = groups - 1;
  const double scale = n * groups * (groups + 1) - tie_sums / (groups - 1);
  if (scale > 0.5) test.chi_square = 12 * SquareDistances(sums) / scale;
  test.p = ChiSquareTail(test.chi_square, test.degrees);
  for (std::size_t i = 1; i < sums.size(); ++i) {
    test.many_one_z.push_back((sums[i] - sums[0]) / std::sqrt(n * groups * (groups + 1) / 6));
  }
  constexpr double kBetweenRankSums = 1e-6;  // Their squares differ by far more.
  const auto relabelled =
      RelabelRows(ranks, kBetweenRankSums, relabelling,
                  [](const std::vector<double>& column_sums, std::vector<double>& evidence) {
                    evidence.assign(1, SquareDistances(column_sums));
                  });
  if (!relabelled) return relabelled.error();
  test.relabelled_p = relabelled->rows.front().p;
  return test;
}

std::vector<double> Differences(const Blocks& blocks, std::size_t treatment) {
  std::vector<double> differences;
  for (const std::vector<double>& row : blocks.values) {
    constexpr double kRounding = 4e-16;
    const double size = std::max(std::abs(row[0]), std::abs(row[treatment]));
    const double difference = row[treatment] - row[0];
    differences.push_back(std::abs(difference) <= kRounding * size ? 0 : difference);
  }
  return differences;
}

std::vector<double> Holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double greatest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    greatest = std::max(greatest, p[order[i]] * static_cast<double>(order.size() - i));
    adjusted[order[i]] = std::min(1.0, greatest);
  }
  return adjusted;
}

}  // namespace footing::statistics
