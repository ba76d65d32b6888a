#include "daemon/simulation/reconstruction/options.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::reconstruction {
namespace {

constexpr int kSolverIterations = 2;
constexpr int kPostureIterations = 1;

}  // namespace

int Options::lag_steps() const { return static_cast<int>(std::lround(lag_s * rate_hz)); }

Result<void> CheckOptions(const Options& options) {
  if (!(options.rate_hz >= 20 && options.rate_hz <= 240)) {
    return UsageError("pose: a rate of " + std::to_string(options.rate_hz) +
                      " Hz is outside of 20 to 240");
  }
  const double most_lag_s =
      std::min(0.2, (momentum::HorizontalCom::kSlots - 1) / options.rate_hz) + 1e-9;
  if (!(options.lag_s >= 0 && options.lag_s <= most_lag_s)) {
    return UsageError("pose: a lag of " + std::to_string(1000 * options.lag_s) +
                      " ms is outside of 0 to " + std::to_string(1000 * most_lag_s) +
                      " at this rate");
  }
  if (options.mode == Mode::kPaper && options.lag_s > 0) {
    return UsageError("pose: the paper mode has no lag");
  }
  return {};
}

pose::GaussNewtonOptions BasisSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver;
  solver.iterations = kSolverIterations;
  solver.prior_weight = options.best.prior_weight;
  solver.smooth_weight = options.best.smooth_weight * std::sqrt(options.rate_hz / 60);
  solver.frame_s = options.step_s();
  return solver;
}

pose::GaussNewtonOptions RegressedSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver = BasisSolverOptions(options);
  solver.prior_weight = options.best.regressed_prior_weight;
  solver.smooth_weight = options.best.regressed_smooth_weight * std::sqrt(options.rate_hz / 60);
  return solver;
}

pose::GaussNewtonOptions PostureSolverOptions(const Options& options) {
  pose::GaussNewtonOptions solver = BasisSolverOptions(options);
  solver.iterations = kPostureIterations;
  return solver;
}

}  // namespace footing::reconstruction
