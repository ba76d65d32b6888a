#include "daemon/offline/learning/examples.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"
#include "common/virtual/devices/random.h"

namespace footing::learning {

Split SplitInTime(const Examples& all, double fraction) {
  const auto last =
      static_cast<Eigen::Index>(std::floor(fraction * static_cast<double>(all.rows())));
  const Eigen::Index first = all.rows() - last;
  return {.train = {all.inputs.topRows(first), all.targets.topRows(first)},
          .validation = {all.inputs.bottomRows(last), all.targets.bottomRows(last)}};
}

Examples Joined(const std::vector<const Examples*>& parts) {
  FOOTING_CHECK(!parts.empty());
  Eigen::Index rows = 0;
  for (const Examples* part : parts) rows += part->rows();
  Examples all{.inputs = Eigen::MatrixXd(rows, parts.front()->inputs.cols()),
               .targets = Eigen::MatrixXd(rows, parts.front()->targets.cols())};
  Eigen::Index row = 0;
  for (const Examples* part : parts) {
    all.inputs.middleRows(row, part->rows()) = part->inputs;
    all.targets.middleRows(row, part->rows()) = part->targets;
    row += part->rows();
  }
  return all;
}

Examples WithFeedbackNoise(const Examples& examples, const FeedbackNoise& noise,
                           std::uint64_t seed) {
  if (noise.groups.empty()) return examples;
  Examples noisy{.inputs = examples.inputs.replicate(noise.copies, 1),
                 .targets = examples.targets.replicate(noise.copies, 1)};
  noise::Random random(seed);
  for (Eigen::Index row = 0; row < noisy.rows(); ++row) {
    for (const std::vector<Eigen::Index>& group : noise.groups) {
      const double common = noise.common_sd * random.Normal();
      for (const Eigen::Index column : group) {
        noisy.inputs(row, column) += common + noise.own_sd * random.Normal();
      }
    }
  }
  return noisy;
}

}  // namespace footing::learning
