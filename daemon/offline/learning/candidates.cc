#include "daemon/offline/learning/candidates.h"

#include <algorithm>
#include <cmath>

namespace footing::learning {
namespace {

/// Rows that stay in the processor's cache from one product to the next.
constexpr Eigen::Index kBlockRows = 256;
/// Standard deviation (of values within +-1/2) under which a unit counts as no news: its output
/// weights would be so large that float32 could not hold the sum.
constexpr double kLeastNews = 3e-3;

template <typename Work>
void ForBlocks(Eigen::Index rows, const Work& work) {
  for (Eigen::Index first = 0; first < rows; first += kBlockRows) {
    work(first, std::min(kBlockRows, rows - first));
  }
}

void ApplySigmoid(Eigen::Ref<Eigen::MatrixXd> values) { values = Sigmoid(values.array()).matrix(); }
void ApplySigmoid(Eigen::Ref<Eigen::MatrixXf> values) {
  values.array() = 0.5f * (0.5f * values.array()).tanh();
}

}  // namespace

Eigen::ArrayXXd Sigmoid(const Eigen::ArrayXXd& x) { return 1 / (1 + (-x).exp()) - 0.5; }

template <typename Scalar>
CandidateTask<Scalar> CandidateTask<Scalar>::Covariance(
    const Eigen::Ref<const Eigen::MatrixXd>& units, const Eigen::MatrixXd& errors) {
  Eigen::MatrixXd centred = errors.rowwise() - errors.colwise().mean();
  const double rms = std::sqrt(centred.squaredNorm() / static_cast<double>(errors.size()));
  if (rms > 0) centred /= rms * static_cast<double>(errors.rows());
  return {.units = units.cast<Scalar>(),
          .basis = Matrix(units.rows(), 0),
          .errors = centred.cast<Scalar>()};
}

template <typename Scalar>
CandidateTask<Scalar> CandidateTask<Scalar>::ErrorReduction(
    const Eigen::Ref<const Eigen::MatrixXd>& units, const Eigen::MatrixXd& errors,
    const Eigen::Ref<const Eigen::MatrixXd>& basis) {
  const double size = errors.norm();
  const Eigen::MatrixXd scaled = size > 0 ? errors / size : errors;
  return {.units = units.cast<Scalar>(),
          .basis = basis.cast<Scalar>(),
          .errors = scaled.cast<Scalar>()};
}

template <typename Scalar>
Scores<Scalar> Score(const CandidateTask<Scalar>& task, const Eigen::MatrixXd& weights) {
  using Matrix = Eigen::MatrixX<Scalar>;
  const Eigen::Index rows = task.units.rows();
  const Matrix scalar_weights = weights.cast<Scalar>();
  Scores<Scalar> result{.values = Matrix(rows, weights.cols()),
                        .rest = {},
                        .correlations = Matrix::Zero(task.errors.cols(), weights.cols()),
                        .sizes = Eigen::RowVectorX<Scalar>::Ones(weights.cols()),
                        .scores = {}};
  Matrix along = Matrix::Zero(task.basis.cols(), weights.cols());
  ForBlocks(rows, [&](Eigen::Index first, Eigen::Index count) {
    auto values = result.values.middleRows(first, count);
    values.noalias() = task.units.middleRows(first, count) * scalar_weights;
    ApplySigmoid(values);
    result.correlations.noalias() += task.errors.middleRows(first, count).transpose() * values;
    if (task.basis.cols() == 0) return;
    along.noalias() += task.basis.middleRows(first, count).transpose() * values;
  });
  if (task.basis.cols() == 0) {
    result.scores = result.correlations.cwiseAbs().colwise().sum();
    return result;
  }
  result.rest = result.values;
  ForBlocks(rows, [&](Eigen::Index first, Eigen::Index count) {
    result.rest.middleRows(first, count).noalias() -= task.basis.middleRows(first, count) * along;
  });
  const auto least = static_cast<Scalar>(static_cast<double>(rows) * kLeastNews * kLeastNews);
  result.sizes = (result.rest.colwise().squaredNorm().array() + least).sqrt();
  result.scores = result.correlations.colwise().norm().cwiseQuotient(result.sizes);
  return result;
}

template <typename Scalar>
Eigen::MatrixXd ScoreGradient(const CandidateTask<Scalar>& task, const Scores<Scalar>& scores) {
  using Matrix = Eigen::MatrixX<Scalar>;
  const bool covariance = task.basis.cols() == 0;
  // dS/dV = E towards + rest away, each candidate's column by its own factors.
  Matrix towards = scores.correlations.cwiseSign();
  Eigen::RowVectorX<Scalar> away = Eigen::RowVectorX<Scalar>::Zero(scores.sizes.size());
  if (!covariance) {
    const Eigen::RowVectorX<Scalar> lengths = scores.correlations.colwise().norm();
    for (Eigen::Index c = 0; c < lengths.size(); ++c) {
      towards.col(c).setZero();
      if (lengths(c) == 0) continue;
      towards.col(c) = scores.correlations.col(c) / (lengths(c) * scores.sizes(c));
      away(c) = -scores.scores(c) / (scores.sizes(c) * scores.sizes(c));
    }
  }
  Matrix gradient = Matrix::Zero(task.units.cols(), towards.cols());
  Matrix back;
  ForBlocks(task.units.rows(), [&](Eigen::Index first, Eigen::Index count) {
    back.noalias() = task.errors.middleRows(first, count) * towards;
    if (!covariance) back += scores.rest.middleRows(first, count) * away.asDiagonal();
    back.array() *= Scalar{0.25} - scores.values.middleRows(first, count).array().square();
    gradient.noalias() += task.units.middleRows(first, count).transpose() * back;
  });
  return gradient.template cast<double>();
}

template <typename Scalar>
NewUnit TrainCandidates(const CandidateTask<Scalar>& task, const CandidateOptions& options,
                        noise::Random& random) {
  Eigen::MatrixXd weights(task.units.cols(), options.pool);
  for (double& weight : weights.reshaped()) {
    weight = random.Uniform(-options.weight_range, options.weight_range);
  }
  Quickprop quickprop(weights.rows(), weights.cols(), options.quickprop);
  double last_best = 0;
  int quit = options.patience;
  int epoch = 0;
  Scores<Scalar> scores = Score(task, weights);
  for (; epoch < options.epochs_max && epoch < quit; ++epoch) {
    quickprop.Step(-ScoreGradient(task, scores), weights);
    scores = Score(task, weights);
    const auto best = static_cast<double>(scores.scores.maxCoeff());
    if (epoch == 0 || std::abs(best - last_best) > options.change * last_best) {
      last_best = best;
      quit = epoch + options.patience;
    }
  }
  Eigen::Index best = 0;
  scores.scores.maxCoeff(&best);
  return {.weights = weights.col(best),
          .values = scores.values.col(best).template cast<double>(),
          .correlations = scores.correlations.col(best).template cast<double>(),
          .epochs = epoch};
}

template struct CandidateTask<double>;
template struct CandidateTask<float>;
template Scores<double> Score(const CandidateTask<double>&, const Eigen::MatrixXd&);
template Scores<float> Score(const CandidateTask<float>&, const Eigen::MatrixXd&);
template Eigen::MatrixXd ScoreGradient(const CandidateTask<double>&, const Scores<double>&);
template Eigen::MatrixXd ScoreGradient(const CandidateTask<float>&, const Scores<float>&);
template NewUnit TrainCandidates(const CandidateTask<double>&, const CandidateOptions&,
                                 noise::Random&);
template NewUnit TrainCandidates(const CandidateTask<float>&, const CandidateOptions&,
                                 noise::Random&);

}  // namespace footing::learning
