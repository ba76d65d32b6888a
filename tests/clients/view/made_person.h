#pragma once

#include <vector>

#include "clients/view/scene/model.h"
#include "common/body/landmarks.h"
#include "common/body/skeleton.h"

/// A made stream of the pose engine: a person on two boards who crouches and swings the arms, the
/// boards' samples, and a reference beside.
namespace footing::scene::made {

struct PersonWish {
  bool calibrated = true;
  double calibration_progress = 0.6;
  bool left_foot_off = false;  ///< For 1.4 s already.
  bool reference = true;
  double lag_s = 0;
  bool valid = true;
};

stream::Skeleton PersonSkeleton();

/// A turn of a joint about an axis of W, after all before it.
struct Bend {
  body::Landmark landmark;
  body::Axis axis;
  double angle_rad = 0;
};
/// The T-pose with these turns, the root where it was.
PersonPose Bent(const std::vector<Bend>& bends);

/// The tick at `time_s`; the first one (time 0) carries what a snapshot carries.
Update PersonTickAt(double time_s, const PersonWish& wish);

/// A model after `seconds` of it, at 100 Hz from time 0.
Model PersonModelAfter(double seconds, const PersonWish& wish);

}  // namespace footing::scene::made
