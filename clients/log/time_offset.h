#pragma once

#include <limits>
#include <optional>
#include <string>

#include <Eigen/Core>

/// The offset between two clocks on which the same vertical force was measured.
///
/// symbol   name          unit  is
/// y(t)     Series ours   N     force under the feet, by the boards
/// x(t)     Series theirs N     the same force: by force plates, or mass (g + z'') of markers
/// tau      offset_s      s     y(t + tau) belongs to x(t)
/// H        play_n        N     half the width of the boards' hysteresis
/// b        gain          1     y over x
///
/// Both are low-passed alike (6 Hz, no lag). A search over all offsets takes the one with the most
/// evidence: of a correlation r, -f T log(1 - r^2) over an overlap of T with the mean frequency f,
/// in nats. Then y(t + tau) = a + b P_H(x)(t) is solved for a, b, tau and H by Gauss and Newton,
/// where P_H is the play of the boards' cells: it delays every change of force, more so a slow one,
/// so without it tau would be late (by 20 ms in a squat with H = 16 N).
namespace footing::log_client {

/// Rate at which forces are compared.
inline constexpr double kSeriesRateHz = 100;
/// Value where nothing was measured.
inline constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

/// A force at equal steps, N; NaN where nothing was measured.
struct Series {
  double rate_hz = kSeriesRateHz;
  double start_s = 0;  ///< Time of the first sample, on its own clock.
  Eigen::VectorXd force_n;
};

/// Facts about the two forces.
struct OffsetOptions {
  /// `theirs` is an estimate from markers: what it cannot know, such as a chair or a box that
  /// carries the person, has no force on the boards.
  bool from_markers = false;
  double most_sd_s = 0.005;  ///< An offset that is less certain is not sure.
};

/// How the clocks stand, and how sure that is.
struct TimeOffset {
  double offset_s = 0;  ///< A time of `theirs` plus this is the time of `ours`.
  /// Standard deviation: of the fit (by jackknife over pieces of the overlap), of the boards' play,
  /// of the method.
  double sd_s = 0;
  bool sure = false;
  std::string doubt;  ///< Reason that it is not sure, and the remedy; empty when it is.

  double correlation = 0, gain = 0;
  double misfit_n = 0;  ///< Root mean square of what the fit leaves.
  double play_n = 0;
  double overlap_s = 0;
  double evidence = 0;                ///< Nats.
  std::optional<double> runner_up_s;  ///< The offset that fits second best, elsewhere.
  double runner_up_evidence = 0;
};

/// Finds it. Nothing where there is no overlap of a second in which both forces change.
std::optional<TimeOffset> FindOffset(const Series& ours, const Series& theirs,
                                     const OffsetOptions& options = {});

/// Median of the forces of somebody who stands on the boards, N; 0 where nobody does.
double StandingForce(const Series& force);

/// Greatest length of a series: the search looks at all pairs.
inline constexpr double kLongestSeriesS = 7200;

}  // namespace footing::log_client
