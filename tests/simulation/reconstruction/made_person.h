#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/motion.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::reconstruction {

inline constexpr double kMadeRateHz = 60;
inline constexpr double kMadeStandS = 6;

inline body::Body MadePerson() {
  body::PersonParameters parameters;
  parameters.mass_kg = 70;
  parameters.height_m = 1.75;
  return body::MakeBody(body::StandardPerson(1.75), parameters).value();
}

/// A pose with the knees bent so far (0: the T-pose) and the arms lowered so far, feet flat where
/// they are.
inline Eigen::VectorXd Crouch(const body::Body& person, double bend_rad, double arms_rad) {
  const body::Skeleton& skeleton = person.skeleton;
  Eigen::VectorXd q = body::TPose(skeleton, person.landmarks);
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, q, at);
  const auto ankle = static_cast<std::size_t>(person.landmarks[body::Landmark::kLeftAnkle]);
  const Eigen::Vector3d before = at.p_WJ[ankle];
  // About y, forwards positive: thigh back, shank ahead, foot level.
  const auto turn = [&](body::Landmark left, double angle_rad) {
    for (const body::Landmark landmark : {left, body::Mirrored(left)}) {
      body::ComputeKinematics(skeleton, q, at);
      const int index = person.landmarks[landmark];
      const body::Joint& joint = skeleton.joint(index);
      body::SetJointRotation(joint,
                             at.R_WJ[static_cast<std::size_t>(joint.parent)].transpose() *
                                 body::AxisRotation(body::Axis::kY, angle_rad) *
                                 at.R_WJ[static_cast<std::size_t>(index)],
                             q);
    }
  };
  turn(body::Landmark::kLeftHip, -bend_rad);
  turn(body::Landmark::kLeftKnee, 2 * bend_rad);
  turn(body::Landmark::kLeftAnkle, -bend_rad);
  for (const double side : {1.0, -1.0}) {
    const body::Landmark shoulder =
        side > 0 ? body::Landmark::kLeftShoulder : body::Mirrored(body::Landmark::kLeftShoulder);
    body::ComputeKinematics(skeleton, q, at);
    const int index = person.landmarks[shoulder];
    const body::Joint& joint = skeleton.joint(index);
    body::SetJointRotation(joint,
                           at.R_WJ[static_cast<std::size_t>(joint.parent)].transpose() *
                               body::AxisRotation(body::Axis::kX, -side * arms_rad) *
                               at.R_WJ[static_cast<std::size_t>(index)],
                           q);
  }
  body::ComputeKinematics(skeleton, q, at);
  q.head<3>() += before - at.p_WJ[ankle];
  return q;
}

/// A T-pose, then crouches and arm movements out of step with each other.
inline motion::Motion MadeMotion(const body::Body& person, double seconds) {
  motion::Motion motion;
  motion.skeleton = person.skeleton;
  motion.rate_hz = kMadeRateHz;
  const auto frames = static_cast<Eigen::Index>(seconds * kMadeRateHz);
  motion.q.resize(person.skeleton.dof, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    const double t = std::max(0.0, static_cast<double>(i) / kMadeRateHz - kMadeStandS);
    motion.q.col(i) = Crouch(person, 0.35 * (1 - std::cos(2.1 * t)), 0.6 * (1 - std::cos(1.3 * t)));
  }
  return motion;
}

/// Inputs from the boards and the hands' sensors for a motion, a frame each.
inline std::vector<Inputs> Measured(const body::Body& person, const motion::Motion& motion,
                                    double hand_noise_m = 0) {
  namespace sensors = virtual_sensors;
  const sensors::BodyCourse course = sensors::Follow(person, motion);
  const sensors::GroundReaction reaction = sensors::React(course);
  std::array<sensors::BoardPlace, 2> boards = sensors::SideBySide();
  for (std::size_t f = 0; f < 2; ++f) {
    boards[f].middle_m = course.sole_m[f][0].col(0).head<2>();
  }
  body::Kinematics at(person.skeleton);
  noise::Random random(3);
  std::vector<Inputs> inputs;
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Inputs input;
    input.loads.time_s = static_cast<double>(i) / motion.rate_hz;
    const auto feet = sensors::ShareBetweenFeet(course, reaction, i);
    for (std::size_t f = 0; f < 2; ++f) {
      const auto places = sensors::SensorPlaces(boards[f]);
      const auto load = sensors::LoadBoard(boards[f], feet[f]);
      input.loads.feet[f].valid = true;
      input.loads.feet[f].count = 4;
      for (std::size_t k = 0; k < 4; ++k) {
        input.loads.feet[f].cells[k] = {{places[k].x(), places[k].y(), 0}, load.corners_n[k]};
      }
    }
    body::ComputeKinematics(person.skeleton, motion.q.col(i), at);
    for (int side = 0; side < 2; ++side) {
      const body::Point fist = body::Fist(person, side);
      const auto joint = static_cast<std::size_t>(fist.joint);
      HandInput& hand = input.hands[static_cast<std::size_t>(side)];
      hand.valid = true;
      hand.p_W_m = body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]);
      for (double& value : hand.p_W_m) value += hand_noise_m * random.Normal();
    }
    inputs.push_back(input);
  }
  return inputs;
}

/// A basis of the poses of a motion, as the models' reader makes it of a file.
inline NamedModel BasisOf(const body::Body& person, const motion::Motion& motion) {
  const pose::PoseBasis fit = pose::FitBasis(motion.q, {});
  const auto dof = static_cast<std::uint32_t>(fit.dof());
  const std::vector<std::string> names = body::DofNames(person.skeleton);
  NamedModel named{"made.fmodel", {.kind = "basis", .provenance = {}, .tensors = {}}};
  std::vector<float> mean, scale(dof, 1), components(std::size_t{dof} * dof), variances(dof);
  for (const double value : fit.mean) mean.push_back(static_cast<float>(value));
  for (std::size_t i = 0; i < 3; ++i) scale[i] = 2.5;
  for (Eigen::Index k = 0; k < fit.size(); ++k) {
    variances[static_cast<std::size_t>(k)] = static_cast<float>(fit.sd(k) * fit.sd(k));
    for (Eigen::Index i = 0; i < fit.dof(); ++i) {
      components[static_cast<std::size_t>(k * fit.dof() + i)] = static_cast<float>(
          fit.modes(i, k) * static_cast<double>(scale[static_cast<std::size_t>(i)]));
    }
  }
  named.model.tensors = {{"mean", {dof}, mean, names},
                         {"scale", {dof}, scale, names},
                         {"components", {dof, dof}, components, names},
                         {"variances", {dof}, variances}};
  return named;
}

}  // namespace footing::reconstruction
