#include "clients/log/c3d_body.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "clients/log/export_bodies.h"

namespace footing::log_client {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStepM = 0.1;    // Corners of the plates lie on a grid.
constexpr double kNoLoadM = 0.5;  // Half the plate's sides where no foot was ever loaded.
constexpr int kChannelsPerFoot = 6;

/// The smallest rectangle on the grid, in x and y of W, with all centres of pressure in its inside.
Eigen::AlignedBox2d Rectangle(const std::vector<FootForces>& forces) {
  Eigen::AlignedBox2d box;
  for (const FootForces& feet : forces) {
    for (const FootForce& foot : feet) {
      if (foot.load_n > 0) box.extend(foot.cop_W.head<2>());
    }
  }
  if (box.isEmpty()) return {Vector2d(-kNoLoadM, -kNoLoadM), Vector2d(kNoLoadM, kNoLoadM)};
  const Vector2d least = ((box.min() / kStepM).array().ceil() - 1) * kStepM;
  const Vector2d most = ((box.max() / kStepM).array().floor() + 1) * kStepM;
  return {least, most};
}

motion::C3dPlate PlateOf(const Eigen::AlignedBox2d& box, int first_channel) {
  motion::C3dPlate plate;
  plate.type = 2;
  // In the order of the quadrants of the plate, whose y is to the right.
  plate.corners.col(0) << box.max().x(), box.min().y(), 0;
  plate.corners.col(1) << box.min().x(), box.min().y(), 0;
  plate.corners.col(2) << box.min().x(), box.max().y(), 0;
  plate.corners.col(3) << box.max().x(), box.max().y(), 0;
  for (int i = 0; i < kChannelsPerFoot; ++i) plate.channels.push_back(first_channel + i);
  return plate;
}

}  // namespace

motion::C3d ToC3d(const motion::Motion& motion, const std::vector<bool>& valid,
                  const std::vector<FootForces>& forces) {
  motion::C3d c3d;
  c3d.points = motion::ToWorld(motion::FileAxes::kYUp, JointPlaces(motion, valid));
  c3d.x_screen = "+X";
  c3d.y_screen = "+Z";
  c3d.analog_rate_hz = motion.rate_hz;
  const Eigen::AlignedBox2d box = Rectangle(forces);
  const Vector2d middle = box.center();
  c3d.analog.setZero(2 * kChannelsPerFoot, static_cast<Eigen::Index>(forces.size()));
  for (int foot = 0; foot < 2; ++foot) {
    const int first = kChannelsPerFoot * foot;
    c3d.plates.push_back(PlateOf(box, first));
    for (const char* name : {"Fx", "Fy", "Fz", "Mx", "My", "Mz"}) {
      c3d.analog_names.push_back(name + std::to_string(foot + 1));
      c3d.analog_units.push_back(name[0] == 'F' ? "N" : "Nmm");
    }
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const FootForce& one = forces[i][static_cast<std::size_t>(foot)];
      if (!(one.load_n > 0)) continue;
      const Vector2d cop_W = one.cop_W.head<2>() - middle;
      const Vector3d cop(1000 * cop_W.x(), -1000 * cop_W.y(), 0);  // mm, axes of the plate.
      const Vector3d force(0, 0, -one.load_n);
      c3d.analog.col(static_cast<Eigen::Index>(i)).segment<3>(first) = force;
      c3d.analog.col(static_cast<Eigen::Index>(i)).segment<3>(first + 3) = cop.cross(force);
    }
  }
  return c3d;
}

}  // namespace footing::log_client
