#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"

/// MuJoCo behind a small interface: a floating root with two legs of four joints each.
namespace footing::physics {

inline constexpr int kLegs = 2;
inline constexpr int kJoints = 8;
inline constexpr int kLinks = 5;

/// Newton metres for hinges, newtons for slides, in the order of the joints in the MJCF text.
using JointEfforts = std::array<double, kJoints>;

/// Which objects of the MJCF text are what.
struct WorldNames {
  std::array<std::string, kLinks> links;  ///< Bodies; the first one is the root.
  std::array<std::string, kLegs> hips;    ///< Bodies whose origin is a hip's centre.
  std::array<std::string, kLegs> feet;    ///< Geoms; the only ones that should touch the ground.
  std::vector<std::string> ground;        ///< Boxes of the world body that may be moved.
};

/// What is seen of the state. Positions and velocities are of the present state; contact forces
/// are those that acted in the last step.
struct Observation {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< Root's origin, m.
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();  ///< m/s.
  Eigen::Vector3d w_WB = Eigen::Vector3d::Zero();  ///< rad/s.
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  std::array<double, kJoints> joint_position{};                 ///< rad or m.
  std::array<double, kJoints> joint_velocity{};                 ///< rad/s or m/s.
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();               ///< Whole mechanism's COM, m.
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();               ///< m/s.
  std::array<Eigen::Vector3d, kLegs> p_WH{};                    ///< Hips, m.
  std::array<Eigen::Vector3d, kLegs> p_WF{};                    ///< Feet, m.
  std::array<double, kLegs> normal_force_n{};                   ///< Ground on foot.
  Eigen::Vector3d contact_force_W_n = Eigen::Vector3d::Zero();  ///< All contacts together.
  bool other_contact = false;  ///< Something that is not a foot touches.
  bool diverged = false;       ///< A number left its range; MuJoCo has started over by itself.
};

/// All that decides the future, as a plain value; see MuJoCo's remark that qacc_warmstart belongs
/// to it (google-deepmind/mujoco issue 270).
struct WorldState {
  std::uint64_t steps = 0;
  std::array<double, 7 + kJoints> qpos{};
  std::array<double, 6 + kJoints> qvel{};
  std::array<double, 6 + kJoints> qacc_warmstart{};
  std::array<double, kLegs> normal_force_n{};
  Eigen::Vector3d contact_force_W_n = Eigen::Vector3d::Zero();
  bool other_contact = false;
  double root_force_max_n = 0;
};

/// One world. Stepping and observing allocate nothing.
class World {
 public:
  /// `mjcf` must hold the names, one free root and kJoints more degrees of freedom.
  static Result<World> FromMjcf(const std::string& mjcf, const WorldNames& names);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  double step_s() const;
  double mass_kg() const;

  /// Places the root (quaternion from its heading alone), at rest, joints as given.
  void Reset(const Eigen::Vector3d& p_WB_m, double heading_rad,
             const std::array<double, kJoints>& joint_position);
  /// Moves a box of WorldNames::ground and gives it another size. It acts from the next step on.
  void PlaceBox(int index, const Eigen::Vector3d& centre_W_m, const Eigen::Quaterniond& q_WS,
                const Eigen::Vector3d& half_size_m);

  /// One step under joint efforts and a push on the root's COM. No other force is applied to the
  /// root: aborts should one be.
  void Step(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n);
  const Observation& Observe() const;
  /// Origin and orientation of link `index` of WorldNames::links, in the world.
  void LinkPose(int index, Eigen::Vector3d& position_m, Eigen::Quaterniond& orientation) const;

  /// Largest force or torque, other than contact, gravity and pushes, on the root so far.
  double root_force_max_n() const;
  /// FNV-1a over the words of position, velocity, activation and warm start.
  std::uint64_t StateHash() const;
  WorldState Save() const;
  void Restore(const WorldState& state);

  /// The same world stepped by bare mj_step, for measuring what all else costs.
  void StepBare(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n);

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace footing::physics
