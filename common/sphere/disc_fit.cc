#include "common/sphere/disc_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/sphere/disc_model.h"
#include "common/sphere/disc_ring.h"

namespace footing::sphere {
namespace {

using namespace disc;  // NOLINT: the model that is fitted here

constexpr double kGradientSd = 0.15;
constexpr int kClippedDn = 250;
constexpr std::size_t kMostPixels = 700;
constexpr double kFarBlurs = 4.0;  // Beyond the edge; the background needs no more.
constexpr double kHuber = 2.5;
constexpr double kHiddenBlurs = 3.5;  // From an occluder's edge there is no more of its light.
constexpr double kBesideBlurs = 2.5;  // Along the sphere's edge, where half of it is seen.

class Fitter {
 public:
  Fitter(const Settings& settings, const ProfileTable& table, const BlurScale& scale)
      : settings_(settings), table_(table), scale_(scale) {}

  void Collect(const Image& image, const LocalSlopes& slopes, const Eigen::Vector2d& middle_px,
               const State& state) {
    const double per_px = std::sqrt(slopes.scale().determinant());
    const double radius_px = state.shape[2] / per_px;
    const double reach_px = 1.25 * radius_px + (kFarBlurs + 1) * settings_.profile.blur_px;
    const int u0 = 2 * static_cast<int>(std::max(0.0, middle_px.x() - reach_px) / 2);
    const int v0 = 2 * static_cast<int>(std::max(0.0, middle_px.y() - reach_px) / 2);
    const int u1 = std::min(image.width - 1, static_cast<int>(middle_px.x() + reach_px));
    const int v1 = std::min(image.height - 1, static_cast<int>(middle_px.y() + reach_px));
    const double ring_px = 2 * (kFarBlurs + 2.5) * settings_.profile.blur_px;
    const double expected = 2 * std::numbers::pi * radius_px * std::min(radius_px, ring_px);
    const int every = 1 + static_cast<int>(expected / kMostPixels);
    int quad = 0;
    for (int v = v0; v < v1; v += 2) {
      for (int u = u0; u < u1; u += 2) CollectQuad(image, slopes, state, u, v, quad, every);
    }
  }

  /// Solves from a start; false when it runs away.
  bool Solve(State& state, int rounds) {
    double lambda = 1e-3;
    Equations now;
    double cost = Evaluate(state, now);
    for (int i = 0; i < rounds; ++i) {
      Normal normal;
      Right right;
      Assemble(state, now, normal, right);
      normal.diagonal() *= 1 + lambda;
      const State next = Moved(state, normal.ldlt().solve(right));
      Equations then;
      const double next_cost = IsSane(next, state) ? Evaluate(next, then) : cost + 1;
      if (next_cost > cost * (1 + 1e-9)) {
        lambda *= 10;
        continue;
      }
      const double moved = (next.shape - state.shape).head<3>().norm() / state.shape[2];
      state = next;
      now = then;
      cost = next_cost;
      lambda *= 0.01;
      // The next step would be about the square of this one.
      if (moved < 3e-4) break;
    }
    cost = Evaluate(state, equations_);
    return std::isfinite(cost);
  }

  /// Leaves out what is beyond each sector's reach; says which sectors have the edge in reach.
  std::vector<bool> Limit(const State& state, const SectorReach& reach) {
    const double blur = settings_.profile.blur_px * scale_.Along(Eigen::Vector2d::UnitX());
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

  /// See disc::LookBehind.
  void LookBehind(const State& state, std::vector<bool>& sectors) {
    for (Sample& sample : samples_) sample.beyond = BeyondOf(sample.slopes, state);
    disc::LookBehind(samples_, state, settings_.noise, sectors);
  }

  /// Sectors whose light around the edge does not fit are taken out. Returns how many were.
  int DropSectors(std::vector<bool>& sectors) {
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

  /// Of the state that was solved last.
  DiscFit Report(const State& state) const {
    DiscFit fit;
    fit.cone = {state.shape.head<2>(), state.shape[2]};
    fit.blur_px = state.shape[3];
    fit.limb = state.shape[4];
    double square = 0, all = 0, contrast = 0;
    for (const Sample& sample : samples_) {
      const double residual2 = sample.residual * sample.residual;
      square += std::min(residual2, 36.0);
      all += residual2;
      contrast += sample.height * sample.height;
    }
    const double freedom = std::max(1.0, static_cast<double>(samples_.size()) - kParameters + 2);
    fit.misfit = square / freedom;
    fit.residual_share = std::sqrt(all / std::max(1e-9, contrast));
    Normal normal;
    Right right;
    Assemble(state, equations_, normal, right);
    fit.covariance = settings_.noise.correlation * std::max(1.0, fit.misfit) *
                     normal.ldlt().solve(Normal::Identity()).topLeftCorner<3, 3>();
    fit.clipped_share = inside_ > 0 ? static_cast<double>(clipped_) / inside_ : 0;
    return fit;
  }

  std::size_t size() const { return samples_.size(); }

 private:
  void CollectQuad(const Image& image, const LocalSlopes& slopes, const State& state, int u, int v,
                   int& quad, int every) {
    const Eigen::Vector2d at = slopes.At(u + 0.5, v + 0.5);
    const double beyond = BeyondOf(at, state);
    if (beyond > kFarBlurs + 1.5) return;
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
      const Eigen::Vector2d pixel_from = sample.slopes - state.shape.head<2>();
      sample.sector = SectorOf(pixel_from);
      samples_.push_back(sample);
    }
  }

  /// How far outside of a state's edge, in blurs.
  double BeyondOf(const Eigen::Vector2d& slopes, const State& state) const {
    const Eigen::Vector2d from = slopes - state.shape.head<2>();
    const double r = std::max(1e-9, from.norm());
    return (r - state.shape[2]) / (settings_.profile.blur_px * scale_.Along(from / r));
  }

  double PriorCost(const State& state) const {
    const Profile& profile = settings_.profile;
    const auto square = [](double x) { return x * x; };
    return square((state.shape[3] - profile.blur_px) / profile.blur_sd_px) +
           square((state.shape[4] - profile.limb) / profile.limb_sd) +
           (square(state.shape[5]) + square(state.shape[6])) / square(kGradientSd);
  }

  /// Huber's cost of a state, and its equations.
  double Evaluate(const State& state, Equations& equations) {
    equations = Equations();
    double cost = PriorCost(state);
    for (Sample& sample : samples_) {
      const Modelled model = Model(sample, state, scale_, table_);
      const auto c = static_cast<std::size_t>(sample.channel);
      const double outside = state.outside[c] + sample.behind;
      const double value = outside * (1 - model.cover) + state.inside[c] * model.light;
      const double per_sd = 1 / std::sqrt(Variance(settings_.noise, value));
      sample.beyond = model.beyond;
      sample.residual = (sample.value - value) * per_sd;
      sample.height = std::abs(state.inside[c] - outside) * per_sd;
      Own row;
      row.head<kShape>() = state.inside[c] * model.light_slope;
      row.head<4>() -= outside * model.cover_slope;
      row[kShape] = model.light;
      row[kShape + 1] = 1 - model.cover;
      const double z = std::abs(sample.residual), share = z < kHuber ? 1 : kHuber / z;
      cost += z < kHuber ? z * z : kHuber * (2 * z - kHuber);
      equations.Add(row, sample.value - value, share * per_sd * per_sd, c);
    }
    return cost;
  }

  void Assemble(const State& state, const Equations& equations, Normal& normal,
                Right& right) const {
    equations.Assemble(normal, right);
    const Profile& profile = settings_.profile;
    const auto prior = [&](int at, double mean, double sd) {
      normal(at, at) += 1 / (sd * sd);
      right[at] += (mean - state.shape[at]) / (sd * sd);
    };
    prior(3, profile.blur_px, profile.blur_sd_px);
    prior(4, profile.limb, profile.limb_sd);
    prior(5, 0, kGradientSd);
    prior(6, 0, kGradientSd);
  }

  static State Moved(const State& state, const Right& step) {
    State next = state;
    next.shape += step.head<kShape>();
    for (std::size_t c = 0; c < 3; ++c) {
      next.inside[c] += step[kShape + 2 * static_cast<int>(c)];
      next.outside[c] += step[kShape + 2 * static_cast<int>(c) + 1];
    }
    return next;
  }

  static bool IsSane(const State& next, const State& before) {
    return next.shape.allFinite() && next.shape[2] > 0.4 * before.shape[2] &&
           next.shape[2] < 2.5 * before.shape[2] && next.shape[3] > 0.2 &&
           (next.shape - before.shape).head<2>().norm() < 2 * before.shape[2];
  }

  const Settings& settings_;
  const ProfileTable& table_;
  const BlurScale& scale_;
  std::vector<Sample> samples_;
  int inside_ = 0, clipped_ = 0;
  Equations equations_;  // Of the state that was solved last.
};

}  // namespace

int SectorOf(const Eigen::Vector2d& from) {
  const double turn = std::atan2(from.y(), from.x()) / (2 * std::numbers::pi);
  return (static_cast<int>(std::lround(turn * kSectors)) + kSectors) % kSectors;
}

std::optional<DiscFit> FitDisc(const Image& image, const LocalSlopes& slopes, const Cone& start,
                               const Contrast& contrast, const SectorReach& reach,
                               const Eigen::Vector2d& middle_px, const Settings& settings,
                               const ProfileTable& table) {
  State state;
  state.shape << start.axis, start.tangent, settings.profile.blur_px, settings.profile.limb, 0, 0;
  state.inside = contrast.inside;
  state.outside = contrast.outside;
  const BlurScale scale(slopes.scale());
  Fitter fitter(settings, table, scale);
  fitter.Collect(image, slopes, middle_px, state);
  std::vector<bool> used = fitter.Limit(state, reach);
  fitter.LookBehind(state, used);
  if (fitter.size() < 2 * kParameters || !fitter.Solve(state, 8)) return std::nullopt;
  for (int round = 0; round < 2; ++round) {
    if (fitter.DropSectors(used) == 0) break;
    if (fitter.size() < 2 * kParameters || !fitter.Solve(state, 4)) return std::nullopt;
  }
  DiscFit fit = fitter.Report(state);
  fit.used_share = static_cast<double>(std::count(used.begin(), used.end(), true)) / kSectors;
  return fit;
}

}  // namespace footing::sphere
