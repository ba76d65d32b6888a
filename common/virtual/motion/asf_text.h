#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/body/skeleton.h"
#include "common/base/result.h"
#include "common/base/units.h"

namespace footing::motion {

/// What an ASF file says, in its own axes (y up, z ahead), units and order.
struct AsfText {
  struct Bone {
    std::string name;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double length = 0;
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    std::string axis_order = "XYZ";
    std::vector<body::Axis> dofs;                   ///< In the file's axes and order.
    std::vector<std::pair<double, double>> limits;  ///< rad.
  };
  struct Units {
    double length = 1;
    double radians = kPi / 180;  ///< Of one unit of angle.
  };

  Units units;
  std::vector<Bone> bones;
  std::vector<std::pair<std::string, std::string>> links;  ///< Parent, child, as they stand.
  std::string root_axis = "XYZ";
  std::vector<std::string> root_order = {"TX", "TY", "TZ", "RX", "RY", "RZ"};
  Eigen::Vector3d root_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d root_orientation = Eigen::Vector3d::Zero();
};

/// Reads the sections and checks that names, numbers and the hierarchy hold together. `file` is the
/// name for errors, which say the line and what was expected there.
Result<AsfText> ParseAsfText(std::string_view text, const std::string& file);

}  // namespace footing::motion
