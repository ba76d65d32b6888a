#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Measures of quiet standing from the centre of pressure (COP). x is to the subject's right
/// (mediolateral, ML), y to the front (anteroposterior, AP).
namespace footing::posturography {

/// One value of the centre of pressure.
struct CopSample {
  double time_s = 0;
  double x_m = 0;
  double y_m = 0;
};

/// Stretches of standing, each with times that never decrease. Nothing is measured across the
/// border of two stretches.
using Stretches = std::vector<std::vector<CopSample>>;

/// Measures of one axis.
struct AxisSway {
  double path_m = 0;
  double mean_velocity_mps = 0;
  double rms_m = 0;
  double range_m = 0;
  /// Measures of the spectrum; nothing where no stretch has an even rate and 10 s.
  std::optional<double> power_m2;
  std::optional<double> median_frequency_hz;
  std::optional<double> frequency95_hz;
  std::optional<double> sample_entropy;  ///< Nothing where it is not defined.
};

/// Measures of sway, of all stretches together.
///
/// | measure | definition |
/// |---|---|
/// | path | sum of the distances of consecutive samples (Prieto et al. 1996, eq. 8) |
/// | mean velocity | path over duration; ML and AP of the path's own components (eqs. 9, 10) |
/// | RMS, mean distance | about the mean position, divisor n (eqs. 4 to 7) |
/// | range | greatest minus least value of an axis |
/// | sway area | area of the triangles mean position, sample, next sample, a second (eq. 18) |
/// | 95 % circle | pi (mean distance + 1.645 SD of the distances)^2 (eqs. 11, 12) |
/// | 95 % ellipse | three definitions below; S is the covariance with divisor n - 1 |
/// | power, median and 95 % frequency | of the spectrum from 0.15 to 5 Hz; below the frequencies
/// lie
///   50 and 95 % of the power. Eight sine tapers (Prieto 1996; Riedel & Sidorenko 1995), about the
///   mean of each stretch |
/// | sample entropy | -ln(A / B): B pairs of 2 consecutive values differ by at most r = 0.2 RMS in
///   each value, A of them also in the next one (Richman & Moorman 2000), at the samples' own rate
///   |
///
/// Prieto TE et al., Measures of postural steadiness, IEEE Trans Biomed Eng 43(9), 1996. Schubert
/// P, Kirchner M, Ellipse area calculations and their applicability in posturography, Gait &
/// Posture 39(1), 2014. Riedel KS, Sidorenko A, Minimum bias multiple taper spectral estimation,
/// IEEE Trans Signal Process 43(1), 1995. Richman JS, Moorman JR, Physiological time-series
/// analysis using approximate entropy and sample entropy, Am J Physiol 278(6), 2000.
struct Sway {
  std::size_t samples = 0;
  double duration_s = 0;
  double path_m = 0;
  double mean_velocity_mps = 0;
  AxisSway ml;
  AxisSway ap;
  double rms_radial_m = 0;
  double mean_distance_m = 0;
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

/// Definitions to state beside the figures.
inline constexpr const char* kEllipseDefinition =
    "F-based prediction ellipse (Schubert & Kirchner 2014)";
inline constexpr const char* kSpectrumDefinition =
    "0.15 to 5 Hz, eight sine tapers (Prieto et al. 1996)";
inline constexpr const char* kEntropyDefinition =
    "m = 2, r = 0.2 RMS, at the rate of the samples (Richman & Moorman 2000)";

/// `rate_hz` is the even rate of the samples; 0: it is uneven, and there are neither spectra nor
/// entropies, as above 60,000 samples. Needs at least 3 samples and a duration above 0; CHECKs
/// both.
Sway Measure(const Stretches& stretches, double rate_hz);

/// The 95 % quantile of the F distribution with 2 and `degrees` degrees of freedom. With 2 in the
/// numerator it has a closed form: P(F > f) = (1 + 2 f / d)^(-d / 2).
double FQuantile95(double degrees);

/// A measure as JSON and CSV name it, in the units of the field: mm, mm/s, mm2, Hz, degrees.
struct NamedMeasure {
  const char* key = "";  ///< With its unit, as path_length_mm.
  std::optional<double> value;
};
/// All measures, in the order of the files.
std::vector<NamedMeasure> Named(const Sway& sway);

}  // namespace footing::posturography
