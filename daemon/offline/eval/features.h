#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/report.h"
#include "daemon/sensor/features/config.h"

namespace footing::eval {

/// `features`: the features of recorded accelerations, or how good the features are on synthetic
/// motion.
void AddFeaturesCommand(CLI::App& app, Shared& shared);

/// Errors of the features on synthetic periodic motion (0.5 to 4.5 Hz, peaks from 4 m/s², 8-bit
/// counts, the real sensor's noise, 100 Hz), free and clipped at +-3 g, beside the bars.
nlohmann::json MeasureAccuracy(int trials, std::uint64_t seed, const features::Config& config = {});

/// Rows `ax,ay,az` in m/s² of the sensor frame S; a first line that is not numbers is a header. An
/// error names the line.
Result<std::vector<Eigen::Vector3d>> ReadAccelerationCsv(const std::string& path);

/// Axes (bits 0, 1, 2) of every row that are at the end of the sensor's range. `range_mps2` > 0: at
/// or beyond it. 0: unknown, then it is where an axis stays at its largest value for three rows,
/// above 2.9 g.
std::vector<std::uint32_t> ClippedAxes(const std::vector<Eigen::Vector3d>& rows, double range_mps2);

/// A recording of the Gesture Recognition Toolkit: stretches (class numbers) of accelerations
/// between 0 and 1 without unit or rate.
struct GrtRecording {
  struct Row {
    int stretch = 0;
    Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  };
  std::vector<Row> rows;
  /// The middle of the range counts as 0; the median length of the quieter half of the rows as 1 g.
  double mps2_per_unit = 0;
};
/// Reads a recording in GRT's format; an error names the file.
Result<GrtRecording> ReadGrt(const std::string& path);

/// Delays from a change of motion to the right feature, which then stays right to the end of the
/// stretch: start, stop, 1 Hz to 3 Hz and back, out of phase to in phase and back, beside the bars.
nlohmann::json MeasureDelays(int trials, std::uint64_t seed, const features::Config& config = {});

/// Which gait Figure 9 of the gait paper makes of the features, tick by tick, where the synthetic
/// motion meant another: step, walk, run, jump, or none while features are missing.
nlohmann::json MeasureDecisions(int trials, std::uint64_t seed,
                                const features::Config& config = {});

}  // namespace footing::eval
