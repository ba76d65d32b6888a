#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

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

/// Observation of the state. Positions and velocities are of the present state; contact forces
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

struct WorldModel;

/// One world. Stepping and observing allocate nothing.
class World {
 public:
  /// `mjcf` must hold the names, one free root and kJoints more degrees of freedom.
  static Result<World> FromMjcf(const std::string& mjcf, const WorldNames& names);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Step of the physics.
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
  /// Reads the present state, in W.
  const Observation& Observe() const;
  /// Origin and orientation of link `index` of WorldNames::links, in the world.
  void LinkPose(int index, Eigen::Vector3d& position_m, Eigen::Quaterniond& orientation) const;

  /// Largest force or torque, other than contact, gravity and pushes, on the root so far.
  double root_force_max_n() const;
  /// FNV-1a over the words of position, velocity, activation and warm start.
  std::uint64_t StateHash() const;
  /// Everything that changes with time, as a value, and back to it.
  WorldState Save() const;
  void Restore(const WorldState& state);

  /// Another state of the same world: one model and one ground, whose boxes move for both. For one
  /// thread, as this one. Restore first.
  World Twin() const;

  /// The same world stepped by bare mj_step, for measuring what all else costs.
  void StepBare(const JointEfforts& efforts, const Eigen::Vector3d& push_W_n);

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);
  static std::unique_ptr<Parts> MakeParts(std::shared_ptr<WorldModel> shared);
  std::unique_ptr<Parts> parts_;
};

/// Which pairs of geoms the next step has to look at.
///
/// Upright, only the feet can touch the ground; the other geoms of the mechanism (its shells) are
/// half a metre above it. MuJoCo would nevertheless sort the bodies by their boxes and compare
/// each shell with each geom of the ground, every step. Where the model lists each foot with each
/// geom of the ground as a pair, a world whose shells are clear of the ground looks at these pairs
/// alone. The contacts, and their order, are the same: a pair has the numbers of its geoms.
class Clearance {
 public:
  Clearance() = default;
  /// `feet`: geoms. Geoms of the world body must be boxes or planes.
  Clearance(const mjModel& model, const std::vector<int>& feet);

  /// Reads geom `geom` of the ground again, after it was moved or changed.
  void MoveGround(const mjModel& model, int geom);
  /// True when no shell can touch the ground within the step to come, as of the positions that
  /// `state` has.
  bool FeetAlone(const mjModel& model, const mjData& state) const;

 private:
  /// A box, or a plane as a box without ends below its face.
  struct Ground {
    Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R_GW = Eigen::Matrix3d::Identity();
    Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  };
  static bool Reaches(const Ground& ground, const Eigen::Vector3d& centre_W_m, double radius_m);

  std::vector<Ground> ground_;  ///< By geom; the world body's are the model's first ones.
  std::vector<int> shells_;
  bool pairs_complete_ = false;
};

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteState {
  void operator()(mjData* state) const { mj_deleteData(state); }
};
using ModelPointer = std::unique_ptr<mjModel, DeleteModel>;
using StatePointer = std::unique_ptr<mjData, DeleteState>;

/// Compiles MJCF text without touching a file (MuJoCo's own virtual file system), and keeps
/// MuJoCo's warnings from its log file: they are counted in mjData and read from there.
Result<ModelPointer> Compile(const std::string& mjcf);

/// The id of a named object, or an Error that says which is missing.
Result<int> IdOf(const mjModel& model, mjtObj type, const std::string& name);

inline constexpr int kRootDofs = 6;
inline constexpr int kDofs = kRootDofs + kJoints;

/// MuJoCo's model, and where the links are in it.
struct WorldModel {
  ModelPointer model;
  std::array<int, kLinks> links{};
  std::array<int, kLegs> hips{};
  std::array<int, kLegs> feet{};
  std::vector<int> ground;
  Clearance clearance;
  double mass_kg = 0;
};

/// A model, which twins share, and its state.
struct World::Parts {
  std::shared_ptr<WorldModel> shared;
  StatePointer state;
  std::uint64_t steps = 0;
  /// As integrated: mj_step1 normalises qpos in place, and doing so twice may change the last bit.
  std::array<double, 4> root_quaternion{1, 0, 0, 0};
  double root_force_max_n = 0;
  Observation observation;
};

/// Reads the forces that acted in the step just made, before the next step's contacts are found.
void ReadContacts(const mjModel& model, mjData& state, const std::array<int, kLegs>& feet,
                  Observation& observation);
/// Reads positions and velocities after mj_step1 has computed them.
void ReadMotion(const mjModel& model, const mjData& state, const std::array<int, kLinks>& links,
                const std::array<int, kLegs>& hips, const std::array<int, kLegs>& feet,
                double mass_kg, Observation& observation);
/// Largest entry, N or N m, of what acts on the root beside contact, gravity and the push.
double HiddenRootForce(const mjModel& model, const mjData& state, int root,
                       const Eigen::Vector3d& push_W_n);

}  // namespace footing::physics
