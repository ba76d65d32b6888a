#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

/// Tests of several treatments against one control: what a study of interfaces asks.
namespace footing::statistics {

/// Of a treatment in relation to the control: different, greater values, or smaller values.
enum class Alternative { kTwoSided, kGreater, kLess };

/// Where p comes from: every relabelling, random ones, or the limit distribution.
enum class Method { kExact, kPermutation, kAsymptotic };

struct Group {
  std::string name;
  std::vector<double> values;  ///< Finite, in any order.
};

/// The control, then at least one treatment; independent samples.
using Groups = std::vector<Group>;

/// One value for each subject in each group: a within-subject design.
struct Blocks {
  std::vector<std::string> groups;          ///< The control first.
  std::vector<std::string> subjects;        ///< One for each row of `values`.
  std::vector<std::vector<double>> values;  ///< Of a subject, in the order of `groups`.
};

/// An end without a bound is infinite.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// How strongly a statistic, 0 where nothing differs, speaks for the alternative.
inline double Evidence(double statistic, Alternative alternative) {
  switch (alternative) {
    case Alternative::kTwoSided:
      return std::abs(statistic);
    case Alternative::kGreater:
      return statistic;
    case Alternative::kLess:
      return -statistic;
  }
  return 0;
}

/// With the end that the alternative leaves open at that of `widest`.
inline Interval Directed(Interval interval, Alternative alternative, const Interval& widest = {}) {
  if (alternative == Alternative::kGreater) interval.high = widest.high;
  if (alternative == Alternative::kLess) interval.low = widest.low;
  return interval;
}

}  // namespace footing::statistics
