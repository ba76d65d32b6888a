#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/camera/disc_fit.h"
#include "common/camera/disc_fitter.h"

namespace footing::sphere::disc {

/// A solution and the sectors of the edge that it used.
struct Fit {
  Solution solution;
  std::vector<bool> sectors;
};

/// Sectors without the cone's edge, and whether they say that a part is hidden.
int HiddenSectors(const SectorReach& reach);
bool IsCut(const SectorReach& reach);

/// Hidden part: beyond a line through `at`, on the side to which `away`, a unit vector, points.
struct StraightEdge {
  Eigen::Vector2d at, away;
};

/// Looks for a straight edge that hides what is beyond it: through a place where the light ends,
/// across the way there. Its blurred light is left out; the place is taken with the best of
/// Akaike's costs. A part of the pixels is enough to find it. On a large sphere the rays are so far
/// apart that no such edge may be near the true one: then the places that are not on the cone are
/// enough of them to draw the line through.
class HiddenPart {
 public:
  /// `begin`: where fits begin. All are borrowed; the fitter has collected the sphere's pixels.
  HiddenPart(Fitter& fitter, const DiscStart& start, const State& begin)
      : fitter_(fitter), start_(start), begin_(begin) {}

  /// `whole`: the sphere fitted as a whole; `is_good`: that explains the light, so that only places
  /// without the cone's edge come into question. Nothing if noise does not explain the misfit.
  std::optional<Fit> Find(const State& whole, bool is_good);

 private:
  std::optional<Fit> AcrossRay(const State& whole, const std::vector<Sample>& all, bool is_good);
  std::vector<std::size_t> Places(const State& whole, const std::vector<Sample>& some,
                                  bool is_good);
  StraightEdge Across(std::size_t edge) const;
  std::optional<StraightEdge> Through() const;
  std::optional<Solution> Before(const StraightEdge& edge, const std::vector<Sample>& samples,
                                 int rounds);
  std::optional<Fit> FitBefore(const StraightEdge& edge, const std::vector<Sample>& all);
  std::vector<bool> SectorsBefore(const StraightEdge& edge, const State& state) const;
  State StartBefore(const StraightEdge& edge) const;
  bool IsHidden(const Eigen::Vector2d& edge) const;
  double Margin() const;

  Fitter& fitter_;
  const DiscStart& start_;
  const State& begin_;
  std::vector<bool> clear_;  ///< Sectors with one level behind them.
};

}  // namespace footing::sphere::disc
