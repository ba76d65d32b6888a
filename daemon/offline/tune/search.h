#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace footing::tune {

/// One iteration of a search, for the plot.
struct HistoryPoint {
  int iteration = 0;
  double objective = 0;  ///< At the present point, on this iteration's trials.
  double best = 0;       ///< Of all points tried on them.
};

/// Everything a search remembers: a plain value, so that it can be kept and gone on with.
struct SearchState {
  int iteration = 0;
  Eigen::VectorXd point;  ///< The answer so far; CMA-ES: the mean.
  double step = 1;        ///< Of the line search; CMA-ES: sigma.
  // CMA-ES alone:
  Eigen::MatrixXd covariance;
  Eigen::VectorXd covariance_path, step_path;
  std::vector<HistoryPoint> history;
};

/// Mean objective of each point. All points of one call meet the same trials (common random
/// numbers); another `batch` means other trials.
using Evaluate = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>& points,
                                                   std::uint64_t batch)>;

/// A search of so many dimensions about 0, with its first `step`.
SearchState StartSearch(int dimensions, double step = 1);

/// One step of steepest descent: the gradient by finite differences of half a unit, then the best
/// of four lengths along it. Nothing better there: stays, and halves the step.
void Descend(SearchState& state, const Evaluate& evaluate);
/// Points one Descend evaluates.
int DescentPoints(int dimensions);

/// One generation of CMA-ES (Hansen, "The CMA Evolution Strategy: A Tutorial", 2016, with its
/// default constants); drawn from `seed` and the iteration.
void Evolve(SearchState& state, const Evaluate& evaluate, std::uint64_t seed);
/// Points one Evolve evaluates: 4 + 3 ln n, and the mean.
int EvolutionPoints(int dimensions);

}  // namespace footing::tune
