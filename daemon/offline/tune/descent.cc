#include <algorithm>
#include <array>

#include "daemon/offline/tune/search.h"

namespace footing::tune {
namespace {

constexpr double kDifference = 0.5;
constexpr std::array kLengths{0.25, 0.5, 1.0, 2.0};
constexpr double kLongestStep = 4, kShortestStep = 0.05;

}  // namespace

SearchState StartSearch(int dimensions, double step) {
  SearchState state;
  state.step = step;
  state.point = Eigen::VectorXd::Zero(dimensions);
  state.covariance = Eigen::MatrixXd::Identity(dimensions, dimensions);
  state.covariance_path = state.step_path = Eigen::VectorXd::Zero(dimensions);
  return state;
}

int DescentPoints(int dimensions) { return 1 + dimensions + static_cast<int>(kLengths.size()); }

void Descend(SearchState& state, const Evaluate& evaluate) {
  const auto batch = static_cast<std::uint64_t>(state.iteration);
  const Eigen::Index n = state.point.size();
  std::vector<Eigen::VectorXd> points(static_cast<std::size_t>(n) + 1, state.point);
  for (Eigen::Index i = 0; i < n; ++i) points[static_cast<std::size_t>(i) + 1][i] += kDifference;
  const std::vector<double> values = evaluate(points, batch);
  const double here = values[0];
  Eigen::VectorXd downhill(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    downhill[i] = (here - values[static_cast<std::size_t>(i) + 1]) / kDifference;
  }
  double best = here;
  if (downhill.norm() > 0) {
    points.clear();
    for (const double length : kLengths) {
      points.push_back(state.point + length * state.step * downhill.normalized());
    }
    const std::vector<double> along = evaluate(points, batch);
    const auto lowest = std::min_element(along.begin(), along.end()) - along.begin();
    const auto index = static_cast<std::size_t>(lowest);
    if (along[index] < here) {
      best = along[index];
      state.point = points[index];
      state.step = std::clamp(state.step * kLengths[index], kShortestStep, kLongestStep);
    } else {
      state.step = std::max(state.step / 2, kShortestStep);
    }
  }
  state.history.push_back({state.iteration, here, best});
  ++state.iteration;
}

}  // namespace footing::tune
