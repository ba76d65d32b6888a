#include "common/virtual/motion/asf.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/body/y_up.h"
#include "common/virtual/motion/asf_text.h"

namespace footing::motion {
namespace {

using body::Axis;
using Bone = AsfText::Bone;

constexpr double kInchM = 0.0254;

Axis FileAxis(char letter) { return static_cast<Axis>((letter | 0x20) - 'x'); }

/// Rotation by angles about the axes in that order ("XYZ": x first, so Rz Ry Rx), in W.
Eigen::Matrix3d InOrder(const Eigen::Vector3d& angles_rad, const std::string& order) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const char letter : order) {
    const Axis axis = FileAxis(letter);
    R = body::AxisRotation(body::FromYUp(axis), angles_rad(static_cast<int>(axis))) * R;
  }
  return R;
}

class Assembly {
 public:
  Assembly(const AsfText& parsed, double unit_m) : parsed_(parsed), unit_m_(unit_m) {
    body::Joint root;
    root.name = "root";
    root.rotations = {{Axis::kZ}, {Axis::kX}, {Axis::kY}};
    joints.push_back(std::move(root));
    AddChildren("root", 0, Eigen::Vector3d::Zero());
  }

  std::vector<body::Joint> joints;
  std::vector<const Bone*> bone_of_joint = {nullptr};  ///< None for the root and ends.

 private:
  void AddChildren(const std::string& of, int parent, const Eigen::Vector3d& far_end_m) {
    bool any = false;
    for (const auto& [parent_name, child] : parsed_.links) {
      if (parent_name != of) continue;
      any = true;
      const Bone& bone = *std::find_if(parsed_.bones.begin(), parsed_.bones.end(),
                                       [&name = child](const Bone& b) { return b.name == name; });
      body::Joint joint;
      joint.name = child;
      joint.parent = parent;
      joint.offset_m = far_end_m;
      joint.axes = InOrder(bone.axis * parsed_.units.radians, bone.axis_order);
      // The last axis of the order stands first in the product.
      for (auto letter = bone.axis_order.rbegin(); letter != bone.axis_order.rend(); ++letter) {
        for (std::size_t i = 0; i < bone.dofs.size(); ++i) {
          if (bone.dofs[i] != FileAxis(*letter)) continue;
          body::Rotation rotation{body::FromYUp(bone.dofs[i])};
          if (i < bone.limits.size()) {
            rotation.lower_rad = bone.limits[i].first;
            rotation.upper_rad = bone.limits[i].second;
          }
          joint.rotations.push_back(rotation);
        }
      }
      if (joint.rotations.empty()) joint.axes.setIdentity();
      const int index = static_cast<int>(joints.size());
      joints.push_back(std::move(joint));
      bone_of_joint.push_back(&bone);
      const double norm = bone.direction.norm();
      const Eigen::Vector3d along =
          norm > 0 ? Eigen::Vector3d(bone.direction * (bone.length * unit_m_ / norm))
                   : Eigen::Vector3d::Zero();
      AddChildren(child, index, body::FromYUp(along));
    }
    if (any || parent == 0) return;
    body::Joint end;
    end.name = of + "_end";
    end.parent = parent;
    end.offset_m = far_end_m;
    joints.push_back(std::move(end));
    bone_of_joint.push_back(nullptr);
  }

  const AsfText& parsed_;
  double unit_m_;
};

}  // namespace

Result<AsfSkeleton> ParseAsf(std::string_view text, const std::string& file,
                             const AsfOptions& options) {
  const auto read = ParseAsfText(text, file);
  if (!read) return read.error();
  const AsfText& parsed = *read;
  AsfSkeleton asf;
  asf.unit_m = options.unit_m > 0 ? options.unit_m : kInchM / parsed.units.length;
  asf.radians_per_angle = parsed.units.radians;
  const Assembly assembly(parsed, asf.unit_m);
  for (const Bone& bone : parsed.bones) {
    const auto is_it = [&bone](const Bone* other) { return other == &bone; };
    if (std::none_of(assembly.bone_of_joint.begin(), assembly.bone_of_joint.end(), is_it)) {
      return InvalidData(file + ": bone " + bone.name + " hangs on nothing in :hierarchy");
    }
  }
  asf.skeleton = body::MakeSkeleton(assembly.joints);
  for (int i = 1; i < asf.skeleton.size(); ++i) {
    const Bone* bone = assembly.bone_of_joint[static_cast<std::size_t>(i)];
    if (bone == nullptr || bone->dofs.empty()) continue;
    AsfSkeleton::Bone numbers{bone->name, {}};
    const body::Joint& joint = asf.skeleton.joint(i);
    for (const Axis dof : bone->dofs) {
      for (std::size_t k = 0; k < joint.rotations.size(); ++k) {
        if (joint.rotations[k].axis == body::FromYUp(dof)) {
          numbers.dofs.push_back(joint.first_dof + static_cast<int>(k));
        }
      }
    }
    asf.bones.push_back(std::move(numbers));
  }
  asf.file_root.axes = InOrder(parsed.root_orientation * parsed.units.radians, parsed.root_axis);
  for (auto letter = parsed.root_axis.rbegin(); letter != parsed.root_axis.rend(); ++letter) {
    asf.file_root.rotations.push_back({body::FromYUp(FileAxis(*letter))});
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string& number = parsed.root_order[i];
    const Axis axis = body::FromYUp(FileAxis(number[1]));
    asf.root_numbers[i].rotation = number[0] == 'R';
    asf.root_numbers[i].index = static_cast<int>(axis);
    if (number[0] != 'R') continue;
    for (int k = 0; k < 3; ++k) {
      if (asf.file_root.rotations[static_cast<std::size_t>(k)].axis == axis) {
        asf.root_numbers[i].index = k;
      }
    }
  }
  asf.root_position_m = body::FromYUp(Eigen::Vector3d(parsed.root_position * asf.unit_m));
  return asf;
}

}  // namespace footing::motion
