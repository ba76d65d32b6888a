#include "daemon/simulation/momentum/calibration.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::momentum {
namespace {

constexpr double kLeastCopLoadN = 20;
constexpr double kWeightBand = 0.04;  // Share of the mean load: breathing and sway stay far below.
constexpr double kCopBandM = 0.04;
constexpr double kSettledS = 0.5;  // After it the mean is good enough to compare with.
constexpr std::size_t kGroupsPerFoot = VerticalInput::kGroups / kFeet;

}  // namespace

VerticalInput ToVerticalInput(const ContactLoads& loads, const Pressure& both) {
  VerticalInput input;
  for (std::size_t f = 0; f < kFeet; ++f) {
    const FootLoads& foot = loads.feet[f];
    if (!foot.valid) continue;
    for (std::size_t i = 0; i < foot.count; ++i)
      input.load_n[f * kGroupsPerFoot + i * kGroupsPerFoot / foot.count] += foot.cells[i].load_n;
  }
  input.cop_valid = both.cop_valid;
  input.cop_m = both.p_WP_m.head<2>();
  return input;
}

void TPoseCalibration::Restart() {
  const std::uint32_t restarts = restarts_ + (frames_ > 0 ? 1 : 0);
  *this = TPoseCalibration();
  restarts_ = restarts;
}

bool TPoseCalibration::Advance(const ContactLoads& loads, double step_s) {
  if (complete_) return true;
  const Pressure both = PressureOf(loads, kLeastCopLoadN);
  const std::array<Pressure, kFeet> feet{PressureOf(loads.feet[0], kLeastCopLoadN),
                                         PressureOf(loads.feet[1], kLeastCopLoadN)};
  bool good = IsFinite(loads) && both.total_n > KilogramsToNewtons(kLeastMassKg);
  for (std::size_t f = 0; f < kFeet; ++f)
    good = good && loads.feet[f].valid && feet[f].total_n > kLeastFootShare * both.total_n &&
           !AtEdge(loads.feet[f]);
  if (good && held_s_ > kSettledS) {
    const double mean = total_sum_n_ / frames_;
    good = std::abs(both.total_n - mean) < kWeightBand * mean &&
           (both.p_WP_m - first_cop_m_).norm() < kCopBandM;
  }
  if (!good) {
    Restart();
    return false;
  }
  const VerticalInput groups = ToVerticalInput(loads, both);
  if (frames_ == 0) {
    first_cop_m_ = both.p_WP_m;
    foot_moment_sum_nm_.fill(Eigen::Vector3d::Zero());
  } else {
    for (std::size_t i = 0; i < groups.load_n.size(); ++i) {
      const double difference = groups.load_n[i] - last_.load_n[i];
      difference_sum_n2_ += difference * difference;
    }
  }
  last_ = groups;
  frames_ += 1;
  held_s_ += step_s;
  total_sum_n_ += both.total_n;
  moment_sum_nm_ += both.total_n * both.p_WP_m;
  for (std::size_t f = 0; f < kFeet; ++f) {
    load_sum_n_[f] += feet[f].total_n;
    foot_moment_sum_nm_[f] += feet[f].total_n * feet[f].p_WP_m;
  }
  for (std::size_t i = 0; i < groups.load_n.size(); ++i) group_sum_.load_n[i] += groups.load_n[i];
  if (held_s_ < kSeconds) return false;

  complete_ = true;
  result_.mass_kg = NewtonsToKilograms(total_sum_n_ / frames_);
  result_.cop_m = moment_sum_nm_ / total_sum_n_;
  for (std::size_t f = 0; f < kFeet; ++f) {
    result_.load_n[f] = load_sum_n_[f] / frames_;
    result_.p_WP_m[f] = foot_moment_sum_nm_[f] / load_sum_n_[f];
  }
  for (std::size_t i = 0; i < group_sum_.load_n.size(); ++i)
    result_.mean_loads.load_n[i] = group_sum_.load_n[i] / frames_;
  const double differences = 2 * (frames_ - 1) * VerticalInput::kGroups;
  result_.cell_noise_n = std::sqrt(difference_sum_n2_ / differences);
  return true;
}

}  // namespace footing::momentum
