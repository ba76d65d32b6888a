#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/motion.h"

namespace footing::motion {

/// Contents of an ASF file, in its own axes (y up, z ahead), units and order.
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
    double radians = kPi / 180;  ///< Size of one unit of angle.
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

/// Acclaim skeleton (ASF) and motion (AMC), as the CMU database has them; y up, z ahead.
struct AsfOptions {
  /// One unit of length; 0 takes the file's own `length` as CMU means it, inches over it: with 0.45
  /// that is 0.0254 / 0.45 m = 5.644 cm.
  double unit_m = 0;
};

/// A skeleton and how its AMC files name and order their numbers.
struct AsfSkeleton {
  /// The root's rotations are heading, roll, pitch (about z, x, y of W), whatever the file has:
  /// they lock only when the pelvis lies on its side. Bones are joints at their near ends; the far
  /// end of the last of each chain is a joint "NAME_end".
  body::Skeleton skeleton;

  /// The numbers that a bone has in a frame of an AMC file: where each goes into q.
  struct Bone {
    std::string name;
    std::vector<int> dofs;
  };
  std::vector<Bone> bones;

  /// The root as the file has it: its six numbers in the file's order.
  body::Joint file_root;
  struct RootNumber {
    bool rotation = false;
    int index = 0;  ///< Axis in W of a position, or which of file_root's rotations.
  };
  std::array<RootNumber, 6> root_numbers;
  Eigen::Vector3d root_position_m = Eigen::Vector3d::Zero();

  double unit_m = 0;
  double radians_per_angle = 0;  ///< Angle unit of the ASF file; AMC files say their own.
};

/// `file` is the name for errors, which say the line and what was expected there. Bones that slide
/// or stretch (tx, ty, tz, l) are refused; a bone without length has length 0.
Result<AsfSkeleton> ParseAsf(std::string_view text, const std::string& file,
                             const AsfOptions& options = {});

/// The motion of that skeleton. AMC files do not state their rate: CMU's are 120 Hz.
Result<Motion> ParseAmc(std::string_view text, const std::string& file, const AsfSkeleton& skeleton,
                        double rate_hz = 120);

}  // namespace footing::motion
