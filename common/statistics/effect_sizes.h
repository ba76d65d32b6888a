#pragma once

#include <vector>

#include "common/statistics/samples.h"

/// How large a difference is, beside whether there is one. `z` is the critical value of the
/// interval: the one of all comparisons together makes the intervals simultaneous.
namespace footing::statistics {

struct EffectSize {
  double estimate = 0;
  Interval interval;
};

/// Hodges-Lehmann: the median of all differences between a treatment's value and a control's. The
/// ends are such differences, too, by the normal approximation of U; an end is open where the
/// groups are too small for it.
EffectSize HodgesLehmann(const std::vector<double>& control, const std::vector<double>& treatment,
                         double z);

/// The median of the means of every two differences, each with itself too, with an interval by the
/// normal approximation of the signed ranks.
EffectSize PairedHodgesLehmann(const std::vector<double>& differences, double z);

/// Cliff's delta: the share of pairs where the treatment's value is greater, less the share where
/// it is smaller. The interval is asymmetric (Feng & Cliff 2004) and stays within [-1, 1].
EffectSize CliffsDelta(const std::vector<double>& control, const std::vector<double>& treatment,
                       double z);

/// The same within subjects: the share of positive differences less that of negative ones.
EffectSize PairedDelta(const std::vector<double>& differences, double z);

}  // namespace footing::statistics
