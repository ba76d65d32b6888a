#pragma once

#include "common/virtual/users/sight.h"
#include "common/virtual/users/style.h"

namespace footing::study::ranges {

inline constexpr double kPeriodS = 0.01;

/// What a synthetic user does for a while; `amplitude` is a share of the user's own.
struct Act {
  users::Intention wanted;
  double duration_s = 0;
  double amplitude = 1;
};

inline users::Style StyleOf(double tempo, double amplitude) {
  users::Style style;
  style.tempo = tempo;
  style.amplitude = amplitude;
  style.tempo_drift = 0.01;
  return style;
}

}  // namespace footing::study::ranges
