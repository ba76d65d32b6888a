#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/board/geometry.h"

namespace footing::posturography {

/// One value of the centre of pressure. x to the subject's right (mediolateral, ML), y to the front
/// (anteroposterior, AP).
struct CopSample {
  double time_s = 0;
  double x_m = 0;
  double y_m = 0;
};

/// Stretches of standing, each with times that never decrease. Nothing is measured across the
/// border of two stretches.
using Stretches = std::vector<std::vector<CopSample>>;

/// Measures of sway, of all stretches together.
///
/// | measure | definition |
/// |---|---|
/// | path | sum of the distances of consecutive samples (Prieto et al. 1996, eq. 8) |
/// | mean velocity | path over duration; ML and AP of the path's own components (eqs. 9, 10) |
/// | RMS, mean distance | about the mean position, divisor n (eqs. 4 to 7) |
/// | sway area | area of the triangles mean position, sample, next sample, a second (eq. 18) |
/// | 95 % circle | pi (mean distance + 1.645 SD of the distances)^2 (eqs. 11, 12) |
/// | 95 % ellipse | three definitions below; S is the covariance with divisor n - 1 |
///
/// Prieto TE et al., Measures of postural steadiness, IEEE Trans Biomed Eng 43(9), 1996. Schubert
/// P, Kirchner M, Ellipse area calculations and their applicability in posturography, Gait &
/// Posture 39(1), 2014.
struct Sway {
  std::size_t samples = 0;
  double duration_s = 0;
  double path_m = 0;
  double path_x_m = 0;
  double path_y_m = 0;
  double mean_velocity_mps = 0;
  double mean_velocity_x_mps = 0;
  double mean_velocity_y_mps = 0;
  double rms_x_m = 0;
  double rms_y_m = 0;
  double rms_radial_m = 0;
  double mean_distance_m = 0;
  double range_x_m = 0;
  double range_y_m = 0;
  /// pi 2 (n - 1)(n + 1) / (n (n - 2)) F(0.95; 2, n - 2) sqrt(det S): where the next sample falls
  /// with 95 % (Schubert & Kirchner 2014, the prediction ellipse).
  double ellipse95_prediction_m2 = 0;
  double ellipse95_chi_square_m2 = 0;  ///< pi chi2(0.95; 2) sqrt(det S).
  double ellipse95_prieto_m2 = 0;      ///< 2 pi 3.00 sqrt(det S) (Prieto 1996, eqs. 13 to 17).
  double ellipse_axis_major_sd_m = 0;  ///< Square roots of the eigenvalues of S.
  double ellipse_axis_minor_sd_m = 0;
  double ellipse_angle_rad = 0;  ///< Angle of the major axis from x, in (-pi/2, pi/2].
  double sway_area_rate_m2ps = 0;
  double circle95_m2 = 0;
  double mean_frequency_hz = 0;  ///< Mean velocity / (2 pi mean distance) (eq. 19); 0 at rest.
};

/// Needs at least 3 samples and a duration above 0; CHECKs both.
Sway Measure(const Stretches& stretches);

/// The 95 % quantile of the F distribution with 2 and `degrees` degrees of freedom. With 2 in the
/// numerator it has a closed form: P(F > f) = (1 + 2 f / d)^(-d / 2).
double FQuantile95(double degrees);

/// Samples at an even rate from uneven ones, by sliding window averages weighted by interval of
/// relevance (SWARII; Audiffren J, Contal E, Preprocessing the Nintendo Wii Board signal to derive
/// more accurate descriptors of statokinesigrams, Sensors 16(8), 2016). Each sample stands for the
/// time nearer to it than to any other; a value is the mean over a window of `window_s` of what the
/// samples stand for. Uneven times ruin velocities, and interpolation does not mend them.
///
/// Times start at the first sample's and go up to the last one's; windows are cut at both ends.
std::vector<CopSample> Resample(std::span<const CopSample> samples, double rate_hz,
                                double window_s);

/// Middle one of the intervals between samples; 0 for fewer than two samples.
double MedianInterval(const Stretches& stretches);

/// Forces on a board's corners at one time.
struct CornerSample {
  double time_s = 0;
  board::CornerForces forces;
};

/// Geometry of a board and the loads that count as a person on it.
struct BoardShape {
  stream::BoardGeometry geometry = board::kBalanceBoard;
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

/// Load on the board: its weight, and the stretches of time in which somebody stood on it.
struct Standing {
  double weight_n = 0;      ///< Median of the totals while anybody stood on it; 0: nobody did.
  std::size_t samples = 0;  ///< With a COP.
  Stretches stretches;      ///< Ended by stepping off and by gaps in the recording.
  Gaps gaps;
};

/// Longest interval of samples that is not a gap: 99.9 % of a real Balance Board's are below
/// 0.17 s (18 minutes over Bluetooth).
inline constexpr double kLongestIntervalS = 0.2;

/// Centre of pressure in the plate frame (board::CentreOfPressure). Times must not decrease.
Standing FindStanding(const std::vector<CornerSample>& samples, const BoardShape& shape);

/// Cuts samples into stretches at gaps: intervals above kLongestIntervalS and 5 median ones. The
/// weight is unknown.
Standing SplitAtGaps(const std::vector<CopSample>& samples);

}  // namespace footing::posturography
