#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/motion/leg_solver.h"
#include "common/virtual/motion/motion.h"

namespace footing::virtual_sensors {

/// How a clip becomes something that boards can be calibrated under.
struct SceneOptions {
  bool t_pose = true;        ///< Prepend a T-pose; false: the clip begins with one.
  double hold_s = 6;         ///< Duration of the T-pose,
  double leave_s = 1.5;      ///< then of its transition to the clip's first frame.
  double rest_share = 0.42;  ///< Where the weight is in a standing foot: of heel to toe.
  double loop_s = 0;         ///< Total duration, forwards and backwards; 0: once.
};

/// A body in motion over the ground and what the ground feels of it.
struct Scene {
  body::Body body;
  motion::Motion motion;
  BodyCourse course;
  GroundReaction reaction;
};

/// Turns the clip forward, puts it on the floor (its feet as high as in the T-pose),
/// prepends the T-pose, leaning so that the centre of mass is over the soles, on feet that stand as
/// in the clip's first frame, and computes the forces. InvalidData when a landmark is missing, the
/// person cannot be, or the clip has fewer than two frames; `origin` names the clip.
Result<Scene> MakeScene(motion::Motion clip, const body::PersonParameters& person,
                        const SceneOptions& options, const std::string& origin);

/// The same scene `by` further over the floor.
void Shift(const Eigen::Vector2d& by, Scene& scene);

/// The middle of a sole in one frame, W.
Eigen::Vector3d SoleMiddle(const BodyCourse& course, std::size_t foot, Eigen::Index frame);

/// ShareBetweenFeet of every frame. `progress`, if any, hears the share that is done, a few times
/// a second of work.
std::vector<std::array<FootForce, kFeet>> ShareThroughout(
    const Scene& scene, const std::function<void(double done)>& progress = nullptr);

/// Where both feet of a pose are: their ankle joints in W.
using FeetPlaces = std::array<motion::FootPlace, kFeet>;

/// A person who stands where a motion begins, and begins it without moving a foot: nobody slides
/// over a board that carries him.
class Stance {
 public:
  /// The feet stand as in `t_pose`, flat on the ground, but pointing as in `first_q`, the motion's
  /// first frame, and below its ankles, or as near to them as a person stands. The thighs are
  /// turned about themselves as there: a person's legs stay so while he straightens up. The person
  /// faces along x. `body` must outlive it.
  Stance(const body::Body& body, const Eigen::VectorXd& t_pose, const Eigen::VectorXd& first_q);

  /// Moves `q` over the feet and down as far as the legs are too short for their width, and bends
  /// the legs so that they reach them.
  void StandOver(Eigen::VectorXd& q);
  /// Bends the legs of `q` so that the feet are on their way, `share` of it from the stance (0) to
  /// where they are in the first frame of the motion (1); a foot on the ground is there already.
  void KeepFeet(double share, Eigen::VectorXd& q);

 private:
  FeetPlaces Places(const Eigen::VectorXd& q) const;

  const body::Body& body_;
  std::array<motion::LegSolver, kFeet> legs_;
  FeetPlaces stance_, first_;
};

}  // namespace footing::virtual_sensors
