#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "clients/view/scene/part.h"
#include "clients/view/scene/update.h"
#include "common/stream/hands.h"

namespace footing::scene {

/// A word beside a point of the world.
struct Label {
  Eigen::Vector3f at_m = Eigen::Vector3f::Zero();
  std::string text;
  Colour colour = Colour::Ones();
};

/// Signs of a body's balance, drawn besides the body.
struct BodySigns {
  PartList solid;  ///< Arrows, rings, the COM: they show through the body.
  PartList clear;  ///< Discs on the ground that show what is under them.
  std::vector<Label> labels;
};

/// Recent path of the COM's projection, oldest first.
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

/// Adds an arrow; nothing where it has no length.
void AddArrow(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius_m,
              const Colour& colour, PartList& parts);

/// Normal force of the ground for an arrow of 1 m.
inline constexpr double kForcePerMetreN = 600;

/// Adds arrows at the feet, along the ground's normal force.
void AddForceArrows(const CharacterPose& pose, PartList& parts);

/// Last sample of one tracker for one hand or other joint.
struct SeenHand {
  stream::HandSample newest;
  std::int64_t received_ns = 0;            ///< On the viewer's clock.
  std::optional<stream::HandSample> seen;  ///< The last one with a place.
};

/// Takes a sample in: one entry for each hand and joint of each tracker.
void TakeHand(const stream::HandSample& sample, std::int64_t received_ns,
              std::vector<SeenHand>& hands);

/// Half axes of the ellipsoid of two standard deviations (columns: its axes in W, of the length of
/// a half axis), from 8 mm, so that it can be seen, to 0.6 m.
Eigen::Matrix3f HandEllipsoid(const stream::HandSample& sample);

/// Each observation of this rig with its ellipsoid, in its side's colour, white in the body's
/// middle. One that is hidden, partly or wholly, or too bright is grey and says so; a hand or joint
/// that is not seen has a small grey ball where it was last. Nothing of a tracker that is silent
/// for half a second.
void AddHandSigns(const std::vector<SeenHand>& hands, const std::string& rig, std::int64_t now_ns,
                  BodySigns& signs);

}  // namespace footing::scene
