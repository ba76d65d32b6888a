#include "daemon/offline/learning/person_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace footing::learning {
namespace {

constexpr double kRadiansOfRootMetre = 2.5;  // As in the basis of poses.
constexpr int kMostFolds = 8;
constexpr double kFramesOfRest = 3600;  // The trained covariance counts as a minute of the person.

/// Design of the correction: 1, the scaled features, and the waves of the base, each divided so
/// that the three groups are equally likely to correct by the same amount.
Eigen::MatrixXd DesignOf(const PoseExamples& examples, const reconstruction::PoseRegression& base) {
  const auto count = static_cast<Eigen::Index>(examples.features.size());
  const Eigen::Index features = base.mean.size(), waves = base.phases.size();
  Eigen::MatrixXd design(1 + features + waves, count);
  const double feature_share = 1 / std::sqrt(static_cast<double>(features));
  const double wave_share = std::sqrt(2 / std::max(1.0, static_cast<double>(waves)));
  const Eigen::MatrixXf dense = base.waves.Dense();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd scaled = base.Scaled(examples.features[static_cast<std::size_t>(i)]);
    design(0, i) = 1;
    design.col(i).segment(1, features) = feature_share * scaled;
    if (waves == 0) continue;
    const Eigen::VectorXf waved =
        (dense * scaled.cast<float>() + base.phases).array().cos().matrix();
    design.col(i).tail(waves) = wave_share * waved.cast<double>();
  }
  return design;
}

constexpr std::array kPenalties{1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0};

/// outputs x columns.
Eigen::MatrixXd CorrectionRidge(Eigen::MatrixXd gram, const Eigen::MatrixXd& moment,
                                double penalty) {
  gram.diagonal().array() += penalty;
  return gram.llt().solve(moment.transpose()).transpose();
}

struct PersonPiece {
  Eigen::MatrixXd design, errors, gram, moment;
};

std::vector<PersonPiece> PersonPiecesOf(const Eigen::MatrixXd& design,
                                        const Eigen::MatrixXd& errors,
                                        const std::vector<int>& folds) {
  std::vector<PersonPiece> pieces;
  const int count = std::min(kMostFolds, 1 + *std::max_element(folds.begin(), folds.end()));
  for (int fold = 0; fold < count; ++fold) {
    std::vector<Eigen::Index> columns;
    for (std::size_t i = 0; i < folds.size(); ++i) {
      if (folds[i] % count == fold) columns.push_back(static_cast<Eigen::Index>(i));
    }
    if (columns.empty()) continue;
    PersonPiece piece;
    piece.design = design(Eigen::all, columns);
    piece.errors = errors(Eigen::all, columns);
    piece.gram = piece.design * piece.design.transpose();
    piece.moment = piece.errors * piece.design.transpose();
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Errors of every piece, by a correction that has not seen it; of the first columns of the design.
std::vector<Eigen::MatrixXd> HeldOutErrors(const std::vector<PersonPiece>& pieces,
                                           const Eigen::MatrixXd& gram,
                                           const Eigen::MatrixXd& moment, double penalty) {
  const Eigen::Index columns = gram.cols();
  std::vector<Eigen::MatrixXd> left;
  for (const PersonPiece& piece : pieces) {
    const Eigen::MatrixXd weights =
        CorrectionRidge(gram - piece.gram.topLeftCorner(columns, columns),
                        moment - piece.moment.leftCols(columns), penalty);
    left.push_back(piece.errors - weights * piece.design.topRows(columns));
  }
  return left;
}

double MeanSquareOf(const std::vector<Eigen::MatrixXd>& errors) {
  double sum = 0, count = 0;
  for (const Eigen::MatrixXd& part : errors) {
    sum += part.squaredNorm();
    count += static_cast<double>(part.cols());
  }
  return sum / std::max(count, 1.0);
}

Eigen::VectorXd OutputScale(Eigen::Index dof) {
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(dof);
  scale.head(3).setConstant(kRadiansOfRootMetre);
  return scale;
}

/// Scaled, a column a frame.
Eigen::MatrixXd ErrorsOf(const PoseExamples& examples, const reconstruction::PoseRegression& base) {
  const Eigen::VectorXd scale = OutputScale(base.offset.size());
  Eigen::MatrixXd errors(scale.size(), static_cast<Eigen::Index>(examples.poses.size()));
  auto workspace = base.MakeWorkspace();
  Eigen::VectorXd q(scale.size());
  for (std::size_t i = 0; i < examples.poses.size(); ++i) {
    base.Predict(examples.features[i], workspace, q);
    errors.col(static_cast<Eigen::Index>(i)) = scale.cwiseProduct(examples.poses[i] - q);
  }
  return errors;
}

/// Weights of the design, scaled outputs; and the held-out errors of the choice.
struct ChosenWeights {
  Eigen::MatrixXd weights;
  std::vector<Eigen::MatrixXd> errors;
};

ChosenWeights Choose(const std::vector<PersonPiece>& pieces,
                     const reconstruction::PoseRegression& base, FittedCorrection& fitted) {
  Eigen::MatrixXd gram = pieces.front().gram, moment = pieces.front().moment;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    gram += pieces[i].gram;
    moment += pieces[i].moment;
  }
  ChosenWeights chosen{Eigen::MatrixXd::Zero(moment.rows(), gram.rows()), {}};
  for (const PersonPiece& piece : pieces) chosen.errors.push_back(piece.errors);
  double best = MeanSquareOf(chosen.errors);
  fitted.error_base = std::sqrt(best);
  fitted.penalty = std::numeric_limits<double>::infinity();
  if (pieces.size() < 2) {  // Nothing is left to choose by.
    fitted.error = fitted.error_base;
    return chosen;
  }
  // A constant, then the features with it, then all.
  const Eigen::Index features = base.mean.size();
  for (const Eigen::Index columns : {Eigen::Index{1}, 1 + features, gram.cols()}) {
    const Eigen::MatrixXd part = gram.topLeftCorner(columns, columns);
    const Eigen::MatrixXd part_moment = moment.leftCols(columns);
    for (const double penalty : kPenalties) {
      auto held_out = HeldOutErrors(pieces, part, part_moment, penalty);
      const double square = MeanSquareOf(held_out);
      if (!(square < best)) continue;
      best = square;
      fitted.penalty = penalty;
      chosen.errors = std::move(held_out);
      chosen.weights.setZero();
      chosen.weights.leftCols(columns) = CorrectionRidge(part, part_moment, penalty);
    }
  }
  fitted.error = std::sqrt(best);
  return chosen;
}

/// The covariance of `rest` with that of the person's errors, by their numbers of frames.
void SetRest(const pose::PoseBasis& rest, const std::vector<Eigen::MatrixXd>& errors,
             reconstruction::PersonCorrection& correction) {
  const Eigen::MatrixXd axes = correction.scale.asDiagonal() * rest.modes * rest.sd.asDiagonal();
  Eigen::MatrixXd covariance = kFramesOfRest * axes * axes.transpose();
  double frames = kFramesOfRest;
  for (const Eigen::MatrixXd& part : errors) {
    covariance += part * part.transpose();
    frames += static_cast<double>(part.cols());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance / frames);
  correction.rest_variances = solver.eigenvalues().reverse().cwiseMax(0);
  correction.rest_components = solver.eigenvectors().rowwise().reverse().transpose();
}

}  // namespace

void PersonExamples::Add(const reconstruction::Reconstruction& plain,
                         const Eigen::VectorXd& reference_q, int piece) {
  likely.Add(plain, PoseCues::kMomentum, reference_q, piece);
  posture.Add(plain, PoseCues::kPosture, reference_q, piece);
}

FittedCorrection FitCorrection(const PoseExamples& examples,
                               const reconstruction::PoseRegression& base,
                               const pose::PoseBasis& rest) {
  const auto pieces =
      PersonPiecesOf(DesignOf(examples, base), ErrorsOf(examples, base), examples.folds);
  FittedCorrection fitted;
  const ChosenWeights chosen = Choose(pieces, base, fitted);
  reconstruction::PersonCorrection& correction = fitted.correction;
  correction.scale = OutputScale(base.offset.size());
  const Eigen::MatrixXd weights = correction.scale.cwiseInverse().asDiagonal() * chosen.weights;
  const Eigen::Index features = base.mean.size(), waves = base.phases.size();
  correction.offset = weights.col(0);
  correction.weights = weights.middleCols(1, features) / std::sqrt(static_cast<double>(features));
  if (waves > 0) {
    correction.wave_weights = weights.rightCols(waves) * std::sqrt(2 / static_cast<double>(waves));
  }
  SetRest(rest, chosen.errors, correction);
  return fitted;
}

void AppendTensors(const reconstruction::PersonCorrection& correction, const std::string& prefix,
                   model::Model& model) {
  const auto add = [&](const std::string& name, const Eigen::MatrixXd& rows) {
    std::vector<std::uint32_t> shape{static_cast<std::uint32_t>(rows.rows())};
    if (rows.cols() > 1) shape.push_back(static_cast<std::uint32_t>(rows.cols()));
    model.tensors.push_back(
        {.name = prefix + name, .shape = shape, .values = ToFloats(rows.transpose())});
  };
  add("scale", correction.scale);
  add("regression_offset", correction.offset);
  add("regression_weights", correction.weights);
  if (correction.wave_weights.size() > 0) add("wave_weights", correction.wave_weights);
  add("rest_components", correction.rest_components);
  add("rest_variances", correction.rest_variances);
}

}  // namespace footing::learning
