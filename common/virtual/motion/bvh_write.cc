#include <array>
#include <cmath>
#include <vector>

#include "common/body/y_up.h"
#include "common/base/number.h"
#include "common/base/units.h"
#include "common/virtual/motion/bvh.h"

namespace footing::motion {
namespace {

using body::Axis;
using body::Joint;

constexpr int kDecimals = 6;  // Of centimetres and degrees: finer than any capture, and stable.

/// A joint as the file can hold it: three rotations about the plain axes.
struct Written {
  Joint joint;
  bool as_it_is = false;
};

Written ToWritten(const Joint& joint) {
  Written written{joint, joint.plain_axes && joint.rotations.size() == 3};
  if (!written.as_it_is) {
    written.joint.axes.setIdentity();
    written.joint.plain_axes = true;
    written.joint.first_dof = 0;
    written.joint.rotations = {{Axis::kX}, {Axis::kZ}, {Axis::kY}};  // Z Y X of the file.
  }
  return written;
}

void AppendVector(std::string& text, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d file = 100 * body::ToYUp(p_W);
  for (int axis = 0; axis < 3; ++axis) {
    text += ' ';
    text::AppendFixed(text, file(axis), kDecimals);
  }
}

class Writer {
 public:
  explicit Writer(const Motion& motion) : skeleton_(motion.skeleton) {
    children_.resize(skeleton_.joints.size());
    for (int i = 1; i < skeleton_.size(); ++i) {
      children_[static_cast<std::size_t>(skeleton_.joint(i).parent)].push_back(i);
    }
    AppendJoint(0, 0);
  }

  std::string text = "HIERARCHY\n";
  std::vector<int> order;  ///< Joints that turn, as the file has them.

 private:
  void AppendJoint(int index, std::size_t depth) {
    const Joint& joint = skeleton_.joint(index);
    const std::string indent(depth, '\t');
    const bool end = body::IsEnd(skeleton_, index);
    text += indent + (index == 0 ? "ROOT " + joint.name
                      : end      ? std::string("End Site")
                                 : "JOINT " + joint.name);
    text += "\n" + indent + "{\n" + indent + "\tOFFSET";
    AppendVector(text, joint.offset_m);
    text += "\n";
    if (!end) {
      order.push_back(index);
      text += indent + "\tCHANNELS " + (index == 0 ? "6 Xposition Yposition Zposition" : "3");
      for (const auto& rotation : ToWritten(joint).joint.rotations) {
        text += ' ';
        text += "XYZ"[static_cast<int>(body::ToYUp(rotation.axis))];
        text += "rotation";
      }
      text += "\n";
      const auto& children = children_[static_cast<std::size_t>(index)];
      for (int child : children) AppendJoint(child, depth + 1);
      if (children.empty()) {
        text += indent + "\tEnd Site\n" + indent + "\t{\n" + indent + "\t\tOFFSET 0.000000 " +
                "0.000000 0.000000\n" + indent + "\t}\n";
      }
    }
    text += indent + "}\n";
  }

  const body::Skeleton& skeleton_;
  std::vector<std::vector<int>> children_;
};

}  // namespace

std::string WriteBvh(const Motion& motion) {
  Writer writer(motion);
  std::string text = std::move(writer.text);
  text += "MOTION\nFrames: " + std::to_string(motion.frames()) + "\nFrame Time: ";
  text::AppendFixed(text, 1 / motion.rate_hz, 9);
  text += "\n";
  std::vector<Written> joints;
  for (const int index : writer.order) joints.push_back(ToWritten(motion.skeleton.joint(index)));
  // Angles of joints that are written otherwise than they are, kept continuous from frame to frame.
  std::vector<Eigen::Vector3d> angles(joints.size(), Eigen::Vector3d::Zero());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd q = motion.q.col(frame);
    const Eigen::Vector3d root = 100 * body::ToYUp(Eigen::Vector3d(q.head<3>()));
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) text += ' ';
      text::AppendFixed(text, root(axis), kDecimals);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].as_it_is) {
        angles[i] = q.segment<3>(joints[i].joint.first_dof);
      } else {
        const Joint& joint = motion.skeleton.joint(writer.order[i]);
        Eigen::VectorXd held = angles[i];
        SetJointRotation(joints[i].joint, JointRotation(joint, q), held);
        angles[i] = held;
      }
      for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        text::AppendFixed(text, RadiansToDegrees(angles[i](axis)), kDecimals);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace footing::motion
