#include "daemon/offline/learning/candidates.h"

#include <algorithm>
#include <cmath>

namespace footing::learning {
namespace {

/// The next step of one weight. Where the slope still points the way of the last step, the parabola
/// is followed only while it is steep enough; else the step grows by `growth`.
double NextStep(double slope, double last_slope, double last_step,
                const QuickpropOptions& options) {
  const double shrink = options.growth / (1 + options.growth);
  const bool downhill_still = slope * last_step < 0;
  double step = 0;
  if (last_step == 0 || downhill_still) step -= options.epsilon * slope;
  if (last_step == 0) return step;
  const bool beyond = last_step < 0 ? slope >= shrink * last_slope : slope <= shrink * last_slope;
  if (beyond) return step + options.growth * last_step;
  const double most = options.growth * std::abs(last_step);
  const double curvature = last_slope - slope;
  if (curvature == 0) return step + options.growth * last_step;
  return step + std::clamp(last_step * slope / curvature, -most, most);
}

}  // namespace

Quickprop::Quickprop(Eigen::Index rows, Eigen::Index columns, const QuickpropOptions& options)
    : options_(options),
      last_steps_(Eigen::MatrixXd::Zero(rows, columns)),
      last_slopes_(Eigen::MatrixXd::Zero(rows, columns)) {}

void Quickprop::Step(const Eigen::MatrixXd& slopes, Eigen::MatrixXd& weights) {
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    double& weight = weights.data()[i];
    const double slope = slopes.data()[i] + options_.decay * weight;
    const double step = NextStep(slope, last_slopes_.data()[i], last_steps_.data()[i], options_);
    weight += step;
    last_steps_.data()[i] = step;
    last_slopes_.data()[i] = slope;
  }
}

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

namespace {

constexpr double kPrimeOffset = 0.1;

}  // namespace

void SigmoidOutputs::Evaluate(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets) {
  values = Sigmoid((units * weights).array()).matrix();
  errors = ((values - targets).array() * (0.25 - values.array().square() + kPrimeOffset)).matrix();
}

int SigmoidOutputs::Train(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets, double near,
                          const OutputOptions& options) {
  QuickpropOptions scaled = options.quickprop;
  scaled.epsilon /= static_cast<double>(units.rows());
  Quickprop quickprop(weights.rows(), weights.cols(), scaled);
  double last_error = 0;
  int quit = options.patience;
  for (int epoch = 0; epoch < options.epochs_max; ++epoch) {
    Evaluate(units, targets);
    if (Worst(targets) < near) return epoch;
    const double error = errors.squaredNorm();
    if (epoch == 0 || std::abs(error - last_error) > options.change * last_error) {
      last_error = error;
      quit = epoch + options.patience;
    } else if (epoch >= quit) {
      return epoch;
    }
    quickprop.Step(units.transpose() * errors, weights);
  }
  Evaluate(units, targets);
  return options.epochs_max;
}

double SigmoidOutputs::Worst(const Eigen::MatrixXd& targets) const {
  return (values - targets).cwiseAbs().maxCoeff();
}

}  // namespace footing::learning
