#pragma once

#include <limits>
#include <optional>
#include <string_view>

/// Every number of the feature extraction; sections and equations are those of the gait paper
/// ("Accelerometer-based User Interfaces for the Control of a Physically Simulated Character"), the
/// reasons are in docs/features.md. SI units.
namespace footing::features {

/// 1) Moving or not: "thresholding the variance of the recent acceleration measurements".
struct MovingConfig {
  /// Standard deviation (root of the three axes' variances) over the window that starts motion, and
  /// the one below which it ends. 8-bit counts that toggle on all three axes reach 0.32.
  double start_mps2 = 0.6;
  double stop_mps2 = 0.33;
  /// A still controller feels 1 g within this (rounding and calibration errors). One that feels
  /// more or less is at the turning point of a swing, and still only when the longest window is,
  /// too.
  double gravity_tolerance_mps2 = 1.5;
  /// The window while still; it never reaches back into a motion that was seen to end.
  double still_window_s = 0.25;
  /// The window in motion, in cycles, and its limits. While no frequency is known the window is the
  /// time since motion began and a still window before it, up to the longest.
  double window_cycles = 0.35;
  double shortest_window_s = 0.22;
  double longest_window_s = 0.8;
  /// A period that is longer by more than this share widens the window only once it has lasted.
  double growth_share = 0.1;
  double growth_delay_s = 0.3;
};

/// 2) Frequency: eq. (3).
struct CadenceConfig {
  double lowest_hz = 0.4;
  double highest_hz = 6.0;
  /// tp in multiples of the lag: of the sure search, and of the quick one that bridges the first
  /// two cycles after a change.
  double sure_overlap = 1.0;
  double quick_overlap = 0.25;
  /// Least normalised autocorrelation of a peak.
  double sure_correlation = 0.7;
  double quick_correlation = 0.95;
  /// The first peak within this share of the highest one is the period, so that two periods are not
  /// taken for one.
  double first_peak_share = 0.85;
  /// Refinement over several cycles: as long as they correlate this well, within this time.
  double refine_correlation = 0.9;
  double refine_window_s = 1.5;
  /// A period that differs by more than this share from the one before is a jump; it must persist
  /// for this part of the one before, which outlasts the half period that a reversal fakes.
  double jump_share = 0.25;
  double jump_persistence = 0.25;
  /// The means of the cycles that spread by more than this share of the swing show a twist of the
  /// wrist; the swing across it must hold this share of the whole to decide alone.
  double twist_share = 0.1;
  double least_across_share = 0.15;
  /// How long the last period is kept when none is found, in cycles.
  double hold_cycles = 1.0;
  /// While the other hand still shows the last period within this share, this one keeps it as well,
  /// for so many cycles: one hand whose phase jumps looks faster or slower until the jump is two
  /// cycles old.
  double partner_share = 0.08;
  double partner_cycles = 2.0;
};

/// 3) Phase: eq. (4).
struct PhaseConfig {
  /// Below this normalised cross-correlation the two hands do not swing alike: no new phase.
  double least_correlation = 0.4;
  double hold_cycles = 1.0;
  /// A phase that differs by more than this from the last is a jump; it must persist for this part
  /// of a cycle, which outlasts what a change of frequency fakes.
  double jump_rad = 1.5;
  double jump_persistence = 0.3;
  /// While the newest samples show no period, hands that correlate over the first for the second
  /// are together. Near the turning points of a slow swing hands that alternate move alike for a
  /// while; in half a second a swing of 0.7 Hz and faster leaves them.
  double together_window_s = 0.5;
  double together_lasts_s = 0.2;
  /// The cycle's mean that moves by more than this share of the swing shows a twist of the wrist;
  /// the swing across the way of the twist must hold this share of the whole to decide alone.
  double twist_share = 0.1;
  double least_across_share = 0.15;
  /// And the cycle before must have held this share of the newest one's energy.
  double least_before_share = 0.3;
  /// Only hands whose periods differ by no more than this share of the longer one have a phase:
  /// within it the phase moves by less than a seventh of a cycle in one.
  double agree_share = 0.15;
  /// For this many cycles after they agreed, one of them may show another period: its phase jumps.
  double disagree_cycles = 1.25;
};

/// Beside 3): how two controllers lie in their hands, rotated about their fronts.
struct GripConfig {
  /// Gravity across a front shows the rotation from this share of it on: a hanging forearm is 10 to
  /// 20 degrees off the vertical.
  double least_across = 0.15;
  /// And where it differs by no more than this share from that of the cycle before.
  double most_change = 0.5;
  /// The rotation is a mean over so much of the past; before their first swing hands show it once
  /// they have rested for the second, and that counts as much as a swing of this time.
  double horizon_s = 3;
  double rest_s = 0.3;
};

/// 4) Amplitude and 5) inclination in motion.
struct CycleConfig {
  /// Clipped samples are filled in from a fit to the others, unless more than this share is
  /// clipped; then inclination is held, and amplitude
  /// as well unless even the clipped samples show more.
  double most_clipped = 0.6;
  /// Weight, in samples, of the prior that the fit's second and third harmonic are zero: weak
  /// enough to leave a swing its shape, strong enough where most of its peak is missing.
  double second_prior = 0.03;
  double third_prior = 0.3;
  int fit_rounds = 3;
  /// The horizontal swing has a direction when its rms is this and its variance along that
  /// direction this many times that across it; S's left-right axis must keep this share of its
  /// length in the horizontal plane.
  double least_swing_mps2 = 1.0;
  double swing_ratio = 2.5;
  double least_level = 0.3;
  /// To which end of the line the front belongs is a guess for a swing further off the front than
  /// the first, unless the controller was turned there while it swung; no hand turns beyond the
  /// second. 60 and 120 degrees.
  double most_turned_rad = 1.05;
  double furthest_turned_rad = 2.1;
};

/// Eq. (3) as printed, whose numbers the paper does not give.
struct PrintedConfig {
  double overlap_s = 0;  ///< tp; 0: our features instead of the paper's.
  /// Ra is about as high at two and three periods as at one. The first peak is the period that is
  /// this much of the way from the lowest value of Ra to its highest peak.
  double first_peak_share = 0;
};

/// Settings of all features.
struct Config {
  MovingConfig moving;
  CadenceConfig cadence;
  PhaseConfig phase;
  GripConfig grip;
  CycleConfig cycle;
  PrintedConfig printed;
  /// Inclination at rest is the mean over this time.
  double rest_window_s = 0.15;
  /// A pause in the samples longer than this restarts; shorter ones are bridged by a line.
  double longest_pause_s = 0.25;
  /// A repeated report says nothing new about a moving hand, but after this long it says that the
  /// hand is still.
  double longest_repeat_s = 0.025;
  /// Without a sample for this long there are no features.
  double stale_s = 0.5;
};

/// The features as the paper prints them: the newest estimates alone, without persistence,
/// refinement, fast search, aligned grips and clipped samples filled in.
///
/// The four numbers that the paper does not give make the most gaits of `footing-eval features
/// --decisions --features paper --trials 25 --seed 5000` right, among those that see neither motion
/// in the slow tilts of a recording nor half a stride in a recorded walk (docs/features.md).
inline Config AsPrinted() {
  Config config;
  config.printed = {.overlap_s = 1.5, .first_peak_share = 0.8};
  config.moving.start_mps2 = config.moving.stop_mps2 = 0.6;
  config.moving.still_window_s = 0.3;
  config.moving.shortest_window_s = config.moving.longest_window_s = config.moving.still_window_s;
  config.moving.gravity_tolerance_mps2 = std::numeric_limits<double>::infinity();
  // At rest the newest point of the grid is gravity, and clipped samples count as they are.
  config.rest_window_s = 0.01;
  config.cycle.most_clipped = 1;
  config.cycle.fit_rounds = 0;
  return config;
}

/// The settings called "best" (ours) or "paper"; none of another name.
inline std::optional<Config> Named(std::string_view name) {
  if (name == "best") return Config{};
  if (name == "paper") return AsPrinted();
  return std::nullopt;
}

}  // namespace footing::features
