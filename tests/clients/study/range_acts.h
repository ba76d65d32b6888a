#pragma once

#include "common/virtual/people/style.h"

namespace footing::study::ranges {

inline constexpr double kPeriodS = 0.01;

inline users::Style StyleOf(double tempo, double amplitude) {
  users::Style style;
  style.tempo = tempo;
  style.amplitude = amplitude;
  style.tempo_drift = 0.01;
  return style;
}

}  // namespace footing::study::ranges
