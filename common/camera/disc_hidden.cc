#include "common/camera/disc_hidden.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/camera/disc_fit.h"

namespace footing::sphere::disc {
namespace {

constexpr double kHiddenMargin = 2.5;       // Blurs from an occluder's edge.
constexpr std::size_t kEdgeStep = 4;        // Step between the places that are tried first.
constexpr std::size_t kEdgeStepHidden = 2;  // Where it is known which part of the edge is hidden.
// Number of those places that are tried; where edges are missing, more.
constexpr std::size_t kMostPlaces = 3, kMostPlacesCut = 5;
constexpr int kFewestHidden = 3;  // Sectors; one or two are noise.
// A line through places that are not on the cone: how many there are at least, how far from it they
// are, RMS, and the radius from which on rays are far apart.
constexpr std::size_t kFewestPlaces = 5;
constexpr double kStraightBlurs = 0.6, kLargeBlurs = 5;
constexpr double kHopelessSds = 20;    // Deviations of coarse places; a finer one gains some 10.
constexpr double kMostResidual2 = 36;  // Limit for one pixel, in squared deviations.

/// Akaike's: each pixel that is left out has a level of its own, which is a parameter.
double Cost(const Solution& solution, std::size_t all) {
  return solution.misfit * static_cast<double>(solution.pixels) +
         2 * static_cast<double>(all - solution.pixels);
}

}  // namespace

bool IsCut(const SectorReach& reach) { return HiddenSectors(reach) >= kFewestHidden; }

int HiddenSectors(const SectorReach& reach) {
  return static_cast<int>(
      std::count_if(reach.begin(), reach.end(), [](double one) { return std::isfinite(one); }));
}

std::optional<Fit> HiddenPart::Find(const State& whole, bool is_good) {
  clear_.assign(kSectors, true);
  fitter_.LookBehind(begin_, 0, clear_);
  const std::vector<Sample> all = fitter_.samples();
  const auto fit = AcrossRay(whole, all, is_good);
  if (fit && fit->solution.misfit_sds < kGoodSds) return fit;
  if (is_good) return std::nullopt;
  const auto edge = Through();
  const auto other = edge ? FitBefore(*edge, all) : std::nullopt;
  // A line that is seen needs less of a proof than one that was tried among others.
  return other && other->solution.misfit_sds < kPoorSds ? other : std::nullopt;
}

std::optional<Fit> HiddenPart::AcrossRay(const State& whole, const std::vector<Sample>& all,
                                         bool is_good) {
  const std::vector<Sample> some = Thinned(all, kSomePixels);
  const std::size_t count = start_.edges.size();
  std::vector<std::optional<Solution>> tried(count);
  std::optional<std::size_t> best;
  const auto attempt = [&](std::size_t i) {
    if (tried[i]) return;
    tried[i] = Before(Across(i), some, 3);
    const auto cost = [&](std::size_t k) { return Cost(*tried[k], some.size()); };
    if (tried[i] && (!best || cost(i) < cost(*best))) best = i;
  };
  for (const std::size_t i : Places(whole, some, is_good)) attempt(i);
  if (!best || tried[*best]->misfit_sds > kHopelessSds) return std::nullopt;
  for (std::size_t step = (is_good ? kEdgeStepHidden : kEdgeStep) / 2; step > 0; step /= 2) {
    const std::size_t middle = *best;
    attempt((middle + step) % count);
    attempt((middle + count - step) % count);
  }
  if (tried[*best]->misfit_sds > kPoorSds) return std::nullopt;
  return FitBefore(Across(*best), all);
}

/// The best of a coarse selection, by what the cost gains when the pixels beyond each are left out
/// of the whole sphere's fit; in four of five cases the first one is the best when fitted, too.
std::vector<std::size_t> HiddenPart::Places(const State& whole, const std::vector<Sample>& some,
                                            bool is_good) {
  fitter_.Use(some);
  fitter_.Evaluate(whole);
  std::vector<std::pair<double, std::size_t>> places;
  for (std::size_t i = 0; i < start_.edges.size(); i += is_good ? kEdgeStepHidden : kEdgeStep) {
    const auto [at, away] = Across(i);
    if (is_good && !IsHidden(at)) continue;
    double gain = 0;
    for (const Sample& sample : fitter_.samples()) {
      if ((sample.slopes - at).dot(away) > -Margin())
        gain += std::min(sample.residual * sample.residual, kMostResidual2) - 2;
    }
    places.emplace_back(-gain, i);
  }
  std::sort(places.begin(), places.end());
  places.resize(std::min(places.size(), IsCut(start_.reach) ? kMostPlacesCut : kMostPlaces));
  std::vector<std::size_t> numbers;
  for (const auto& [gain, number] : places) numbers.push_back(number);
  return numbers;
}

/// In a sector without the cone's edge.
bool HiddenPart::IsHidden(const Eigen::Vector2d& edge) const {
  return std::isfinite(start_.reach[static_cast<std::size_t>(SectorOf(edge - start_.cone.axis))]);
}

double HiddenPart::Margin() const { return kHiddenMargin * fitter_.Blur(); }

StraightEdge HiddenPart::Across(std::size_t edge) const {
  return {start_.edges[edge], start_.edges[edge].normalized()};
}

/// The line through the places where the light of a large sphere ends before its cone does.
std::optional<StraightEdge> HiddenPart::Through() const {
  const double blur = fitter_.Blur();
  if (start_.cone.tangent < kLargeBlurs * blur) return std::nullopt;
  std::vector<Eigen::Vector2d> places;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), seen = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& edge : start_.edges) {
    seen += edge;
    if (!IsHidden(edge) || Beyond(start_.cone, edge) > -blur) continue;
    places.push_back(edge);
    middle += edge;
  }
  if (places.size() < kFewestPlaces) return std::nullopt;
  middle /= static_cast<double>(places.size());
  seen /= static_cast<double>(start_.edges.size());
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& place : places) {
    square += (place - middle) * (place - middle).transpose() / static_cast<double>(places.size());
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(square);
  if (axes.eigenvalues()[0] > std::pow(kStraightBlurs * blur, 2)) return std::nullopt;
  const Eigen::Vector2d across = axes.eigenvectors().col(0);
  return StraightEdge{middle, across.dot(middle - seen) > 0 ? across : Eigen::Vector2d(-across)};
}

std::optional<Solution> HiddenPart::Before(const StraightEdge& edge,
                                           const std::vector<Sample>& samples, int rounds) {
  fitter_.Use(samples);
  fitter_.KeepBefore(edge.at, edge.away, Margin());
  return fitter_.Solve(StartBefore(edge), false, rounds);
}

std::optional<Fit> HiddenPart::FitBefore(const StraightEdge& edge, const std::vector<Sample>& all) {
  const auto solution = Before(edge, all, 8);
  if (!solution) return std::nullopt;
  return Fit{*solution, SectorsBefore(edge, solution->state)};
}

/// Those whose edge is on the near side of the line.
std::vector<bool> HiddenPart::SectorsBefore(const StraightEdge& edge, const State& state) const {
  std::vector<bool> sectors = clear_;
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    const Eigen::Vector2d place =
        state.shape.head<2>() + state.shape[2] * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    if ((place - edge.at).dot(edge.away) > -Margin()) sectors[s] = false;
  }
  return sectors;
}

/// The cone through the edges on the near side of a line.
State HiddenPart::StartBefore(const StraightEdge& edge) const {
  State state = begin_;
  std::vector<bool> before;
  for (const Eigen::Vector2d& place : start_.edges)
    before.push_back((place - edge.at).dot(edge.away) < -Margin());
  const auto cone = FitCone(start_.edges, before);
  if (cone && cone->tangent > 0.5 * start_.cone.tangent &&
      cone->tangent < 2 * start_.cone.tangent) {
    state.shape.head<2>() = cone->axis;
    state.shape[2] = cone->tangent;
  }
  return state;
}

}  // namespace footing::sphere::disc
