#pragma once

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

/// Frequency by autocorrelation (section 6, eq. 3).
///
/// | paper | here | unit |
/// |---|---|---|
/// | a(t) | SampleGrid::Filtered | m/s² |
/// | tau | lag | grid steps of 10 ms |
/// | tp | overlap | grid steps |
/// | W(t) = 1 - (T - t) / tp | weight | 1 |
/// | Ra(tau) | Correlation, normalised to at most 1 | 1 |
///
/// Departures, with reasons in docs/features.md: Ra is made independent of the mean and of the size
/// of the swing, rho = 1 - sum W |a(t) - a(t - tau)|² / (2 sum W var); tp grows with tau; the peak
/// is refined between grid points and over several cycles.
namespace footing::features {

struct PeriodEstimate {
  bool found = false;
  double period_s = 0;
  double correlation = 0;
};

/// The period of the newest `points` samples, those since motion began, at most size(). Not found:
/// nothing in the range repeats. `known_s` is the period until now, 0 if none: where the sure
/// search sees another one but the quick one still sees this, the cadence has not changed, only the
/// phase has jumped.
PeriodEstimate FindPeriod(const SampleGrid& grid, int points, double known_s,
                          const CadenceConfig& config);

/// The period that is published: jumps must persist, a loss is bridged for a while.
struct Cadence {
  bool valid = false;
  double period_s = 0;
  double lost_s = 0;           ///< How long nothing was found.
  double candidate_s = 0;      ///< A jump that has not persisted yet; 0 none.
  double candidate_age_s = 0;  ///< For how long it was seen.
};

/// What the other hand or leg of the pair shows; nothing if there is none.
struct Partner {
  PeriodEstimate estimate;
  double period_s = 0;  ///< Of its cadence; 0 none.
};

/// Whether the cadence lasts for several of the partner's: what repeats after one period repeats
/// after two and three as well, so of two limbs the one with the shorter period is right.
bool SpansSeveral(const Cadence& cadence, const Partner& partner, const CadenceConfig& config);

/// The cadence `elapsed_s` later, with a new estimate.
Cadence Next(const Cadence& before, const PeriodEstimate& estimate, const Partner& partner,
             double elapsed_s, const CadenceConfig& config);

}  // namespace footing::features
