#include "common/guide/weigh.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr double kQuiet = 0.015;
constexpr double kAgree = 0.03;
constexpr double kAgreeLeastKg = 2;

std::string Kilograms(double mass_kg) {
  const long tenths = std::lround(mass_kg * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10)) + " kg";
}

}  // namespace

Weight Weigh(const std::vector<Load>& boards, std::optional<double> given_kg) {
  Weight weight;
  double total_n = 0;
  double worst_n = 0;  // Boards' swings may be opposite; their sum is the most there can be.
  for (const Load& load : boards) {
    if (load.samples == 0) {
      weight.note = "a board sends no data";
      return weight;
    }
    total_n += load.mean_n;
    worst_n += load.sd_n;
  }
  weight.mass_kg = NewtonsToKilograms(total_n);
  weight.sd_kg = NewtonsToKilograms(worst_n);
  if (weight.mass_kg < kLeastMassKg) {
    weight.note = "nobody is on the boards";
    return weight;
  }
  if (weight.sd_kg > kQuiet * weight.mass_kg) {
    weight.note = "not quiet yet: +-" + Kilograms(weight.sd_kg);
    return weight;
  }
  weight.done = true;
  if (weight.mass_kg > kMostMassKg) {
    weight.note = Kilograms(weight.mass_kg) + " is more than a person: tare the empty boards again";
    return weight;
  }
  weight.passed = true;
  weight.note = Kilograms(weight.mass_kg);
  if (given_kg &&
      std::abs(weight.mass_kg - *given_kg) > std::max(kAgreeLeastKg, kAgree * *given_kg)) {
    weight.passed = false;
    weight.note += " measured, " + Kilograms(*given_kg) +
                   " given: tare the empty boards again, stand with both feet on them";
  }
  return weight;
}

}  // namespace footing::guide
