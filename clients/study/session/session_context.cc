#include "clients/study/session/session_context.h"

#include <cmath>
#include <limits>

namespace footing::study {

void HeadingOscillation::Add(double heading_error_rad) {
  if (!upright_) return;
  ++count_;
  const double before = heading_error_rad - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (heading_error_rad - mean_);
}

double HeadingOscillation::StandardDeviation() const {
  if (count_ < 2) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(squares_ / static_cast<double>(count_ - 1));
}

}  // namespace footing::study
