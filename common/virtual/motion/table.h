#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

/// MOT and STO: OpenSim's tables of numbers over time, and the ground forces in them.
namespace footing::motion {

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

/// What one plate measured: the force on the person, where it acts, and the free moment there.
struct PlateForces {
  std::string name;           ///< The part of the columns' names that they share.
  Eigen::Matrix3Xd force_W;   ///< N, a column a time.
  Eigen::Matrix3Xd cop_W;     ///< m; 0 where the force is.
  Eigen::Matrix3Xd moment_W;  ///< About cop_W, N m.
};

struct GroundForces {
  double rate_hz = 0;
  double start_s = 0;
  std::vector<PlateForces> plates;
};

/// The plates of a table: columns NAMEvx ... NAMEvz with NAMEpx ... and, where there are any,
/// NAMEmx or "torque" in place of "force". OpenSim's axes (y up) are turned into W. Places beyond
/// 20 m are taken for millimetres, as some files have them. Times must be at equal steps.
Result<GroundForces> ToGroundForces(const Table& table, const std::string& file);

}  // namespace footing::motion
