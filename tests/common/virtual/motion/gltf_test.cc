#include "common/virtual/motion/gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/edit.h"

namespace footing::motion {
namespace {

using nlohmann::json;

/// Reads a binary glTF by the rules of its specification, and gives the numbers of accessors.
class GlbReader {
 public:
  explicit GlbReader(const std::string& file) {
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(U32(file, 4), 2u);
    EXPECT_EQ(U32(file, 8), file.size());
    const std::uint32_t text = U32(file, 12);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    EXPECT_EQ(text % 4, 0u);
    document = json::parse(file.substr(20, text));
    const std::size_t binary = 20 + text;
    EXPECT_EQ(file.substr(binary + 4, 4), std::string("BIN\0", 4));
    bytes_ = file.substr(binary + 8);
    EXPECT_EQ(U32(file, binary), bytes_.size());
    EXPECT_EQ(bytes_.size() % 4, 0u);
    EXPECT_EQ(document["asset"]["version"], "2.0");
    EXPECT_EQ(document["buffers"].size(), 1u);
    EXPECT_EQ(document["buffers"][0]["byteLength"], bytes_.size());
  }

  std::vector<std::vector<double>> Numbers(std::size_t index) const {
    const json& accessor = document["accessors"].at(index);
    const json& view = document["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const auto type = accessor["type"].get<std::string>();
    const std::size_t parts = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    const bool is_float = accessor["componentType"] == 5126;
    const std::size_t size = is_float ? 4 : 2, count = accessor["count"];
    const std::size_t begin = view["byteOffset"];
    EXPECT_EQ(begin % size, 0u);
    EXPECT_EQ(view["byteLength"], count * parts * size);
    EXPECT_LE(begin + count * parts * size, bytes_.size());
    std::vector<std::vector<double>> rows(count);
    for (std::size_t i = 0; i < count * parts; ++i) {
      float real = 0;
      std::uint16_t whole = 0;
      std::memcpy(is_float ? static_cast<void*>(&real) : &whole, bytes_.data() + begin + i * size,
                  size);
      rows[i / parts].push_back(is_float ? double{real} : whole);
    }
    for (const auto& [key, sign] : {std::pair("min", 1), {"max", -1}}) {
      if (!accessor.contains(key)) continue;
      for (std::size_t part = 0; part < parts; ++part) {
        double most = 1e9;
        for (const auto& row : rows) most = std::min(most, sign * row[part]);
        EXPECT_EQ(float(sign * most), accessor[key][part].get<float>()) << key;
      }
    }
    return rows;
  }

  json document;

 private:
  static std::uint32_t U32(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  }
  std::string bytes_;
};

TEST(Gltf, ItsAnimationMovesTheNodesToTheJoints) {
  Motion motion{body::StandardPerson(1.75), 50, 0, {}};
  motion.q.resize(motion.skeleton.dof, 30);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    for (int dof = 0; dof < motion.skeleton.dof; ++dof) {
      motion.q(dof, i) = 0.5 * std::sin(0.1 * static_cast<double>(i) + dof);
    }
  }
  const Motion humanoid = Humanoid(motion).value();
  const auto file = WriteGlb(humanoid, "walk");
  ASSERT_TRUE(file.ok()) << file.error().message;
  const GlbReader glb(*file);
  const json& nodes = glb.document["nodes"];
  const auto joints = static_cast<std::size_t>(humanoid.skeleton.size());
  std::set<std::size_t> children;
  for (const json& node : nodes) {
    if (!node.contains("children")) continue;
    for (const std::size_t child : node["children"]) {
      EXPECT_LT(child, nodes.size());
      EXPECT_TRUE(children.insert(child).second) << "a node with two parents";
    }
  }
  EXPECT_EQ(children.size(), nodes.size() - 1);  // All but the root.
  EXPECT_EQ(glb.document["scenes"][0]["nodes"], json::array({0}));
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  for (const auto& corner : glb.Numbers(primitive["indices"])) EXPECT_LT(corner[0], 8);
  (void)glb.Numbers(primitive["attributes"]["POSITION"]);

  const json& animation = glb.document["animations"].at(0);
  std::vector<std::vector<std::vector<double>>> turns(joints);
  std::vector<std::vector<double>> root;
  for (const json& channel : animation["channels"]) {
    const json& sampler = animation["samplers"].at(channel["sampler"].get<std::size_t>());
    const auto times = glb.Numbers(sampler["input"]);
    ASSERT_EQ(times.size(), 30u);
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i][0], times[i - 1][0]);
    auto numbers = glb.Numbers(sampler["output"]);
    ASSERT_EQ(numbers.size(), times.size());
    const std::size_t node = channel["target"]["node"];
    if (channel["target"]["path"] == "translation") {
      EXPECT_EQ(node, 0u);
      root = std::move(numbers);
    } else {
      turns.at(node) = std::move(numbers);
    }
  }
  body::Kinematics at(humanoid.skeleton);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const auto i = static_cast<std::size_t>(frame);
    body::ComputeKinematics(humanoid.skeleton, humanoid.q.col(frame), at);
    std::vector<Eigen::Isometry3d> X(joints);
    for (std::size_t j = 0; j < joints; ++j) {
      Eigen::Isometry3d own = Eigen::Isometry3d::Identity();
      const auto offset = j == 0 ? root.at(i) : nodes[j]["translation"].get<std::vector<double>>();
      own.translation() = Eigen::Vector3d(offset.data());
      if (!turns[j].empty()) {
        const auto& q = turns[j].at(i);
        const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
        EXPECT_NEAR(turn.norm(), 1, 1e-6);
        own.linear() = turn.normalized().toRotationMatrix();
      }
      const int parent = humanoid.skeleton.joints[j].parent;
      X[j] = parent < 0 ? own : X[static_cast<std::size_t>(parent)] * own;
      EXPECT_EQ(nodes[j]["name"], humanoid.skeleton.joints[j].name);
      EXPECT_LT((X[j].translation() - body::ToYUp(at.p_WJ[j])).norm(), 1e-5) << frame << " " << j;
    }
  }
}

}  // namespace
}  // namespace footing::motion
