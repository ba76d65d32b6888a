#include "common/statistics/rank_tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace footing::statistics {
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
    // Of the n! / (n_0! ... n_k!) assignments, a table has the product of t! / (c_0! ... c_k!).
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
