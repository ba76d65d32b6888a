#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/scene/body_signs.h"
#include "common/stream/hands.h"

namespace footing::scene {

/// What one tracker said last of one hand or other joint.
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
