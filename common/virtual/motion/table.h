#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/virtual/motion/markers.h"

/// MOT and STO: OpenSim's tables of numbers over time, and the ground forces in them. TRC: its
/// tables of markers.
namespace footing::motion {

/// An OpenSim table (.mot, .sto): named columns over time.
struct Table {
  std::string name;
  bool in_degrees = false;
  std::vector<std::string> columns;
  Eigen::MatrixXd values;  ///< A row a time, a column a name. The first column is the time, s.
};

/// Index of the column of that name, or -1.
int FindColumn(const Table& table, std::string_view name);

/// Reads the table. Rows and columns announced in the header are checked where they stand. Cells
/// that hold no finite number are errors, which say the line and what was expected there.
Result<Table> ParseTable(std::string_view text, const std::string& file);

/// Writes one; numbers have as many digits as they need to be read again the same.
std::string WriteTable(const Table& table);

/// Measurements of one plate: the force on the person, where it acts, and the free moment there.
struct PlateForces {
  std::string name;           ///< The part of the columns' names that they share.
  Eigen::Matrix3Xd force_W;   ///< N, a column a time.
  Eigen::Matrix3Xd cop_W;     ///< m; 0 where the force is.
  Eigen::Matrix3Xd moment_W;  ///< About cop_W, N m.
};

/// Forces of all plates at equal steps of time.
struct GroundForces {
  double rate_hz = 0;
  double start_s = 0;
  std::vector<PlateForces> plates;
};

/// The plates of a table: columns NAMEvx ... NAMEvz with NAMEpx ... and, where there are any,
/// NAMEmx or "torque" in place of "force". OpenSim's axes (y up) are turned into W. Places beyond
/// 20 m are taken for millimetres, as some files have them. Times must be at equal steps.
Result<GroundForces> ToGroundForces(const Table& table, const std::string& file);

/// Whether a file's rate makes sense, Hz.
inline bool IsRate(double rate_hz) { return rate_hz >= 0.1 && rate_hz <= 100'000; }

/// Rate of a step that a file gives with few digits: 0.0083333 s is 120 Hz, not 120.0005.
inline double RateOfStep(double step_s) {
  const double rate_hz = 1 / step_s;
  const double whole = std::round(rate_hz);
  return whole > 0 && std::abs(rate_hz - whole) < 1e-4 * whole ? whole : rate_hz;
}

/// Beyond any number of a motion file in any unit; squares and sums of such numbers stay finite.
inline constexpr double kGreatestValue = 1e9;

/// A number of a motion file: finite, and no greater than that.
inline std::optional<double> ToValue(std::string_view word) {
  const auto number = text::ToNumber(word);
  return number && std::abs(*number) <= kGreatestValue ? number : std::nullopt;
}

/// Length of a file's unit, m: m, cm or mm, or their English names, singular or plural, in capitals
/// or not. 0 where it is none of them.
double MetresOf(std::string_view unit);

// TRC: marker places as text, a row a frame (Motion Analysis; OpenSim).

/// Reads one in its own axes (OpenSim's: FileAxes::kYUp). A marker whose three fields are empty,
/// not numbers ("NaN"), or all exactly 0 was not seen in that frame. `file` is the name for errors,
/// which say the line and what was expected there.
Result<MarkerTracks> ParseTrc(std::string_view text, const std::string& file);

/// Writes one in millimetres. What was read from our own output is written again byte for byte.
std::string WriteTrc(const MarkerTracks& tracks, const std::string& name);

}  // namespace footing::motion
