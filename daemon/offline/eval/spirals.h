#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "daemon/offline/eval/report.h"
#include "daemon/offline/learning/cascade.h"

namespace footing::eval {

/// How the cascade learns the two spirals: sigmoid outputs, candidates by covariance, no
/// validation.
learning::CascadeOptions SpiralOptions();

/// One training: what came of it, and the part of the points along spirals four times as dense that
/// it puts on the wrong one.
struct SpiralTrial {
  bool solved = false;  ///< Every one of the 194 points within 0.4 of its target.
  int hidden = 0;
  int epochs = 0;
  double wrong_between = 0;
  double seconds = 0;  ///< CPU time of the training.
};
SpiralTrial RunSpiralTrial(const learning::CascadeOptions& options, std::uint64_t seed);

/// Seeds `first` to `first` + `count` - 1; the fields of `footing-eval spirals`.
nlohmann::ordered_json RunSpiralTrials(const learning::CascadeOptions& options, std::uint64_t first,
                                       int count);

/// footing-eval spirals: the trainer of cascades on the field's own test problem.
void AddSpiralsCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
