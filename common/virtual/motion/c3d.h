#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/table.h"

/// C3D: markers, analog channels and force plates of a laboratory in one binary file (www.c3d.org),
/// written by Intel, DEC or MIPS processors, as 16-bit integers or floats.
namespace footing::motion {

/// One force plate as the file describes it.
struct C3dPlate {
  int type = 0;
  Eigen::Matrix<double, 3, 4> corners = Eigen::Matrix<double, 3, 4>::Zero();  ///< m, file's axes.
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< To the surface's middle, plate's axes.
  std::vector<int> channels;                           ///< Into `analog`, from 0.
};

struct C3d {
  MarkerTracks points;  ///< In the file's axes. Labels that are missing are "point 1", ...
  double analog_rate_hz = 0;
  std::vector<std::string> analog_names;
  std::vector<std::string> analog_units;
  Eigen::MatrixXd analog;  ///< Channels x samples, scaled as the file says, in its units.
  std::vector<C3dPlate> plates;
  /// POINT:X_SCREEN and Y_SCREEN, such as "+X" and "+Z" (up); empty where the file has none.
  std::string x_screen, y_screen;
};

/// Reads one. `file` is its name for errors, which say where and what was expected.
Result<C3d> ParseC3d(std::span<const std::uint8_t> bytes, const std::string& file);

/// A file of floats for Intel processors, in millimetres, readable by ParseC3d(). The analog rate
/// is a whole multiple of the points' rate. Points that are not seen are marked so. InvalidData
/// where no frame is there, or more is there than a file can hold.
Result<std::string> WriteC3d(const C3d& c3d);

/// Forces on the person at the analog rate, in the file's axes: plates of type 2 (three forces,
/// three moments about the origin) and 4 (the same; its channels must be calibrated already).
/// Others are an error that names the type.
Result<GroundForces> ToGroundForces(const C3d& c3d, const std::string& file);

}  // namespace footing::motion
