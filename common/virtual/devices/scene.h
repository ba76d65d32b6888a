#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/body_course.h"
#include "common/virtual/devices/ground_reaction.h"

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

/// How high the lowest foot is over where it stands in the T-pose, by ankles and balls: tips of
/// toes point into the ground in much recorded motion. In a quarter of the frames some foot is
/// lower. The motion has frames.
double FloorHeight(const motion::Motion& motion, const body::Landmarks& landmarks);

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

}  // namespace footing::virtual_sensors
