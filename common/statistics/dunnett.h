#pragma once

#include <vector>

#include "common/base/result.h"
#include "common/statistics/samples.h"

namespace footing::statistics {

/// One treatment against the control.
struct DunnettRow {
  double estimate = 0;        ///< Mean of the treatment less that of the control.
  double standard_error = 0;  ///< Standard error of the estimate, from the pooled deviation.
  double t = 0;               ///< Their ratio; +-greatest double if the error alone is 0.
  double p = 1;               ///< Adjusted for all comparisons (single step).
  Interval interval;          ///< Simultaneous, one-sided for a one-sided alternative.
};

/// Result of Dunnett's test, a row a treatment.
struct Dunnett {
  double degrees = 0;
  double critical = 0;       ///< |t| (one-sided: t) that p = 1 - confidence belongs to.
  bool no_variance = false;  ///< Every value equals its group's mean: t has no meaning.
  std::vector<DunnettRow> rows;
};

/// Dunnett's test (1955) of independent, normal groups of one variance. InvalidData where no group
/// has two values. `confidence` is in (0.5, 1).
Result<Dunnett> DunnettTest(const Groups& groups, Alternative alternative, double confidence);

/// The same with the subject as a block: the deviation is the one that is left when each subject's
/// and each group's mean are removed. InvalidData below two subjects.
Result<Dunnett> BlockDunnettTest(const Blocks& blocks, Alternative alternative, double confidence);

}  // namespace footing::statistics
