#include "common/camera/disc_fitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace footing::sphere::disc {

std::vector<Sample> Thinned(const std::vector<Sample>& all, std::size_t most) {
  const std::size_t every = 1 + all.size() / most;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 4 % every == 0) some.push_back(all[i]);
  return some;
}

void ToBlocks(const std::vector<Sample>& samples, std::vector<Block>& blocks) {
  blocks.clear();
  std::array<std::size_t, 3> open{};  // Number of the channel's block, and one.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const auto channel = static_cast<std::size_t>(sample.channel);
    if (open[channel] == 0 || blocks[open[channel] - 1].count == kBlock) {
      Block& block = blocks.emplace_back();
      block.channel = channel;
      for (Lane* lane :
           {&block.s, &block.t, &block.later, &block.value, &block.behind, &block.is_used})
        lane->setZero();
      open[channel] = blocks.size();
    }
    Block& block = blocks[open[channel] - 1];
    const int k = block.count++;
    block.samples[static_cast<std::size_t>(k)] = i;
    block.s[k] = static_cast<float>(sample.slopes.x());
    block.t[k] = static_cast<float>(sample.slopes.y());
    block.later[k] = static_cast<float>(sample.later);
    block.value[k] = static_cast<float>(sample.value);
    block.behind[k] = static_cast<float>(sample.behind);
    block.is_used[k] = 1;
  }
}

void ToSamples(const std::vector<Block>& blocks, std::vector<Sample>& samples) {
  for (const Block& block : blocks) {
    for (int k = 0; k < block.count; ++k) {
      Sample& sample = samples[block.samples[static_cast<std::size_t>(k)]];
      sample.beyond = static_cast<double>(block.beyond[k]);
      sample.residual = static_cast<double>(block.residual[k]);
      sample.height = static_cast<double>(block.height[k]);
    }
  }
}

Lane AfterAxis(const Block& block, const State& state, const PixelScale& scale) {
  return block.later - static_cast<float>(scale.down().dot(state.shape.head<2>()));
}

template <int kSize>
void ToRows(Block& block, const State& state, const PixelNoise& noise, const PixelScale& scale,
            const ProfileTable& table, Rows<kSize>& rows) {
  constexpr bool kMoves = kSize == kOwnMoving;
  std::conditional_t<kMoves, ModelledMoving, Modelled> model;
  if constexpr (kMoves) {
    ModelMoving(block.s, block.t, AfterAxis(block, state, scale), state, scale, table, model);
  } else {
    Model(block.s, block.t, state, scale, table, model);
  }
  const auto inside = static_cast<float>(state.inside[block.channel]);
  const Lane outside = static_cast<float>(state.outside[block.channel]) + block.behind;
  for (std::size_t i = 0; i < kShape; ++i) rows.row[i] = inside * model.light_slope[i];
  for (std::size_t i = 0; i < 4; ++i) rows.row[i] -= outside * model.cover_slope[i];
  if constexpr (kMoves) {
    for (std::size_t i = 0; i < kMotion; ++i)
      rows.row[kShape + i] = inside * model.light_motion[i] - outside * model.cover_motion[i];
  }
  rows.row[kSize - 2] = model.light;
  rows.row[kSize - 1] = 1 - model.cover;
  rows.modelled = outside * rows.row[kSize - 1] + inside * model.light;
  rows.off = block.value - rows.modelled;
  const auto dark = static_cast<float>(noise.DarkVariance());
  const Lane per_variance =
      1 / (dark + static_cast<float>(noise.dn_per_electron) * rows.modelled.max(0.0F));
  const Lane per_sd = per_variance.sqrt();
  block.beyond = model.beyond;
  block.residual = rows.off * per_sd;
  block.height = (inside - outside).abs() * per_sd;
  constexpr auto kHuberSds = static_cast<float>(kHuber);
  const Lane z = block.residual.abs(), bounded = z.min(kHuberSds);
  rows.cost = block.is_used * bounded * (2 * z - bounded);
  rows.weight = block.is_used * per_variance * kHuberSds / z.max(kHuberSds);
}

template <int kSize>
void Equations<kSize>::Add(const Rows<kSize>& rows, std::size_t channel) {
  Part& part = per_channel_[channel];
  Row& right = right_[channel];
  for (int i = 0; i < kSize; ++i) {
    const Lane weighted = rows.weight * rows.row[static_cast<std::size_t>(i)];
    right[i] += static_cast<double>((weighted * rows.off).sum());
    for (int j = i; j < kSize; ++j)
      part(i, j) += static_cast<double>((weighted * rows.row[static_cast<std::size_t>(j)]).sum());
  }
}

template <int kSize>
void Equations<kSize>::Assemble(Normal& normal, Right& right) const {
  constexpr int kHead = kSize - 2;
  normal.setZero();
  right.setZero();
  for (int c = 0; c < 3; ++c) {
    const Part part =
        per_channel_[static_cast<std::size_t>(c)].template selfadjointView<Eigen::Upper>();
    const auto& part_right = right_[static_cast<std::size_t>(c)];
    const int own = kLevels + 2 * c;
    normal.template topLeftCorner<kHead, kHead>() += part.template topLeftCorner<kHead, kHead>();
    normal.template block<kHead, 2>(0, own) = part.template topRightCorner<kHead, 2>();
    normal.template block<2, kHead>(own, 0) = part.template bottomLeftCorner<2, kHead>();
    normal.template block<2, 2>(own, own) = part.template bottomRightCorner<2, 2>();
    right.template head<kHead>() += part_right.template head<kHead>();
    right.template segment<2>(own) = part_right.template tail<2>();
  }
  for (int i = 0; i < kParameters; ++i)
    if (normal(i, i) <= 0) normal(i, i) = 1;
}

template struct Rows<kOwn>;
template struct Rows<kOwnMoving>;
template class Equations<kOwn>;
template class Equations<kOwnMoving>;
template void ToRows(Block&, const State&, const PixelNoise&, const PixelScale&,
                     const ProfileTable&, Rows<kOwn>&);
template void ToRows(Block&, const State&, const PixelNoise&, const PixelScale&,
                     const ProfileTable&, Rows<kOwnMoving>&);

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

// Which pixels take part in the fit.
namespace footing::sphere {
namespace disc {
namespace {

constexpr int kClippedDn = 250;
constexpr double kHiddenBlurs = 3.5;  // How far its light reaches beyond an occluder's edge.
constexpr double kBesideBlurs = 2.5;  // Along the sphere's edge, where half of it is seen.

}  // namespace

void Fitter::Collect(const Image& image, const LocalSlopes& slopes,
                     const Eigen::Vector2d& middle_px, const State& state, double far_blurs,
                     int most_pixels) {
  samples_.clear();
  inside_ = clipped_ = 0;
  const double per_px = std::sqrt(slopes.scale().determinant());
  const double radius_px = state.shape[2] / per_px;
  const double reach_px = 1.25 * radius_px + (far_blurs + 1) * settings_.profile.blur_px;
  const int u0 = 2 * static_cast<int>(std::max(0.0, middle_px.x() - reach_px) / 2);
  const int v0 = 2 * static_cast<int>(std::max(0.0, middle_px.y() - reach_px) / 2);
  const int u1 = std::min(image.width - 1, static_cast<int>(middle_px.x() + reach_px));
  const int v1 = std::min(image.height - 1, static_cast<int>(middle_px.y() + reach_px));
  const double ring_px = 2 * (far_blurs + 2.5) * settings_.profile.blur_px;
  const double expected = 2 * std::numbers::pi * radius_px * std::min(radius_px, ring_px);
  const int every = 1 + static_cast<int>(expected / most_pixels);
  int quad = 0;
  for (int v = v0; v < v1; v += 2) {
    for (int u = u0; u < u1; u += 2)
      CollectQuad(image, slopes, middle_px, state, u, v, far_blurs, quad, every);
  }
}

void Fitter::CollectQuad(const Image& image, const LocalSlopes& slopes,
                         const Eigen::Vector2d& middle_px, const State& state, int u, int v,
                         double far_blurs, int& quad, int every) {
  if (lit_.At(u / 2, v / 2)) return;
  const Eigen::Vector2d at = slopes.At(u + 0.5, v + 0.5);
  const double beyond = BeyondOf(at, state);
  if (beyond > far_blurs + 1.5) return;
  // The middle says little of where the edge is.
  const bool is_middle = beyond < -5;
  ++quad;
  if (quad % (is_middle ? 4 * every : every) != 0) return;
  for (int i = 0; i < 4; ++i) {
    const int at_u = u + i % 2, at_v = v + i / 2;
    Sample sample;
    sample.value = image.Value(at_u, at_v);
    if (beyond < -1) {
      ++inside_;
      clipped_ += sample.value >= kClippedDn ? 1 : 0;
    }
    if (sample.value >= kClippedDn) continue;
    sample.slopes = slopes.At(at_u, at_v);
    sample.channel = image.Channel(at_u, at_v);
    sample.later = (at_v - middle_px.y()) * settings_.shutter.row_s / settings_.shutter.exposure_s;
    const Eigen::Vector2d pixel_from = sample.slopes - state.shape.head<2>();
    sample.sector = SectorOf(pixel_from);
    samples_.push_back(sample);
  }
}

/// How far outside of a state's edge, in blurs.
double Fitter::BeyondOf(const Eigen::Vector2d& slopes, const State& state) const {
  const Eigen::Vector2d from = slopes - state.shape.head<2>();
  const double r = std::max(1e-9, from.norm());
  return (r - state.shape[2]) / (settings_.profile.blur_px * scale_.Along(from / r));
}

std::vector<bool> Fitter::Limit(const State& state, const SectorReach& reach) {
  const double blur = Blur();
  std::vector<bool> seen(kSectors);
  for (std::size_t s = 0; s < kSectors; ++s) seen[s] = std::isinf(reach[s]);
  const double arc = 2 * std::numbers::pi / kSectors * state.shape[2];
  const std::vector<bool> sectors = WithoutBorders(seen, kBesideBlurs * blur / arc);
  std::erase_if(samples_, [&](const Sample& sample) {
    const auto s = static_cast<std::size_t>(sample.sector);
    const double r = (sample.slopes - state.shape.head<2>()).norm();
    const double edge = sectors[s] ? reach[s] : std::min(reach[s], state.shape[2]);
    return r > edge - kHiddenBlurs * blur;
  });
  return sectors;
}

void Fitter::LookBehind(const State& state, double moving_px, std::vector<bool>& sectors) {
  for (Sample& sample : samples_) sample.beyond = BeyondOf(sample.slopes, state);
  disc::LookBehind(samples_, state, settings_.noise, 0.5 * moving_px / settings_.profile.blur_px,
                   sectors);
}

void Fitter::KeepBefore(const Eigen::Vector2d& at, const Eigen::Vector2d& away, double margin) {
  std::erase_if(samples_,
                [&](const Sample& sample) { return (sample.slopes - at).dot(away) > -margin; });
}

int Fitter::DropSectors(std::vector<bool>& sectors) {
  std::array<double, kSectors> sum{}, square{}, count{}, amplitude{};
  for (const Sample& sample : samples_) {
    if (sample.beyond < -2.5) continue;
    const auto s = static_cast<std::size_t>(sample.sector);
    sum[s] += sample.residual;
    square[s] += std::min(sample.residual * sample.residual, 100.0);
    amplitude[s] += sample.height;
    ++count[s];
  }
  int dropped = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    if (!sectors[s] || count[s] < 3) continue;
    // Noise alone, and 1.5 % of the contrast that no model of a lamp explains.
    const double slack = 0.015 * amplitude[s] / count[s];
    const double mean = std::abs(sum[s] / count[s]), rms = std::sqrt(square[s] / count[s]);
    const bool fits = mean < 3.5 / std::sqrt(count[s]) + slack &&
                      rms < 1 + 3.0 / std::sqrt(2 * count[s]) + 2 * slack;
    if (fits) continue;
    sectors[s] = false;
    ++dropped;
  }
  std::erase_if(samples_, [&](const Sample& sample) {
    return !sectors[static_cast<std::size_t>(sample.sector)] && sample.beyond > -2.5;
  });
  return dropped;
}

}  // namespace disc

int SectorOf(const Eigen::Vector2d& from) {
  // Borders of the sectors of an eighth, as tangents.
  static const std::array<double, kSectors / 8> kBorders = [] {
    std::array<double, kSectors / 8> borders{};
    for (std::size_t i = 0; i < borders.size(); ++i)
      borders[i] = std::tan(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kSectors);
    return borders;
  }();
  const double u = std::abs(from.x()), v = std::abs(from.y());
  const double low = std::min(u, v), high = std::max(u, v);
  int sector = 0;
  for (const double border : kBorders) sector += low > border * high ? 1 : 0;
  if (v > u) sector = kSectors / 4 - sector;
  if (from.x() < 0) sector = kSectors / 2 - sector;
  if (from.y() < 0) sector = kSectors - sector;
  return sector % kSectors;
}

}  // namespace footing::sphere

namespace footing::sphere::disc {
namespace {

// Hands below 0.05 m/s, which is the noise of travel at 1 m: 258 of 21 140 moments of 18 recorded
// motions (CMU 13, HDM05 bd and bk), 0.3 to 1.2 % by their kind.
constexpr double kRestShare = 0.01;
constexpr int kRings = 12, kAngles = 24;

/// Beyond that nothing is possible: by how fast hands are, by the travel and by the blur seen.
double FarthestPx(const MotionEvidence& evidence, double motion_sd_px) {
  constexpr double kSds = 5;
  const Eigen::Matrix4d noise = evidence.information.inverse();
  const double travel =
      evidence.change.tail<2>().norm() + kSds * std::sqrt(noise.bottomRightCorner<2, 2>().trace());
  const double blur =
      evidence.change.head<2>().norm() + kSds * std::sqrt(noise.topLeftCorner<2, 2>().trace());
  return std::min({kSds * motion_sd_px, travel, std::sqrt(48 * evidence.blur_px * blur)});
}

}  // namespace

Eigen::Matrix3d UnseenMotion(const MotionEvidence& evidence, double motion_sd_px) {
  constexpr double kPi = std::numbers::pi;
  const double farthest = FarthestPx(evidence, motion_sd_px);
  const double variance = motion_sd_px * motion_sd_px;
  const Eigen::Vector4d weighted = evidence.information * evidence.change;
  double sum = kRestShare;  // Likelihoods are those over that of rest.
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (int k = 0; k < kAngles; ++k) {
    const double angle = 2 * kPi * (k + 0.5) / kAngles, c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector4d blurred(c * c - s * s, 2 * c * s, 0, 0), moved(0, 0, c, s);
    const Eigen::Vector4d by_blur = evidence.information * blurred;
    const double seen_blur = blurred.dot(weighted), seen_travel = moved.dot(weighted);
    const double blur2 = blurred.dot(by_blur), both = moved.dot(by_blur),
                 travel2 = moved.dot(evidence.information * moved) + 1 / variance;
    const Eigen::Vector3d per_px = evidence.per_travel * Eigen::Vector2d(c, s);
    for (int i = 0; i < kRings; ++i) {
      const double root = (i + 0.5) / kRings, r = farthest * root * root;
      // Motion adds (motion . unit)² / 12 to the square of the blur: half of it is even.
      const double blur = r * r / (48 * evidence.blur_px);
      const double log_weight = blur * seen_blur + r * seen_travel -
                                0.5 * (blur * blur * blur2 + r * r * travel2) - blur * r * both;
      const double area = r * 2 * farthest * root / kRings / kAngles / variance;
      const double weight = (1 - kRestShare) * area * std::exp(std::min(700.0, log_weight));
      const Eigen::Vector3d shift = r * per_px - blur * evidence.per_blur;
      sum += weight;
      square += weight * shift * shift.transpose();
    }
  }
  return square / sum;
}

namespace {

constexpr double kRingBlurs = 2.5;  // Farther out there is no light of the sphere.
constexpr double kWidestRange = 8;  // Deviations of a level's noise; ten pixels reach 3 to 4.
constexpr double kLeastApart = 5;   // Deviations; below that, one level for all has less noise.

}  // namespace

double Variance(const PixelNoise& noise, double value) {
  return noise.DarkVariance() + noise.dn_per_electron * std::max(0.0, value);
}

void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                double more_blurs, std::vector<bool>& sectors) {
  const std::size_t count = sectors.size();
  // Values of each sector and channel, one after the other.
  const auto place = [](const Sample& sample) {
    return 3 * static_cast<std::size_t>(sample.sector) + static_cast<std::size_t>(sample.channel);
  };
  const auto is_behind = [&](const Sample& s) { return s.beyond >= kRingBlurs + more_blurs; };
  std::vector<std::size_t> ends(3 * count + 1, 0);
  for (const Sample& sample : samples) ends[place(sample) + 1] += is_behind(sample) ? 1 : 0;
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<double> ring(ends.back()), values;
  std::vector<std::size_t> next = ends;
  for (const Sample& sample : samples)
    if (is_behind(sample)) ring[next[place(sample)]++] = sample.value;
  std::vector<std::array<double, 3>> behind(count);
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t c = 0; c < 3; ++c) {
      values.clear();
      for (const std::size_t turn : {count - 1, count, count + 1}) {
        const std::size_t at = 3 * ((s + turn) % count) + c;
        values.insert(values.end(), ring.begin() + static_cast<std::ptrdiff_t>(ends[at]),
                      ring.begin() + static_cast<std::ptrdiff_t>(ends[at + 1]));
      }
      if (values.empty()) continue;
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      const double range = *most - *least;
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      const double sd = std::sqrt(Variance(noise, *middle));
      if (range > kWidestRange * sd) sectors[s] = false;
      const double apart = *middle - state.outside[c];
      if (std::abs(apart) > kLeastApart * sd) behind[s][c] = apart;
    }
  }
  for (Sample& sample : samples) {
    const auto s = static_cast<std::size_t>(sample.sector);
    sample.behind = behind[s][static_cast<std::size_t>(sample.channel)];
  }
  std::erase_if(samples, [&](const Sample& sample) {
    return !sectors[static_cast<std::size_t>(sample.sector)] && sample.beyond > -2.5;
  });
}

std::vector<bool> WithoutBorders(const std::vector<bool>& seen, double beside) {
  const auto count = static_cast<int>(seen.size());
  const auto is_seen = [&](int s) { return seen[static_cast<std::size_t>((s + count) % count)]; };
  std::vector<bool> sectors = seen;
  for (int s = 0; s < count; ++s) {
    if (is_seen(s - 1) || is_seen(s) || is_seen(s + 1)) continue;
    for (int i = 1; i <= std::min(count / 2, 1 + static_cast<int>(std::ceil(beside))); ++i) {
      sectors[static_cast<std::size_t>((s + i) % count)] = false;
      sectors[static_cast<std::size_t>((s + count - i) % count)] = false;
    }
  }
  return sectors;
}

}  // namespace footing::sphere::disc
