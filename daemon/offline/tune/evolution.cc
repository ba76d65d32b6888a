#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/virtual/devices/random.h"
#include "daemon/offline/tune/search.h"

namespace footing::tune {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The tutorial's table 1, for n dimensions.
struct Constants {
  explicit Constants(int dimensions) : n(dimensions) {
    offspring = 4 + static_cast<int>(3 * std::log(n));
    weights.resize(offspring / 2);
    for (int i = 0; i < weights.size(); ++i) {
      weights[i] = std::log((offspring + 1) / 2.0) - std::log(i + 1.0);
    }
    weights /= weights.sum();
    mu = 1 / weights.squaredNorm();
    step_rate = (mu + 2) / (n + mu + 5);
    step_damping = 1 + 2 * std::max(0.0, std::sqrt((mu - 1) / (n + 1)) - 1) + step_rate;
    path_rate = (4 + mu / n) / (n + 4 + 2 * mu / n);
    rank_one = 2 / ((n + 1.3) * (n + 1.3) + mu);
    rank_mu = std::min(1 - rank_one, 2 * (mu - 2 + 1 / mu) / ((n + 2) * (n + 2) + mu));
    expected_norm = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }

  double n;
  int offspring;
  VectorXd weights;
  double mu, step_rate, step_damping, path_rate, rank_one, rank_mu, expected_norm;
};

}  // namespace

int EvolutionPoints(int dimensions) { return Constants(dimensions).offspring + 1; }

void Evolve(SearchState& state, const Evaluate& evaluate, std::uint64_t seed) {
  const Constants c(static_cast<int>(state.point.size()));
  const auto batch = static_cast<std::uint64_t>(state.iteration);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(state.covariance);
  const MatrixXd& B = axes.eigenvectors();
  const VectorXd D = axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt();

  noise::Random random(seed * 6364136223846793005u + batch);
  std::vector<VectorXd> moves, points;
  for (int k = 0; k < c.offspring; ++k) {
    VectorXd z(state.point.size());
    for (double& value : z) value = random.Normal();
    moves.push_back(B * D.asDiagonal() * z);
    points.push_back(state.point + state.step * moves.back());
  }
  points.push_back(state.point);
  const std::vector<double> values = evaluate(points, batch);
  std::vector<std::size_t> order(moves.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });

  VectorXd mean_move = VectorXd::Zero(state.point.size());
  MatrixXd rank_mu = MatrixXd::Zero(state.point.size(), state.point.size());
  for (int i = 0; i < c.weights.size(); ++i) {
    const VectorXd& move = moves[order[static_cast<std::size_t>(i)]];
    mean_move += c.weights[i] * move;
    rank_mu += c.weights[i] * move * move.transpose();
  }
  state.point += state.step * mean_move;
  state.step_path = (1 - c.step_rate) * state.step_path +
                    std::sqrt(c.step_rate * (2 - c.step_rate) * c.mu) *
                        (B * D.cwiseInverse().asDiagonal() * B.transpose() * mean_move);
  const double length = state.step_path.norm();
  const double settled = std::sqrt(1 - std::pow(1 - c.step_rate, 2 * (state.iteration + 1)));
  const double follows = length / settled < (1.4 + 2 / (c.n + 1)) * c.expected_norm ? 1 : 0;
  state.covariance_path = (1 - c.path_rate) * state.covariance_path +
                          follows * std::sqrt(c.path_rate * (2 - c.path_rate) * c.mu) * mean_move;
  const double kept =
      1 - c.rank_one - c.rank_mu + (1 - follows) * c.rank_one * c.path_rate * (2 - c.path_rate);
  state.covariance = kept * state.covariance +
                     c.rank_one * state.covariance_path * state.covariance_path.transpose() +
                     c.rank_mu * rank_mu;
  state.step *= std::exp(c.step_rate / c.step_damping * (length / c.expected_norm - 1));

  state.history.push_back({state.iteration, values.back(), values[order.front()]});
  ++state.iteration;
}

}  // namespace footing::tune
