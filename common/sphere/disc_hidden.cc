#include "common/sphere/disc_hidden.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/sphere/cone.h"

namespace footing::sphere::disc {
namespace {

constexpr double kHiddenMargin = 2.5;       // Blurs from an occluder's edge.
constexpr std::size_t kEdgeStep = 4;        // Of the places that come into question first.
constexpr std::size_t kEdgeStepHidden = 2;  // Where it is known which part of the edge is hidden.
// Of those, that are tried; where edges are missing, more.
constexpr std::size_t kMostPlaces = 3, kMostPlacesCut = 5;
constexpr int kFewestHidden = 3;       // Sectors; one or two are noise.
constexpr double kHopelessSds = 20;    // Of the coarse places; a finer one gains some 10.
constexpr double kMostResidual2 = 36;  // Of a pixel.

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
  std::vector<bool> clear(kSectors, true);
  fitter_.LookBehind(begin_, 0, clear);
  const std::vector<Sample> all = fitter_.samples(), some = Thinned(all, kSomePixels);
  const std::size_t count = start_.edges.size();
  std::vector<std::optional<Solution>> tried(count);
  std::optional<std::size_t> best;
  const auto attempt = [&](std::size_t i) {
    if (tried[i]) return;
    tried[i] = Before(i, some, 3);
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
  const auto solution = Before(*best, all, 8);
  if (!solution) return std::nullopt;
  return Fit{*solution, SectorsBefore(*best, solution->state, clear)};
}

/// The best of a coarse selection, by what the cost gains when the pixels beyond each are left out
/// of the whole sphere's fit; in four of five cases the first one is the best when fitted, too.
std::vector<std::size_t> HiddenPart::Places(const State& whole, const std::vector<Sample>& some,
                                            bool is_good) {
  fitter_.Use(some);
  fitter_.Evaluate(whole);
  std::vector<std::pair<double, std::size_t>> places;
  for (std::size_t i = 0; i < start_.edges.size(); i += is_good ? kEdgeStepHidden : kEdgeStep) {
    const Eigen::Vector2d &at = start_.edges[i], away = at.normalized();
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

std::optional<Solution> HiddenPart::Before(std::size_t edge, const std::vector<Sample>& samples,
                                           int rounds) {
  const Eigen::Vector2d &at = start_.edges[edge], away = at.normalized();
  fitter_.Use(samples);
  fitter_.KeepBefore(at, away, Margin());
  return fitter_.Solve(StartBefore(at, away), false, rounds);
}

/// Those whose edge is on the near side of the line.
std::vector<bool> HiddenPart::SectorsBefore(std::size_t edge, const State& state,
                                            std::vector<bool> sectors) const {
  const Eigen::Vector2d& at = start_.edges[edge];
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    const Eigen::Vector2d place =
        state.shape.head<2>() + state.shape[2] * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    if ((place - at).dot(at.normalized()) > -Margin()) sectors[s] = false;
  }
  return sectors;
}

/// The cone through the edges on the near side of a line.
State HiddenPart::StartBefore(const Eigen::Vector2d& at, const Eigen::Vector2d& away) const {
  State state = begin_;
  std::vector<bool> before;
  for (const Eigen::Vector2d& edge : start_.edges)
    before.push_back((edge - at).dot(away) < -Margin());
  const auto cone = FitCone(start_.edges, before);
  if (cone && cone->tangent > 0.5 * start_.cone.tangent &&
      cone->tangent < 2 * start_.cone.tangent) {
    state.shape.head<2>() = cone->axis;
    state.shape[2] = cone->tangent;
  }
  return state;
}

}  // namespace footing::sphere::disc
