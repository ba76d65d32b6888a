#include "daemon/simulation/biped/mjcf.h"

#include <array>
#include <charconv>

#include "common/base/number.h"
#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::biped {
namespace {

using text::Shortest;

std::string Inertial(double below_m, double mass_kg, double x, double y, double z) {
  return "<inertial pos='0 0 " + Shortest(-below_m) + "' mass='" + Shortest(mass_kg) +
         "' diaginertia='" + Shortest(x) + " " + Shortest(y) + " " + Shortest(z) + "'/>\n";
}

std::string Hinge(const char* axis, double armature_kgm2) {
  return std::string("<joint type='hinge' axis='") + axis + "' armature='" +
         Shortest(armature_kgm2) + "'/>\n";
}

std::string Knee(const BipedParameters& p, const std::string& side) {
  const double knee_below_hip_m = p.leg_length_m - p.foot_below_knee_link_com_m;
  return "<body name='" + side + "_knee' pos='0 0 " + Shortest(-knee_below_hip_m) + "'>\n" +
         Inertial(0, p.link_mass_kg, p.link_inertia_across_kgm2, p.link_inertia_across_kgm2,
                  p.link_inertia_along_kgm2) +
         "<joint type='slide' axis='0 0 -1' limited='true' solreflimit='0.01 1' range='" +
         Shortest(p.leg_length_min_m - p.leg_length_m) + " " +
         Shortest(p.leg_length_max_m - p.leg_length_m) + "'/>\n" + "<geom name='" + side +
         "_foot' type='sphere' class='foot' size='" + Shortest(p.foot_radius_m) + "' pos='0 0 " +
         Shortest(-p.foot_below_knee_link_com_m) + "'/>\n</body>\n";
}

std::string Leg(const BipedParameters& p, int leg) {
  const std::string side = leg == kLeft ? "left" : "right";
  return "<body name='" + side + "_hip' pos='0 " + Shortest(Side(leg) * p.hip_half_spacing_m) +
         " " + Shortest(-p.hip_below_body_com_m) + "'>\n" +
         Inertial(p.hip_link_com_below_hip_m, p.link_mass_kg, p.link_inertia_across_kgm2,
                  p.link_inertia_across_kgm2, p.link_inertia_along_kgm2) +
         Hinge("0 0 1", p.hip_armature_kgm2) + Hinge("1 0 0", p.hip_armature_kgm2) +
         Hinge("0 1 0", p.hip_armature_kgm2) +
         "<geom type='capsule' class='shell' size='0.03' fromto='0 0 0 0 0 -0.4'/>\n" +
         Knee(p, side) + "</body>\n";
}

constexpr const char* kSolref = "0.006 1";
constexpr const char* kRolling = "0.0001";  // Rolling friction, m; of no effect with condim 4.

/// Each foot with each geom of the ground, by the same numbers that the geoms have: a foot's come
/// first by its priority.
std::string FootPairs(const BipedParameters& p, const std::vector<std::string>& ground_names) {
  const std::string slides = Shortest(p.sliding_friction), turns = Shortest(p.torsional_friction_m);
  std::string pairs;
  for (const char* foot : {"left_foot", "right_foot"}) {
    for (const std::string& name : ground_names) {
      pairs += "<pair geom1='" + name + "' geom2='" + foot + "' condim='4' solref='" + kSolref +
               "' friction='" + slides + " " + slides + " " + turns + " " + kRolling + " " +
               kRolling + "'/>\n";
    }
  }
  return pairs.empty() ? "" : "<contact>\n" + pairs + "</contact>\n";
}

}  // namespace

std::string WriteMjcf(const BipedParameters& p, const std::string& ground,
                      const std::vector<std::string>& ground_names, double step_s) {
  return "<mujoco>\n<compiler angle='radian' inertiafromgeom='false'/>\n"
         "<option timestep='" +
         Shortest(step_s) + "' integrator='Euler' cone='elliptic' gravity='0 0 " +
         Shortest(-kStandardGravityMps2) +
         "' iterations='50'/>\n"
         "<default>\n<geom solref='" +
         kSolref +
         "'/>\n"
         "<default class='shell'><geom contype='2' conaffinity='1'/></default>\n"
         "<default class='foot'><geom contype='2' conaffinity='1' priority='1' condim='4' "
         "friction='" +
         Shortest(p.sliding_friction) + " " + Shortest(p.torsional_friction_m) + " " + kRolling +
         "'/></default>\n</default>\n<worldbody>\n" + ground +
         "<body name='body' pos='0 0 1'>\n<freejoint/>\n" +
         Inertial(0, p.body_mass_kg, p.body_inertia_roll_kgm2, p.body_inertia_pitch_kgm2,
                  p.body_inertia_yaw_kgm2) +
         "<geom type='capsule' class='shell' size='0.1' fromto='-0.15 0 0 0.15 0 0'/>\n" +
         Leg(p, kLeft) + Leg(p, kRight) + "</body>\n</worldbody>\n" + FootPairs(p, ground_names) +
         "</mujoco>\n";
}

physics::WorldNames Names(const std::vector<std::string>& ground) {
  return {.links = {"body", "left_hip", "left_knee", "right_hip", "right_knee"},
          .hips = {"left_hip", "right_hip"},
          .feet = {"left_foot", "right_foot"},
          .ground = ground};
}

}  // namespace footing::biped
