#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/world.h"

/// The biped of Shiratori & Hodgins 2008, Figure 4: a body, two hips of three hinges, two
/// telescoping knees; fourteen degrees of freedom.
namespace footing::biped {

/// Masses and inertias are the paper's. It leaves the geometry open ("leg length about 1 m"); the
/// defaults here are in biped.json, and docs/gait.md says how little hangs on them.
/// In the body frame B x is forward, y left, z up, so Figure 4's diagonal is (roll, pitch, yaw).
struct BipedParameters {
  double body_mass_kg = 0;
  double body_inertia_roll_kgm2 = 0;
  double body_inertia_pitch_kgm2 = 0;
  double body_inertia_yaw_kgm2 = 0;
  double link_mass_kg = 0;              ///< Mass of each hip link and each knee link.
  double link_inertia_across_kgm2 = 0;  ///< About its own COM.
  double link_inertia_along_kgm2 = 0;
  double leg_length_m = 0;  ///< Hip to foot at joint position zero.
  double leg_length_min_m = 0;
  double leg_length_max_m = 0;
  double hip_half_spacing_m = 0;
  double hip_below_body_com_m = 0;
  double hip_link_com_below_hip_m = 0;
  double foot_below_knee_link_com_m = 0;
  double foot_radius_m = 0;
  double sliding_friction = 0;
  double torsional_friction_m = 0;
  double hip_armature_kgm2 = 0;  ///< The hip drives' rotors.
  double foot_sinks_m = 0;       ///< One foot under the whole weight; not in the file, see On.

  double mass_kg() const { return body_mass_kg + 4 * link_mass_kg; }
};

/// Reads biped.json: every field above, nothing unknown, all in range. `origin` names the file.
Result<BipedParameters> ParseBiped(const std::string& text, const std::string& origin);

/// The biped with its feet on a ground like that: both frictions change in proportion.
BipedParameters On(BipedParameters parameters, const terrain::Surface& surface);

/// The whole world as MJCF text: options, `ground` (geoms of the world body), the biped.
/// Contact: the feet's friction holds whatever ground they touch; solref 6 ms, critically damped,
/// or as slow as lets a foot sink.
/// The feet and the geoms of `ground_names` are also listed as pairs (Clearance in world.h).
/// `more`: further sections at the end.
std::string WriteMjcf(const BipedParameters& parameters, const std::string& ground,
                      const std::vector<std::string>& ground_names, double step_s,
                      const std::string& more = "");

/// A section for WriteMjcf: a motor for each joint, of gear 1, in the order and the units of
/// physics::JointEfforts. The engine itself has none: it applies its efforts to the joints.
std::string MotorsMjcf();

/// The names WriteMjcf gives, and those of the ground's boxes that may be moved.
physics::WorldNames Names(const std::vector<std::string>& ground = {});

/// Five links (body, left hip, left knee, right hip, right knee) and the contact points left_foot
/// and right_foot. A link's frame is its own body frame: the body's COM, the hip's centre, the
/// knee link's COM.
stream::Skeleton DescribeSkeleton(const BipedParameters& parameters);

}  // namespace footing::biped
