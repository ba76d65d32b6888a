#pragma once

#include <cstdint>
#include <vector>

#include "clients/stream/plan.h"

namespace footing::stream_client {

/// How a synthetic player holds the Wiimote with which the terrain game's track is built.
struct BuilderGrip {
  double roll_rad = 0;   ///< Left side higher is positive: a curve to the right.
  double pitch_rad = 0;  ///< Front higher is positive: up.
  bool a = false;        ///< A step in place of a slope.
  bool b = false;        ///< A pit.
};

/// A seeded sequence of grips: slopes, curves and steps to both sides, pits if wanted, and level
/// ground, each held for 1 to 1.8 s at an inclination of 15 to 45 degrees. Every one of them comes
/// once before any comes again.
class BuilderScript {
 public:
  BuilderScript(std::uint64_t seed, bool pits);

  /// At t_s since the start; it changes over in 0.25 s. Without end: it begins again.
  BuilderGrip At(double t_s) const;
  double duration_s() const { return duration_s_; }

 private:
  struct Stretch {
    double from_s = 0;
    BuilderGrip grip;
  };
  std::vector<Stretch> stretches_;
  double duration_s_ = 0;
};

/// One Wiimote in the role editor.
Result<Plan> PlanBuilder(bool pits, const Common& common);

}  // namespace footing::stream_client
