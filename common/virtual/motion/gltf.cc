#include "common/virtual/motion/gltf.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/rotation.h"
#include "common/body/skeleton.h"

namespace footing::motion {
namespace {

using nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedShort = 5123;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr double kBoneWidthM = 0.05;

void AppendUnsigned(std::uint32_t value, std::string& out) {
  for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

void AppendNumber(double value, std::string& out) {
  AppendUnsigned(std::bit_cast<std::uint32_t>(static_cast<float>(value)), out);
}

/// A list of one entry, which braces alone would not make.
ordered_json List(ordered_json one) { return ordered_json::array({std::move(one)}); }

ordered_json Json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// A rotation about W's axes, in the file's: x, y, z, w.
Eigen::Vector4d ToYUp(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d axis = body::ToYUp(Eigen::Vector3d(q.vec()));
  return {axis.x(), axis.y(), axis.z(), q.w()};
}

class GlbWriter {
 public:
  explicit GlbWriter(const Motion& motion) : motion_(motion) {}

  Result<std::string> Write(const std::string& name) {
    const auto joints = static_cast<std::uint64_t>(motion_.skeleton.size());
    const auto frames = static_cast<std::uint64_t>(motion_.frames());
    if (frames * joints > std::numeric_limits<std::uint32_t>::max() / 32) {
      return InvalidData("a motion of " + std::to_string(frames) +
                         " frames does not fit into a glTF file");
    }
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "footing-log"}}},
             {"scene", 0},
             {"scenes", List({{"name", name}, {"nodes", List(0)}})}};
    AddBox();
    AddNodes();
    AddAnimation(name);
    json_["buffers"] = List({{"byteLength", bytes_.size()}});
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    AppendUnsigned(2, file);
    AppendUnsigned(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_.size()), file);
    AppendUnsigned(static_cast<std::uint32_t>(text.size()), file);
    file += "JSON" + text;
    AppendUnsigned(static_cast<std::uint32_t>(bytes_.size()), file);
    return file + std::string("BIN\0", 4) + bytes_;
  }

 private:
  /// Numbers from byte `begin` of the buffer on, as a view and an accessor; its index.
  std::size_t AddAccessor(std::size_t begin, int component, const char* type, std::size_t count,
                          int target = 0) {
    ordered_json view = {
        {"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes_.size() - begin}};
    if (target != 0) view["target"] = target;
    json_["bufferViews"].push_back(view);
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  /// A bone: a box from y = 0 to y = 1.
  void AddBox() {
    for (int i = 0; i < 8; ++i) {
      AppendNumber((i & 1) != 0 ? 0.5 : -0.5, bytes_);
      AppendNumber((i & 2) != 0 ? 1 : 0, bytes_);
      AppendNumber((i & 4) != 0 ? 0.5 : -0.5, bytes_);
    }
    const std::size_t positions = AddAccessor(0, kFloat, "VEC3", 8, kArrayBuffer);
    json_["accessors"][positions]["min"] = {-0.5, 0, -0.5};
    json_["accessors"][positions]["max"] = {0.5, 1, 0.5};
    // Two triangles a side, seen anticlockwise from outside.
    constexpr std::uint8_t kTriangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const std::size_t begin = bytes_.size();
    for (const std::uint8_t corner : kTriangles) bytes_ += {static_cast<char>(corner), '\0'};
    const std::size_t corners =
        AddAccessor(begin, kUnsignedShort, "SCALAR", std::size(kTriangles), kElementArrayBuffer);
    const ordered_json triangles = {{"attributes", {{"POSITION", positions}}},
                                    {"indices", corners}};
    json_["meshes"] = List({{"name", "bone"}, {"primitives", List(triangles)}});
  }

  void AddNodes() {
    const body::Skeleton& skeleton = motion_.skeleton;
    ordered_json& nodes = json_["nodes"] = ordered_json::array();
    for (int i = 0; i < skeleton.size(); ++i) {
      const body::Joint& joint = skeleton.joint(i);
      nodes.push_back({{"name", joint.name}, {"translation", Json(body::ToYUp(joint.offset_m))}});
      if (joint.parent >= 0) nodes[static_cast<std::size_t>(joint.parent)]["children"].push_back(i);
    }
    for (int i = 1; i < skeleton.size(); ++i) {
      const body::Joint& joint = skeleton.joint(i);
      const double length_m = joint.offset_m.norm();
      if (!(length_m > 0)) continue;
      const Eigen::Quaterniond turn =
          LeastTurn(Eigen::Vector3d::UnitY(), body::ToYUp(joint.offset_m));
      nodes[static_cast<std::size_t>(joint.parent)]["children"].push_back(nodes.size());
      nodes.push_back({{"name", joint.name + "_bone"},
                       {"mesh", 0},
                       {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                       {"scale", {kBoneWidthM, length_m, kBoneWidthM}}});
    }
  }

  void AddAnimation(const std::string& name) {
    const auto frames = static_cast<std::size_t>(motion_.frames());
    std::size_t begin = bytes_.size();
    for (std::size_t i = 0; i < frames; ++i) {
      AppendNumber(static_cast<double>(i) / motion_.rate_hz, bytes_);
    }
    const std::size_t times = AddAccessor(begin, kFloat, "SCALAR", frames);
    json_["accessors"][times]["min"] = List(0);
    json_["accessors"][times]["max"] =
        List(static_cast<float>(static_cast<double>(frames - 1) / motion_.rate_hz));
    ordered_json animation = {{"name", name}};
    const auto add = [&](int node, const char* path, std::size_t output) {
      animation["samplers"].push_back({{"input", times}, {"output", output}});
      animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                       {"target", {{"node", node}, {"path", path}}}});
    };
    begin = bytes_.size();
    for (Eigen::Index i = 0; i < motion_.frames(); ++i) {
      const Eigen::Vector3d p = body::ToYUp(Eigen::Vector3d(motion_.q.col(i).head<3>()));
      for (int axis = 0; axis < 3; ++axis) AppendNumber(p(axis), bytes_);
    }
    add(0, "translation", AddAccessor(begin, kFloat, "VEC3", frames));
    for (int j = 0; j < motion_.skeleton.size(); ++j) {
      const body::Joint& joint = motion_.skeleton.joint(j);
      if (joint.rotations.empty()) continue;
      begin = bytes_.size();
      Eigen::Vector4d last = Eigen::Vector4d::Zero();
      for (Eigen::Index i = 0; i < motion_.frames(); ++i) {
        const Eigen::Quaterniond turn(body::JointRotation(joint, motion_.q.col(i)));
        Eigen::Vector4d q = ToYUp(turn.normalized());
        if (q.dot(last) < 0) q = -q;  // The shorter way from frame to frame.
        last = q;
        for (int part = 0; part < 4; ++part) AppendNumber(q(part), bytes_);
      }
      add(j, "rotation", AddAccessor(begin, kFloat, "VEC4", frames));
    }
    json_["animations"] = List(animation);
  }

  const Motion& motion_;
  ordered_json json_;
  std::string bytes_;
};

}  // namespace

Result<std::string> WriteGlb(const Motion& motion, const std::string& name) {
  if (motion.frames() == 0) return InvalidData("a motion without a frame");
  return GlbWriter(motion).Write(name);
}

}  // namespace footing::motion
