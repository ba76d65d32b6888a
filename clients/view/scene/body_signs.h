#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "clients/view/scene/part.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// A word beside a point of the world.
struct Label {
  Eigen::Vector3f at_m = Eigen::Vector3f::Zero();
  std::string text;
  Colour colour = Colour::Ones();
};

/// What is drawn of a body's balance, besides itself.
struct BodySigns {
  PartList solid;  ///< Arrows, rings, the COM: they show through the body.
  PartList clear;  ///< Discs on the ground that show what is under them.
  std::vector<Label> labels;
};

/// Where the COM's projection was lately, oldest first.
struct ComTrail {
  struct Point {
    double time_s = 0;
    Eigen::Vector3f at_m;
  };
  std::deque<Point> points;

  /// Keeps the last 4 s of simulation time; a step back in time restarts it.
  void Add(double time_s, const Eigen::Vector3d& com_m);
};

/// Half axes (x, y) of the ellipse that holds a foot in 86 of 100 cases: two standard deviations.
Eigen::Vector2f FootEllipse(const BodyFoot& foot);

/// Force at each foot's COP, the total COP, the COM with its projection and trail, momentum,
/// angular momentum, and how certain the places of the feet are.
void AddBodySigns(const CharacterPose& pose, const ComTrail& trail, BodySigns& signs);

}  // namespace footing::scene
