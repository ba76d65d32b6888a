#pragma once

#include <array>
#include <vector>

#include "daemon/simulation/biped/clearance.h"
#include "daemon/simulation/biped/compile.h"
#include "daemon/simulation/biped/world.h"

namespace footing::physics {

inline constexpr int kRootDofs = 6;
inline constexpr int kDofs = kRootDofs + kJoints;

/// What a World owns.
struct World::Parts {
  ModelPointer model;
  StatePointer state;
  std::array<int, kLinks> links{};
  std::array<int, kLegs> hips{};
  std::array<int, kLegs> feet{};
  std::vector<int> ground;
  Clearance clearance;
  double mass_kg = 0;
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
