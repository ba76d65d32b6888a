#include "common/virtual/motion/body_files.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/joint_angles.h"

namespace footing::motion {

MarkerTracks JointPlaces(const Motion& motion, const std::vector<bool>& valid) {
  MarkerTracks tracks;
  tracks.rate_hz = motion.rate_hz;
  body::Kinematics at(motion.skeleton);
  for (int i = 0; i < motion.skeleton.size(); ++i) {
    tracks.names.push_back(motion.skeleton.joint(i).name);
    tracks.p.emplace_back(3, motion.frames());
  }
  const Eigen::Vector3d unseen =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    if (!valid[static_cast<std::size_t>(frame)]) {
      for (Eigen::Matrix3Xd& track : tracks.p) track.col(frame) = unseen;
      continue;
    }
    body::ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    for (std::size_t i = 0; i < tracks.p.size(); ++i) {
      const Eigen::Vector3d& p_W = at.p_WJ[i];
      tracks.p[i].col(frame) << p_W.x(), p_W.z(), -p_W.y();
    }
  }
  return tracks;
}

std::string WithNote(std::string table, const std::string& note) {
  const std::size_t end = table.find("endheader\n");
  FOOTING_CHECK(end != std::string::npos);
  return table.insert(end, note + "\n");
}

namespace {

/// A table's columns that are angles, under a name with `ending`, from `table`'s rows.
struct CsvColumns {
  const Table& table;
  std::vector<std::size_t> columns;

  CsvColumns(const Table& from, const std::string& ending, std::string& head) : table(from) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::string& name = table.columns[i];
      if (name == "time" || (name.rfind("pelvis_t", 0) == 0 && name != "pelvis_tilt")) continue;
      columns.push_back(i);
      head += "," + name + ending;
    }
  }
  void Append(Eigen::Index row, bool valid, std::string& line) const {
    for (const std::size_t column : columns) {
      line += ',';
      if (!valid || !joint_angles::IsKnown(table, table.columns[column], row)) continue;
      text::AppendFixed(line, table.values(row, static_cast<Eigen::Index>(column)), 3);
    }
  }
};

}  // namespace

Result<std::string> AnglesCsv(const Table& angles, const std::vector<bool>& valid) {
  std::string csv = "time_s,valid";
  std::optional<Table> change;
  if (const auto standing = joint_angles::FindStanding(angles); !standing.empty()) {
    auto since = joint_angles::SinceStanding(angles, standing);
    if (!since) return since.error();
    change = *std::move(since);
  }
  std::vector<CsvColumns> parts;
  if (change) parts.emplace_back(*change, "_change_deg", csv);
  parts.emplace_back(angles, "_deg", csv);
  csv += '\n';
  for (Eigen::Index row = 0; row < angles.values.rows(); ++row) {
    const bool good = valid[static_cast<std::size_t>(row)];
    text::AppendFixed(csv, angles.values(row, 0), 6);
    csv += good ? ",1" : ",0";
    for (const CsvColumns& part : parts) part.Append(row, good, csv);
    csv += '\n';
  }
  return csv;
}

std::string ExternalLoads(const std::string& name) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<OpenSimDocument Version=\"40000\">\n"
      "<ExternalLoads name=\"" +
      name + "_loads\">\n<objects>\n";
  for (const bool left : {false, true}) {
    const std::string side = left ? "l" : "r";
    xml += "<ExternalForce name=\"foot_" + side +
           "\">\n<appliesForce>true</appliesForce>\n<applied_to_body>" +
           joint_angles::OpenSimFoot(left) +
           "</applied_to_body>\n<force_expressed_in_body>ground</force_expressed_in_body>\n"
           "<point_expressed_in_body>ground</point_expressed_in_body>\n<force_identifier>"
           "ground_force_" +
           side + "_v</force_identifier>\n<point_identifier>ground_force_" + side +
           "_p</point_identifier>\n<torque_identifier>ground_torque_" + side +
           "_</torque_identifier>\n<data_source_name>Unassigned</data_source_name>\n"
           "</ExternalForce>\n";
  }
  return xml + "</objects>\n<groups />\n<datafile>" + name +
         "_grf.mot</datafile>\n</ExternalLoads>\n</OpenSimDocument>\n";
}

namespace {

/// A millionth of a second.
double RoundedS(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace

Table ForceTable(const std::vector<FootForces>& forces, double rate_hz) {
  Table table;
  table.columns = {"time"};
  for (const char* side : {"r", "l"}) {
    const std::string force = std::string("ground_force_") + side + "_";
    for (const char* part : {"vx", "vy", "vz", "px", "py", "pz"}) {
      table.columns.push_back(force + part);
    }
    for (const char* part : {"x", "y", "z"}) {
      table.columns.push_back(std::string("ground_torque_") + side + "_" + part);
    }
  }
  table.values.setZero(static_cast<Eigen::Index>(forces.size()),
                       static_cast<Eigen::Index>(table.columns.size()));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    auto row = table.values.row(static_cast<Eigen::Index>(i));
    row(0) = RoundedS(static_cast<double>(i) / rate_hz);
    for (const int side : {1, 0}) {
      const FootForce& foot = forces[i][static_cast<std::size_t>(side)];
      const Eigen::Index first = side == 1 ? 1 : 10;
      row(first + 1) = foot.load_n;
      row(first + 3) = foot.cop_W.x();
      row(first + 4) = foot.cop_W.z();
      row(first + 5) = -foot.cop_W.y();
    }
  }
  return table;
}

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

C3dPlate PlateOf(const Eigen::AlignedBox2d& box, int first_channel) {
  C3dPlate plate;
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

C3d ToC3d(const Motion& motion, const std::vector<bool>& valid,
          const std::vector<FootForces>& forces) {
  C3d c3d;
  c3d.points = ToWorld(FileAxes::kYUp, JointPlaces(motion, valid));
  c3d.x_screen = "+X";
  c3d.y_screen = "+Z";
  if (forces.empty()) return c3d;
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

}  // namespace footing::motion
