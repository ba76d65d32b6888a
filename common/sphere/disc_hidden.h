#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/sphere/disc_fit.h"
#include "common/sphere/disc_fitter.h"

namespace footing::sphere::disc {

/// A solution and the sectors of the edge that it used.
struct Fit {
  Solution solution;
  std::vector<bool> sectors;
};

/// Sectors without the cone's edge, and whether they say that a part is hidden.
int HiddenSectors(const SectorReach& reach);
bool IsCut(const SectorReach& reach);

/// Looks for a straight edge that hides what is beyond it: through a place where the light ends,
/// across the way there. Its blurred light is left out; the place is taken with the best of
/// Akaike's costs. A part of the pixels is enough to find it.
class HiddenPart {
 public:
  /// `begin`: where fits begin. All are borrowed; the fitter has collected the sphere's pixels.
  HiddenPart(Fitter& fitter, const DiscStart& start, const State& begin)
      : fitter_(fitter), start_(start), begin_(begin) {}

  /// `whole`: the sphere fitted as a whole; `is_good`: that explains the light, so that only places
  /// without the cone's edge come into question.
  std::optional<Fit> Find(const State& whole, bool is_good);

 private:
  std::vector<std::size_t> Places(const State& whole, const std::vector<Sample>& some,
                                  bool is_good);
  std::optional<Solution> Before(std::size_t edge, const std::vector<Sample>& samples, int rounds);
  std::vector<bool> SectorsBefore(std::size_t edge, const State& state,
                                  std::vector<bool> sectors) const;
  State StartBefore(const Eigen::Vector2d& at, const Eigen::Vector2d& away) const;
  bool IsHidden(const Eigen::Vector2d& edge) const;
  double Margin() const;

  Fitter& fitter_;
  const DiscStart& start_;
  const State& begin_;
};

}  // namespace footing::sphere::disc
