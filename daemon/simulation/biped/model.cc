#include "daemon/simulation/biped/model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::biped {
namespace {

struct Field {
  const char* key;
  double BipedParameters::*value;
  double min, max;
};

using P = BipedParameters;
constexpr std::array kFields{
    Field{"body_mass_kg", &P::body_mass_kg, 1, 100},
    Field{"body_inertia_roll_kgm2", &P::body_inertia_roll_kgm2, 0.01, 20},
    Field{"body_inertia_pitch_kgm2", &P::body_inertia_pitch_kgm2, 0.01, 20},
    Field{"body_inertia_yaw_kgm2", &P::body_inertia_yaw_kgm2, 0.01, 20},
    Field{"link_mass_kg", &P::link_mass_kg, 0.01, 20},
    Field{"link_inertia_across_kgm2", &P::link_inertia_across_kgm2, 1e-4, 5},
    Field{"link_inertia_along_kgm2", &P::link_inertia_along_kgm2, 1e-5, 5},
    Field{"leg_length_m", &P::leg_length_m, 0.3, 2},
    Field{"leg_length_min_m", &P::leg_length_min_m, 0.1, 2},
    Field{"leg_length_max_m", &P::leg_length_max_m, 0.3, 3},
    Field{"hip_half_spacing_m", &P::hip_half_spacing_m, 0, 0.5},
    Field{"hip_below_body_com_m", &P::hip_below_body_com_m, -0.5, 0.5},
    Field{"hip_link_com_below_hip_m", &P::hip_link_com_below_hip_m, 0, 1},
    Field{"foot_below_knee_link_com_m", &P::foot_below_knee_link_com_m, 0, 1},
    Field{"foot_radius_m", &P::foot_radius_m, 0.005, 0.1},
    Field{"sliding_friction", &P::sliding_friction, 0.1, 5},
    Field{"torsional_friction_m", &P::torsional_friction_m, 0.001, 0.5},
    Field{"hip_armature_kgm2", &P::hip_armature_kgm2, 0, 1},
};

bool Known(const std::string& key) {
  return key == "version" || key == "name" ||
         std::any_of(kFields.begin(), kFields.end(), [&](const Field& f) { return f.key == key; });
}

}  // namespace

Result<BipedParameters> ParseBiped(const std::string& text, const std::string& origin) {
  const auto read = text::ParseJson(text, origin);
  if (!read) return read.error();
  const auto& root = *read;
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  if (!root.contains("version") || root["version"] != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  for (const auto& [key, value] : root.items()) {
    if (!Known(key)) return InvalidData(origin + ": unknown key " + key);
  }
  BipedParameters parameters;
  for (const Field& field : kFields) {
    if (!root.contains(field.key)) return InvalidData(origin + ": " + field.key + " is missing");
    const auto& value = root[field.key];
    if (!value.is_number() || value < field.min || value > field.max) {
      return InvalidData(origin + ": " + field.key + " is " + value.dump() + ", allowed is " +
                         std::to_string(field.min) + " to " + std::to_string(field.max));
    }
    parameters.*field.value = value;
  }
  const bool ordered = parameters.leg_length_min_m < parameters.leg_length_m &&
                       parameters.leg_length_m < parameters.leg_length_max_m;
  if (!ordered) {
    return InvalidData(origin + ": leg_length_m must lie between leg_length_min_m and _max_m");
  }
  return parameters;
}

BipedParameters On(BipedParameters parameters, const terrain::Surface& surface) {
  if (surface.friction > 0) {
    parameters.torsional_friction_m *= surface.friction / parameters.sliding_friction;
    parameters.sliding_friction = surface.friction;
  }
  parameters.foot_sinks_m = surface.sinks_m;
  return parameters;
}

namespace {

using text::Shortest;

std::string Inertial(double below_m, double mass_kg, double x, double y, double z) {
  return "<inertial pos='0 0 " + Shortest(-below_m) + "' mass='" + Shortest(mass_kg) +
         "' diaginertia='" + Shortest(x) + " " + Shortest(y) + " " + Shortest(z) + "'/>\n";
}

std::string Hinge(const std::string& name, const char* axis, double armature_kgm2) {
  return "<joint name='" + name + "' type='hinge' axis='" + axis + "' armature='" +
         Shortest(armature_kgm2) + "'/>\n";
}

std::string Knee(const BipedParameters& p, const std::string& side) {
  const double knee_below_hip_m = p.leg_length_m - p.foot_below_knee_link_com_m;
  return "<body name='" + side + "_knee' pos='0 0 " + Shortest(-knee_below_hip_m) + "'>\n" +
         Inertial(0, p.link_mass_kg, p.link_inertia_across_kgm2, p.link_inertia_across_kgm2,
                  p.link_inertia_along_kgm2) +
         "<joint name='" + side +
         "_leg_length' type='slide' axis='0 0 -1' limited='true' solreflimit='0.01 1' range='" +
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
         Hinge(side + "_hip_yaw", "0 0 1", p.hip_armature_kgm2) +
         Hinge(side + "_hip_roll", "1 0 0", p.hip_armature_kgm2) +
         Hinge(side + "_hip_pitch", "0 1 0", p.hip_armature_kgm2) +
         "<geom type='capsule' class='shell' size='0.03' fromto='0 0 0 0 0 -0.4'/>\n" +
         Knee(p, side) + "</body>\n";
}

constexpr const char* kSolref = "0.006 1";
constexpr const char* kRolling = "0.0001";  // Rolling friction, m; of no effect with condim 4.
/// Impedance d of soft ground, at any depth, and that of MuJoCo's hard one.
constexpr double kSoftImpedance = 0.5, kHardImpedance = 0.95;

/// Contact of a foot as attributes. At rest a constraint of impedance d and time constant T lets a
/// mass m under the force F sink by (1 - d) T^2 F / m: a spring, which the foot's own mass damps
/// critically. T follows from the wanted depth. With the leg that the foot hangs on, a stepping
/// biped's foot has 1.4 times the mass of its link.
std::string FootContact(const BipedParameters& p) {
  if (p.foot_sinks_m <= 0) return std::string("solref='") + kSolref + "'";
  const double weight_n = p.mass_kg() * kStandardGravityMps2;
  constexpr double kFootLinks = 1.4;
  const double foot_kg = kFootLinks * p.link_mass_kg;
  const double time_s = std::sqrt(p.foot_sinks_m * foot_kg / ((1 - kSoftImpedance) * weight_n));
  const std::string d = Shortest(kSoftImpedance);
  return "solref='" + Shortest(time_s) + " 1' solimp='" + d + " " + d + " 0.001'";
}

/// Only its normal yields: along the soft ground a foot holds as stiffly as on hard ground. The
/// option is the ratio of both regularisations (1 - d) / d.
std::string FrictionImpedance(const BipedParameters& p) {
  if (p.foot_sinks_m <= 0) return "";
  const auto yields = [](double d) { return (1 - d) / d; };
  return " impratio='" + Shortest(yields(kSoftImpedance) / yields(kHardImpedance)) + "'";
}

/// Each foot with each geom of the ground, by the same numbers that the geoms have: a foot's come
/// first by its priority.
std::string FootPairs(const BipedParameters& p, const std::vector<std::string>& ground_names) {
  const std::string slides = Shortest(p.sliding_friction), turns = Shortest(p.torsional_friction_m);
  std::string pairs;
  for (const char* foot : {"left_foot", "right_foot"}) {
    for (const std::string& name : ground_names) {
      pairs += "<pair geom1='" + name + "' geom2='" + foot + "' condim='4' " + FootContact(p) +
               " friction='" + slides + " " + slides + " " + turns + " " + kRolling + " " +
               kRolling + "'/>\n";
    }
  }
  return pairs.empty() ? "" : "<contact>\n" + pairs + "</contact>\n";
}

}  // namespace

std::string WriteMjcf(const BipedParameters& p, const std::string& ground,
                      const std::vector<std::string>& ground_names, double step_s,
                      const std::string& more) {
  return "<mujoco>\n<compiler angle='radian' inertiafromgeom='false'/>\n"
         "<option timestep='" +
         Shortest(step_s) + "' integrator='Euler' cone='elliptic' gravity='0 0 " +
         Shortest(-kStandardGravityMps2) + "' iterations='50'" + FrictionImpedance(p) +
         "/>\n"
         "<default>\n<geom solref='" +
         kSolref +
         "'/>\n"
         "<default class='shell'><geom contype='2' conaffinity='1'/></default>\n"
         "<default class='foot'><geom contype='2' conaffinity='1' priority='1' condim='4' " +
         FootContact(p) + " friction='" + Shortest(p.sliding_friction) + " " +
         Shortest(p.torsional_friction_m) + " " + kRolling +
         "'/></default>\n</default>\n<worldbody>\n" + ground +
         "<body name='body' pos='0 0 1'>\n<freejoint/>\n" +
         Inertial(0, p.body_mass_kg, p.body_inertia_roll_kgm2, p.body_inertia_pitch_kgm2,
                  p.body_inertia_yaw_kgm2) +
         "<geom type='capsule' class='shell' size='0.1' fromto='-0.15 0 0 0.15 0 0'/>\n" +
         Leg(p, kLeft) + Leg(p, kRight) + "</body>\n</worldbody>\n" + FootPairs(p, ground_names) +
         more + "</mujoco>\n";
}

std::string MotorsMjcf() {
  std::string motors = "<actuator>\n";
  for (const std::string side : {"left", "right"}) {
    for (const char* joint : {"_hip_yaw", "_hip_roll", "_hip_pitch", "_leg_length"}) {
      motors += "<motor name='" + side + joint + "' joint='" + side + joint + "'/>\n";
    }
  }
  return motors + "</actuator>\n";
}

physics::WorldNames Names(const std::vector<std::string>& ground) {
  return {.links = {"body", "left_hip", "left_knee", "right_hip", "right_knee"},
          .hips = {"left_hip", "right_hip"},
          .feet = {"left_foot", "right_foot"},
          .ground = ground};
}

stream::Skeleton DescribeSkeleton(const BipedParameters& parameters) {
  const Eigen::Vector3d hip_size_m(0.08, 0.08, 2 * parameters.hip_link_com_below_hip_m);
  const Eigen::Vector3d knee_size_m(0.05, 0.05, 2 * parameters.foot_below_knee_link_com_m);
  stream::Skeleton skeleton;
  skeleton.name = "bird";
  skeleton.links = {{"body", -1, {0.5, 0.2, 0.2}},
                    {"left_hip", 0, hip_size_m},
                    {"left_knee", 1, knee_size_m},
                    {"right_hip", 0, hip_size_m},
                    {"right_knee", 3, knee_size_m}};
  skeleton.contact_points = {"left_foot", "right_foot"};
  return skeleton;
}

}  // namespace footing::biped
