#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "common/virtual/motion/c3d.h"

namespace footing::motion {
namespace {

constexpr double kLeastForceN = 10;  // Below, the centre of pressure says nothing.

/// Axes of a plate in those of the file: x from corners 2 and 3 to 1 and 4, z down into the floor.
Eigen::Matrix3d Axes(const Eigen::Matrix<double, 3, 4>& corners) {
  const Eigen::Vector3d x = (corners.col(0) + corners.col(3) - corners.col(1) - corners.col(2));
  const Eigen::Vector3d y = (corners.col(0) + corners.col(1) - corners.col(2) - corners.col(3));
  Eigen::Matrix3d axes;
  axes.col(0) = x.normalized();
  axes.col(2) = x.cross(y).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace

Result<GroundForces> ToGroundForces(const C3d& c3d, const std::string& file) {
  GroundForces forces;
  forces.rate_hz = c3d.analog_rate_hz;
  for (std::size_t i = 0; i < c3d.plates.size(); ++i) {
    const C3dPlate& plate = c3d.plates[i];
    const std::string name = "plate " + std::to_string(i + 1);
    if (plate.type != 2 && plate.type != 4) {
      return InvalidData(file + ": " + name + " is of type " + std::to_string(plate.type) +
                         "; only types 2 and 4 are understood");
    }
    if (plate.channels.size() != 6) {
      return InvalidData(file + ": " + name + " needs six channels, has " +
                         std::to_string(plate.channels.size()));
    }
    const Eigen::Matrix3d R = Axes(plate.corners);
    if (!R.allFinite() || std::abs(R.determinant() - 1) > 1e-6) {
      return InvalidData(file + ": the corners of " + name + " do not form a rectangle");
    }
    const Eigen::Vector3d middle = plate.corners.rowwise().mean();
    // The surface is over the origin and z points down, whatever sign the file has.
    Eigen::Vector3d to_surface = plate.origin_m;
    to_surface.z() = -std::abs(to_surface.z());
    const auto channel = [&](std::size_t k) { return c3d.analog.row(plate.channels[k]); };
    // Moments come in the unit of the points, mostly N mm.
    const std::string& unit = c3d.analog_units[static_cast<std::size_t>(plate.channels[3])];
    const double moment_scale = unit == "Nm" || unit == "N.m" || unit == "N*m" ? 1 : 1e-3;
    // Some laboratories store the force on the plate, some that on the person. A plate is only ever
    // pressed down, and its z points down: on the person the sum is negative.
    const double sign = channel(2).sum() > 0 ? -1 : 1;
    PlateForces out;
    out.name = name;
    const Eigen::Index samples = c3d.analog.cols();
    out.force_W.resize(3, samples);
    out.cop_W.setZero(3, samples);
    out.moment_W.setZero(3, samples);
    for (Eigen::Index s = 0; s < samples; ++s) {
      const Eigen::Vector3d force(channel(0)(s), channel(1)(s), channel(2)(s));
      const Eigen::Vector3d moment =
          moment_scale * Eigen::Vector3d(channel(3)(s), channel(4)(s), channel(5)(s));
      out.force_W.col(s) = sign * (R * force);
      if (std::abs(force.z()) < kLeastForceN) continue;
      const Eigen::Vector3d about = moment - to_surface.cross(force);
      const Eigen::Vector3d cop(-about.y() / force.z(), about.x() / force.z(), 0);
      out.cop_W.col(s) = middle + R * cop;
      out.moment_W.col(s) = sign * (R * (about - cop.cross(force)));
    }
    forces.plates.push_back(std::move(out));
  }
  return forces;
}

}  // namespace footing::motion
