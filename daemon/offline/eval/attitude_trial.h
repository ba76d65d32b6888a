#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/eval/attitude_input.h"

namespace footing::eval {

struct AttitudeTrialOptions {
  double rate_hz = 0;
  double still_s = 2;  ///< The device rests at first: mean force and bias come from there.
  bool rows = true;    ///< With a row a sample.
  arms::AttitudeOptions filter;
};

/// The filter over a recording; the fields of `footing-eval attitude`. Errors are against the truth
/// where there is one and the sample counts; the heading is right at the first such sample.
nlohmann::ordered_json RunAttitudeTrial(const std::vector<ImuSample>& samples,
                                        const AttitudeTrialOptions& options);

}  // namespace footing::eval
