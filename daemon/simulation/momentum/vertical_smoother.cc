#include <Eigen/Cholesky>
#include <algorithm>

#include "daemon/simulation/momentum/vertical_com.h"

namespace footing::momentum {

using VerticalFilter = VerticalCom::Filter;

std::vector<VerticalFilter::Scalar> SmoothVertical(const VerticalConfig& config, double mass_kg,
                                                   double step_s, const VerticalInput& mean,
                                                   const std::vector<VerticalInput>& inputs) {
  if (inputs.empty()) return {};
  struct Step {
    VerticalFilter::Vector x, u;
    VerticalFilter::Matrix p, a;
  };
  VerticalCom com(config, mass_kg, step_s);
  com.Start(mean);
  std::vector<Step> steps;
  steps.reserve(inputs.size());
  for (const VerticalInput& input : inputs) {
    com.Advance(input);
    steps.push_back({com.filter().x(), com.input_shift(), com.filter().p(), com.transition()});
  }
  std::vector<VerticalFilter::Scalar> out(steps.size());
  VerticalFilter::Vector x = steps.back().x;
  VerticalFilter::Matrix p = steps.back().p;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (i + 1 < steps.size()) {
      const Step& next = steps[i + 1];
      const VerticalFilter::Matrix p_ahead = next.a * steps[i].p * next.a.transpose() + com.noise();
      const VerticalFilter::Matrix gain = p_ahead.ldlt().solve(next.a * steps[i].p).transpose();
      x = steps[i].x + gain * (x - (next.a * steps[i].x + next.u));
      p = steps[i].p + gain * (p - p_ahead) * gain.transpose();
    }
    out[i] = {x(0), std::max(0.0, p(0, 0))};
  }
  return out;
}

}  // namespace footing::momentum
