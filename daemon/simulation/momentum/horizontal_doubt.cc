#include "daemon/simulation/momentum/horizontal_doubt.h"

#include <algorithm>

namespace footing::momentum {
namespace {

// 1 is what a filter expects of its innovations; C is off by so much per root of what is beyond.
constexpr double kUsualSurprise = 1, kSurpriseM = 0.11;
// A body that travels goes further, slowly and in its rhythm.
constexpr double kSlowFactor = 30, kRhythmicFactor = 3;

}  // namespace

HorizontalPrior Travelling(HorizontalPrior in_place) {
  in_place.slow.spread_m *= kSlowFactor;
  in_place.rhythmic.spread_m *= kRhythmicFactor;
  in_place.spread_factor = 1;
  return in_place;
}

PostureError TravellingPosture() { return {1, 0.10, 1, 0.01}; }

double DoubtOf(const HorizontalCom& in_place, double stepped_m) {
  const double beyond = std::max(in_place.surprise() - kUsualSurprise, 0.0);
  return beyond * kSurpriseM * kSurpriseM + stepped_m * stepped_m;
}

HorizontalCom::Filter::Scalar Weigh(const HorizontalCom::Filter::Scalar& in_place, double doubt_m2,
                                    const HorizontalCom::Filter::Scalar& travelling) {
  const double apart_m = travelling.mean - in_place.mean;
  const double gain = doubt_m2 / (doubt_m2 + travelling.variance);
  return {in_place.mean + gain * apart_m, (1 - gain) * (1 - gain) * (in_place.variance + doubt_m2) +
                                              gain * gain * travelling.variance};
}

}  // namespace footing::momentum
