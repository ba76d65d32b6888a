#include "common/camera/disc_fitter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/camera/disc_ring.h"
#include "common/camera/unseen_motion.h"

namespace footing::sphere::disc {
namespace {

constexpr double kGradientSd = 0.15;
constexpr double kLeastGrowthSd = 1e-5;
// A step that promises less of chi² is taken unseen: a tenth of a standard deviation.
constexpr double kLittleGain = 0.01;

State Moved(const State& state, const Right& step) {
  State next = state;
  next.shape += step.head<kShape>();
  next.motion_px += step.segment<2>(kShape);
  next.growth += step[kShape + 2];
  for (std::size_t c = 0; c < 3; ++c) {
    next.inside[c] += step[kLevels + 2 * static_cast<int>(c)];
    next.outside[c] += step[kLevels + 2 * static_cast<int>(c) + 1];
  }
  return next;
}

bool IsSane(const State& next, const State& before) {
  return next.shape.allFinite() && next.shape[2] > 0.4 * before.shape[2] &&
         next.shape[2] < 2.5 * before.shape[2] && next.shape[3] > 0.2 &&
         next.motion_px.allFinite() &&
         (next.shape - before.shape).head<2>().norm() < 2 * before.shape[2];
}

}  // namespace

std::optional<Solution> Fitter::Solve(State state, bool moves, int rounds) {
  if (samples_.size() < 2 * kParameters) return std::nullopt;
  ToBlocks(samples_, blocks_);
  // Along the line of sight a hand is expected to be as fast as along one axis across it.
  growth_sd_ = std::max(kLeastGrowthSd, std::sqrt(0.5) * (scale_.scale() * state.motion_px).norm());
  double cost = 0;
  const auto solved =
      moves ? Descend<kOwnMoving>(state, rounds, cost) : Descend<kOwn>(state, rounds, cost);
  ToSamples(blocks_, samples_);
  if (!solved) return std::nullopt;
  return Report(*solved, cost, moves);
}

template <int kSize>
std::optional<State> Fitter::Descend(State state, int rounds, double& cost) {
  double lambda = 1e-3;
  Equations<kSize> now;
  cost = Evaluate(state, now);
  bool is_current = true;  // The samples are evaluated at the state.
  for (int i = 0; i < rounds; ++i) {
    Normal normal;
    Right right;
    Assemble(state, now, normal, right);
    normal.diagonal() *= 1 + lambda;
    const Right step = normal.ldlt().solve(right);
    const State next = Moved(state, step);
    const double gain = step.dot(right);
    if (is_current && gain < kLittleGain && IsSane(next, state)) {
      state = next;
      cost -= gain;
      break;
    }
    Equations<kSize> then;
    is_current = false;
    const double next_cost = IsSane(next, state) ? Evaluate(next, then) : cost + 1;
    if (!(next_cost <= cost * (1 + 1e-9))) {
      lambda *= 10;
      continue;
    }
    const double moved = (next.shape - state.shape).head<3>().norm() / state.shape[2];
    state = next;
    now = then;
    cost = next_cost;
    is_current = true;
    lambda *= 0.01;
    // The next step would be about the square of this one.
    if (moved < 3e-4) break;
  }
  if (!is_current) cost = Evaluate(state, now);
  Right right;
  Assemble(state, now, normal_, right);
  if (!std::isfinite(cost)) return std::nullopt;
  return state;
}

void Fitter::Evaluate(const State& state) {
  ToBlocks(samples_, blocks_);
  Rows<kOwn> rows;
  for (Block& block : blocks_) ToRows(block, state, settings_.noise, scale_, table_, rows);
  ToSamples(blocks_, samples_);
}

double Fitter::PriorCost(const State& state) const {
  const Profile& profile = settings_.profile;
  const auto square = [](double x) { return x * x; };
  return square((state.shape[3] - profile.blur_px) / profile.blur_sd_px) +
         square((state.shape[4] - profile.limb) / profile.limb_sd) +
         (square(state.shape[5]) + square(state.shape[6])) / square(kGradientSd) +
         state.motion_px.squaredNorm() / square(motion_sd_px_) + square(state.growth / growth_sd_);
}

/// Huber's cost of a state, and its equations.
template <int kSize>
double Fitter::Evaluate(const State& state, Equations<kSize>& equations) {
  equations = Equations<kSize>();
  double cost = PriorCost(state);
  Rows<kSize> rows;
  for (Block& block : blocks_) {
    ToRows(block, state, settings_.noise, scale_, table_, rows);
    equations.Add(rows, block.channel);
    cost += static_cast<double>(rows.cost.sum());
  }
  return cost;
}

template <int kSize>
void Fitter::Assemble(const State& state, const Equations<kSize>& equations, Normal& normal,
                      Right& right) const {
  equations.Assemble(normal, right);
  const Profile& profile = settings_.profile;
  const auto prior = [&](int at, double now, double mean, double sd) {
    normal(at, at) += 1 / (sd * sd);
    right[at] += (mean - now) / (sd * sd);
  };
  prior(3, state.shape[3], profile.blur_px, profile.blur_sd_px);
  prior(4, state.shape[4], profile.limb, profile.limb_sd);
  prior(5, state.shape[5], 0, kGradientSd);
  prior(6, state.shape[6], 0, kGradientSd);
  if constexpr (kSize == kOwnMoving) {
    for (int i = 0; i < 2; ++i) prior(kShape + i, state.motion_px[i], 0, motion_sd_px_);
    prior(kShape + 2, state.growth, 0, growth_sd_);
  }
}

Solution Fitter::Report(const State& state, double cost, bool moves) const {
  Solution solution;
  solution.state = state;
  solution.pixels = samples_.size();
  double square = 0, all = 0, contrast = 0;
  for (const Sample& sample : samples_) {
    const double residual2 = sample.residual * sample.residual;
    square += std::min(residual2, 36.0);
    all += residual2;
    contrast += sample.height * sample.height;
  }
  const double correlation = settings_.noise.correlation;
  const double freedom = std::max(1.0, static_cast<double>(samples_.size()) - kParameters + 4);
  solution.misfit = square / freedom;
  solution.misfit_sds = (solution.misfit - 1) * std::sqrt(0.5 * freedom / correlation);
  solution.excess_chi2 = std::max(0.0, solution.misfit - 1) * freedom / correlation;
  solution.residual_share = std::sqrt(all / std::max(1e-9, contrast));
  const Eigen::LDLT<Normal> solver = normal_.ldlt();
  solution.covariance = correlation * std::max(1.0, solution.misfit) *
                        solver.solve(Normal::Identity().leftCols<3>()).topRows<3>();
  solution.log_evidence =
      -0.5 * cost / correlation - 0.5 * solver.vectorD().array().abs().log().sum();
  // The density of the motion's prior, and what the correlation makes of three more parameters.
  if (moves)
    solution.log_evidence += std::log(correlation / (motion_sd_px_ * motion_sd_px_)) +
                             std::log(std::sqrt(correlation) / growth_sd_);
  return solution;
}

/// Sums over the pixels of four columns: how blur and edge change with twice the angle, as motion
/// makes them, then travel that the rolling shutter shows.
struct Fitter::ScoreSums {
  static constexpr std::size_t kColumns = 4;
  using Square = Eigen::Matrix<double, kColumns, kColumns>;
  Eigen::Matrix<double, kParameters, kColumns> cross =
      Eigen::Matrix<double, kParameters, kColumns>::Zero();
  Square own = Square::Zero();
  Eigen::Matrix<double, kColumns, 1> right = Eigen::Matrix<double, kColumns, 1>::Zero();
};

Fitter::ScoreSums Fitter::SumScore(const State& state) {
  constexpr std::size_t kColumns = ScoreSums::kColumns;
  ScoreSums sums;
  const Eigen::Matrix2f to_px = scale_.scale().inverse().cast<float>();
  const Eigen::Matrix2f to_slopes = scale_.scale().cast<float>();
  const Eigen::Vector2f axis = state.shape.head<2>().cast<float>();
  Rows<kOwn> rows;
  for (Block& block : blocks_) {
    ToRows(block, state, settings_.noise, scale_, table_, rows);
    const Lane s = block.s - axis.x(), t = block.t - axis.y();
    const Lane u = to_px(0, 0) * s + to_px(0, 1) * t, v = to_px(1, 0) * s + to_px(1, 1) * t;
    const Lane per_square = rows.row[3] / (u * u + v * v).max(1e-9F);
    const Lane later = AfterAxis(block, state, scale_);
    const std::array<Lane, kColumns> columns = {
        per_square * (u * u - v * v), per_square * 2 * u * v,
        later * (to_slopes(0, 0) * rows.row[0] + to_slopes(1, 0) * rows.row[1]),
        later * (to_slopes(0, 1) * rows.row[0] + to_slopes(1, 1) * rows.row[1])};
    const Lane weight = (block.beyond.abs() <= 3).select(rows.weight, 0.0F);
    for (std::size_t c = 0; c < kColumns; ++c) {
      const auto column = static_cast<int>(c);
      const Lane weighted = weight * columns[c];
      const auto sum = [&weighted](const Lane& lane) {
        return static_cast<double>((weighted * lane).sum());
      };
      sums.right[column] += sum(rows.off);
      for (int i = 0; i < kShape; ++i) sums.cross(i, column) += sum(rows.row[std::size_t(i)]);
      for (int i = 0; i < 2; ++i) {
        sums.cross(kLevels + 2 * int(block.channel) + i, column) +=
            sum(rows.row[std::size_t(kShape + i)]);
      }
      for (std::size_t k = 0; k < kColumns; ++k) sums.own(int(k), column) += sum(columns[k]);
    }
  }
  return sums;
}

MotionScore Fitter::ScoreMotion(const State& state) {
  using Square = ScoreSums::Square;
  ScoreSums sums = SumScore(state);
  const Eigen::LDLT<Normal> solver = normal_.ldlt();
  const Eigen::Matrix<double, kParameters, ScoreSums::kColumns> gain = solver.solve(sums.cross);
  sums.own -= sums.cross.transpose() * gain;
  const Eigen::LDLT<Square> own = sums.own.ldlt();
  const Eigen::Vector4d change = own.solve(sums.right);
  MotionScore score;
  score.chi2 = sums.right.dot(change) / settings_.noise.correlation;
  // Motion adds (motion . unit)² / 12 to the square of the blur: half of it is even.
  const double size = std::hypot(change[0], change[1]);
  const double angle = 0.5 * std::atan2(change[1], change[0]);
  score.motion_px =
      std::sqrt(48 * state.shape[3] * size) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  const double blur_sd_px = settings_.profile.blur_sd_px;
  const Eigen::Vector3d per_blur =
      solver.solve(Normal::Identity().col(3)).head<3>() / (blur_sd_px * blur_sd_px);
  score.unseen = UnseenMotion({change, sums.own / settings_.noise.correlation, state.shape[3],
                               per_blur, gain.topRightCorner<3, 2>()},
                              motion_sd_px_);
  if (!score.unseen.allFinite()) score.unseen.setZero();  // Too few pixels for a score.
  return score;
}

Solution Mean(const std::vector<Solution>& modes) {
  Solution mean = *std::max_element(
      modes.begin(), modes.end(),
      [](const Solution& a, const Solution& b) { return a.log_evidence < b.log_evidence; });
  double sum = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d best = mean.state.shape.head<3>();
  for (const Solution& mode : modes) {
    const double weight = std::exp(mode.log_evidence - mean.log_evidence);
    const Eigen::Vector3d off = mode.state.shape.head<3>() - best;
    sum += weight;
    first += weight * off;
    second += weight * (mode.covariance + off * off.transpose());
  }
  first /= sum;
  mean.covariance = second / sum - first * first.transpose();
  mean.state.shape.head<3>() += first;
  return mean;
}

}  // namespace footing::sphere::disc
