#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/board/geometry.h"
#include "common/posturography/sway.h"
#include "common/stream/setup.h"

/// From the loads of one board or two to the COP that is measured.
namespace footing::posturography {

/// Forces on a board's corners at one time.
struct CornerSample {
  double time_s = 0;
  board::CornerForces forces;
};

/// Load at one time and its moments about the origin; the COP is moments over load.
struct LoadSample {
  double time_s = 0;
  double load_n = 0;
  double right_nm = 0;  ///< Load times its distance to the right.
  double front_nm = 0;
};
using Loads = std::vector<LoadSample>;

/// Loads on a board that lies at `pose` in W, whose x is the subject's front and whose y is the
/// subject's left. The pose {} is that of a single board with its power button behind the subject.
Loads LoadsOn(std::span<const CornerSample> samples, const stream::BoardPose& pose = {},
              const stream::BoardGeometry& geometry = board::kBalanceBoard);

/// Loads that count as a person.
struct StandingLimits {
  /// Less than this is nobody: the board and a step on or off it.
  double least_body_weight_n = board::kContactOffN;
  /// A COP is undefined below this share of the body weight.
  double least_share_of_weight = 0.1;
};

/// Intervals without samples while somebody stood on the board. They end a stretch.
struct Gaps {
  std::size_t count = 0;
  double longest_s = 0;
  double seconds = 0;  ///< Total duration of all gaps.
};

/// Load on the boards: its weight, and the stretches of time in which somebody stood on them.
struct Standing {
  double weight_n = 0;      ///< Median of the totals while anybody stood on it; 0: nobody did.
  std::size_t samples = 0;  ///< With a COP.
  Stretches stretches;      ///< Ended by stepping off and by gaps in the recording.
  Gaps gaps;
};

/// Longest interval of samples that is not a gap: 99.9 % of a real Balance Board's are below
/// 0.17 s (18 minutes over Bluetooth).
inline constexpr double kLongestIntervalS = 0.2;

/// Times must not decrease.
Standing FindStanding(const Loads& loads, const StandingLimits& limits);

/// Cuts samples into stretches at gaps: intervals above kLongestIntervalS and 5 median ones. The
/// weight is unknown.
Standing SplitAtGaps(const std::vector<CopSample>& samples);

/// Samples at an even rate from uneven ones, by sliding window averages weighted by interval of
/// relevance (SWARII; Audiffren J, Contal E, Preprocessing the Nintendo Wii Board signal to derive
/// more accurate descriptors of statokinesigrams, Sensors 16(8), 2016). Each sample stands for the
/// time nearer to it than to any other; a value is the mean over a window of `window_s` of what the
/// samples stand for. Uneven times ruin velocities, and interpolation does not mend them.
///
/// Times start at the first sample's and go up to the last one's; windows are cut at both ends.
std::vector<CopSample> Resample(std::span<const CopSample> samples, double rate_hz,
                                double window_s);

/// Sum of the loads of two boards at an even rate. Boards sample at times of their own, so each
/// one's loads and moments are averaged as in Resample first. From the time on at which both have
/// samples; nothing within a gap of either.
Loads Merged(const Loads& left, const Loads& right, double rate_hz, double window_s);

/// Middle one of the intervals between samples; 0 for fewer than two samples.
double MedianInterval(const Stretches& stretches);
double MedianInterval(const Loads& loads);

/// Rate of samples whose intervals differ by less than 1 %; 0 if they do not.
double EvenRate(const Stretches& stretches);

/// Seconds of all stretches together.
double DurationS(const Stretches& stretches);

/// How a COP is resampled and filtered; 0: not.
struct CopFilter {
  double rate_hz = 0;
  double cutoff_hz = 0;  ///< Only at an even rate.
  double window_s = 0;   ///< Window of the averages, s; 0: two intervals of the slower rate.

  /// Window where the samples have this median interval.
  double WindowS(double median_interval_s) const;
  /// The steps in words, for a reader.
  std::string Text() const;
};

/// The options --rate-hz, --cutoff-hz and --window-s of a command line, as given; empty ones have
/// the defaults.
struct CopFilterOptions {
  std::string rate;    ///< Hz, or "recorded".
  std::string cutoff;  ///< Hz, or "none".
  double window_s = 0;
};

/// Loads of a board (`corners`) are noisy and sampled unevenly, so their COP is filtered as usual
/// in posturography; a file of COPs is taken as its author filtered it. A usage error says what
/// does not fit together.
Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners);

/// Resamples every stretch where the filter has a rate. An error for recordings of days, which are
/// times in another unit.
Result<void> ResampleAll(const CopFilter& filter, Stretches& stretches);
/// Low-pass of every stretch where the filter has one; its rate is that of the samples.
void LowPassAll(const CopFilter& filter, Stretches& stretches);

}  // namespace footing::posturography
