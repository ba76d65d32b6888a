#include "common/virtual/motion/asf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/base/text.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/motion.h"

namespace footing::motion {
namespace {

using body::Axis;

/// Lengths of one bone and of units that make no sense beyond.
constexpr double kMostLength = 1e6;

/// An ASF file section by section; the parse functions stop at the line after theirs.
class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : lines_(text, file) {}

  Result<AsfText> Run() {
    Advance();
    bool any = false;
    while (line_) {
      std::string_view rest = *line_;
      const std::string_view section = text::PopWord(rest);
      if (section.empty() || section[0] != ':') return Fault("expected a section such as :root");
      Advance();
      any = true;
      Result<void> done;
      if (section == ":units") done = ParseUnits();
      if (section == ":root") done = ParseRoot();
      if (section == ":bonedata") done = ParseBones();
      if (section == ":hierarchy") done = ParseHierarchy();
      if (!done) return done.error();
      while (line_ && text::Trim(*line_)[0] != ':') Advance();  // :documentation and the like.
    }
    if (!any || out_.bones.empty()) return Fault("not an ASF file: no :bonedata");
    return std::move(out_);
  }

 private:
  using Bone = AsfText::Bone;

  Error Fault(const std::string& message) const { return lines_.Fault(message); }

  void Advance() {
    do {
      line_ = lines_.NextFull();
    } while (line_ && text::Trim(*line_)[0] == '#');
  }
  bool InSection() const { return line_ && text::Trim(*line_)[0] != ':'; }

  Result<double> Number(std::string_view& line, const std::string& of) {
    const std::string_view word = text::PopWord(line);
    const auto number = text::ToNumber(word);
    if (number && std::abs(*number) <= kMostLength) return *number;
    return Fault("expected a number of " + of + ", found " + text::Quoted(word));
  }
  Result<Eigen::Vector3d> Vector(std::string_view& line, const std::string& of) {
    Eigen::Vector3d vector;
    for (int i = 0; i < 3; ++i) {
      const auto number = Number(line, of);
      if (!number) return number.error();
      vector(i) = *number;
    }
    return vector;
  }
  Result<std::string> AxisOrder(std::string_view& line) {
    std::string order(text::PopWord(line));
    std::string sorted = order;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != "XYZ")
      return Fault("expected an order of axes such as XYZ, found " + text::Quoted(order));
    return order;
  }

  Result<void> ParseUnits() {
    for (; InSection(); Advance()) {
      std::string_view rest = *line_;
      const std::string_view key = text::PopWord(rest);
      if (key == "length") {
        const auto number = Number(rest, "length");
        if (!number) return number.error();
        if (!(*number > 1e-6)) return Fault("the unit of length must be positive");
        out_.units.length = *number;
      } else if (key == "angle") {
        const std::string_view unit = text::PopWord(rest);
        if (unit != "deg" && unit != "rad") return Fault("expected angle deg or rad");
        out_.units.radians = unit == "deg" ? kPi / 180 : 1;
      }
    }
    return {};
  }

  Result<void> ParseRoot() {
    for (; InSection(); Advance()) {
      std::string_view rest = *line_;
      const std::string_view key = text::PopWord(rest);
      if (key == "order") {
        out_.root_order.clear();
        for (auto word = text::PopWord(rest); !word.empty(); word = text::PopWord(rest)) {
          out_.root_order.emplace_back(word);
        }
        auto sorted = out_.root_order;
        std::sort(sorted.begin(), sorted.end());
        if (sorted != std::vector<std::string>{"RX", "RY", "RZ", "TX", "TY", "TZ"}) {
          return Fault("expected TX TY TZ RX RY RZ in some order");
        }
      } else if (key == "axis") {
        auto order = AxisOrder(rest);
        if (!order) return order.error();
        out_.root_axis = *std::move(order);
      } else if (key == "position" || key == "orientation") {
        const auto vector = Vector(rest, "the root's " + std::string(key));
        if (!vector) return vector.error();
        (key == "position" ? out_.root_position : out_.root_orientation) = *vector;
      }
    }
    return {};
  }

  Result<void> ParseBones() {
    while (InSection()) {
      if (text::Trim(*line_) != "begin") return Fault("expected 'begin' of a bone");
      Advance();
      if (out_.bones.size() >= kMostJoints) {
        return Fault("more than " + std::to_string(kMostJoints) + " bones");
      }
      Bone bone;
      for (; InSection() && text::Trim(*line_) != "end"; Advance()) {
        const auto done = ParseBoneLine(*line_, bone);
        if (!done) return done.error();
      }
      if (!InSection()) return Fault("bone " + text::Quoted(bone.name) + " has no 'end'");
      if (bone.name.empty() || bone.name == "root") return Fault("a bone without a name");
      for (const Bone& other : out_.bones) {
        if (other.name == bone.name) return Fault("a second bone " + text::Quoted(bone.name));
      }
      if (bone.limits.size() > bone.dofs.size()) {
        return Fault("bone " + bone.name + " has more limits than dof");
      }
      out_.bones.push_back(std::move(bone));
      Advance();
    }
    return {};
  }

  Result<void> ParseBoneLine(std::string_view line, Bone& bone) {
    std::string_view rest = line;
    const std::string_view key = text::PopWord(rest);
    if (key == "name") {
      bone.name = std::string(text::Trim(rest));
    } else if (key == "direction") {
      const auto vector = Vector(rest, "direction");
      if (!vector) return vector.error();
      bone.direction = *vector;
    } else if (key == "length") {
      const auto number = Number(rest, "length");
      if (!number) return number.error();
      bone.length = *number;
    } else if (key == "axis") {
      const auto vector = Vector(rest, "axis");
      if (!vector) return vector.error();
      bone.axis = *vector;
      auto order = AxisOrder(rest);
      if (!order) return order.error();
      bone.axis_order = *std::move(order);
    } else if (key == "dof") {
      return ParseDofs(rest, bone);
    } else if (key == "limits" || key.substr(0, 1) == "(") {
      return ParseLimit(key == "limits" ? rest : line, bone);
    }
    return {};  // id, bodymass, cofmass.
  }

  Result<void> ParseDofs(std::string_view rest, Bone& bone) {
    for (auto word = text::PopWord(rest); !word.empty(); word = text::PopWord(rest)) {
      const bool rotation = word.size() == 2 && (word[0] == 'r' || word[0] == 'R');
      const auto axis = rotation ? std::string_view("xyz").find(static_cast<char>(word[1] | 0x20))
                                 : std::string_view::npos;
      if (axis == std::string_view::npos) {
        return Fault("bone " + bone.name + ": expected dof rx, ry or rz, found " +
                     text::Quoted(word) + " (bones that slide or stretch are not taken)");
      }
      const auto dof = static_cast<Axis>(axis);
      if (std::find(bone.dofs.begin(), bone.dofs.end(), dof) != bone.dofs.end()) {
        return Fault("bone " + bone.name + ": dof " + std::string(word) + " stands twice");
      }
      bone.dofs.push_back(dof);
    }
    return {};
  }

  Result<void> ParseLimit(std::string_view text, Bone& bone) {
    std::string plain(text);
    for (char& c : plain) {
      if (c == '(' || c == ')' || c == ',') c = ' ';
    }
    std::string_view rest = plain;
    while (!text::Trim(rest).empty()) {
      double limits[2];
      for (int i = 0; i < 2; ++i) {
        const std::string_view word = text::PopWord(rest);
        const auto number = text::ToNumber(word);
        const bool open =
            text::EqualsIgnoringCase(word, "inf") || text::EqualsIgnoringCase(word, "-inf");
        if (!number && !open)
          return Fault("expected limits '(LOW HIGH)', found " + text::Quoted(text));
        limits[i] = number ? *number * out_.units.radians : (i == 0 ? -1 : 1) * body::kUnlimited;
      }
      if (!(limits[0] <= limits[1]))
        return Fault("limits " + text::Quoted(text) + " are the wrong way");
      bone.limits.emplace_back(limits[0], limits[1]);
    }
    return {};
  }

  Result<void> ParseHierarchy() {
    for (; InSection(); Advance()) {
      std::string_view rest = *line_;
      const std::string parent(text::PopWord(rest));
      if (parent == "begin" || parent == "end") continue;
      if (parent != "root" && !Known(parent)) return Fault("no bone " + text::Quoted(parent));
      for (auto word = text::PopWord(rest); !word.empty(); word = text::PopWord(rest)) {
        const std::string child(word);
        if (!Known(child)) return Fault("no bone " + text::Quoted(child));
        if (!parents_.emplace(child, parent).second) {
          return Fault("bone " + child + " has two parents");
        }
        out_.links.emplace_back(parent, child);
      }
    }
    return {};
  }

  bool Known(std::string_view name) const {
    return std::any_of(out_.bones.begin(), out_.bones.end(),
                       [name](const Bone& bone) { return bone.name == name; });
  }

  text::Lines lines_;
  std::optional<std::string_view> line_;
  AsfText out_;
  std::map<std::string, std::string, std::less<>> parents_;
};

}  // namespace

Result<AsfText> ParseAsfText(std::string_view text, const std::string& file) {
  return Parser(text, file).Run();
}

namespace {

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
