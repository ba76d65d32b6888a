#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/stream/character.h"
#include "daemon/simulation/biped/track.h"

/// A track that continues itself ahead of a character, so that whoever practises stays on it. The
/// segments follow the direction of travel of the last ten metres: short turns to the left and
/// right leave the track straight, a lasting turn bends it.
namespace footing::terrain {

/// So much of the track lies ahead of the character at least, m.
inline constexpr double kEndlessAheadM = 8;

/// Takes a movement of the body, m, into the average direction of travel, a vector of length 1 or
/// less.
void FollowCourse(const Eigen::Vector2d& moved_m, Eigen::Vector2d& course);

/// The segment that an endless track needs next; none while enough of it lies ahead. `place` is the
/// character's on the track and `p_W_m` where its body is. Beside the ribbon the segment begins
/// under the character.
std::optional<stream::TrackSegment> EndlessSegment(const stream::Track& track,
                                                   const TrackPlace& place,
                                                   const Eigen::Vector2d& p_W_m,
                                                   const Eigen::Vector2d& course);

}  // namespace footing::terrain
