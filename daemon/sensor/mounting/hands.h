#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/contacts.h"
#include "common/stream/hands.h"

/// Points of a body that trackers see, loads that insoles feel, and the true poses of simulated
/// bodies: what of them is taken.
namespace footing::hands {

inline constexpr std::size_t kMostJoints = 64;
inline constexpr std::size_t kMostCells = 16;
inline constexpr double kFarthestCellM = 1;  ///< From the origin of what its source sits on.
inline constexpr double kMostLoadN = 10'000;

/// What is wrong with a frame and what it must be, in one line; empty when it can be taken: a
/// place within 10 m, a standard deviation in (0, 1] m along each axis (any with confidence 0),
/// covariances that belong to them, a confidence in [0, 1], the role of a hand or a joint, each
/// once, 1 to 16 points, an age in [0, 1] s, names of at most 64 printable characters.
std::string Problem(const stream::HandFrame& frame);

/// The same of a pose: 1 to 64 joints within 10 m, a centre of mass alike, parents before their
/// children.
std::string Problem(const stream::ReferenceFrame& frame);

/// The same of an insole: a foot, 1 to 16 cells within 1 m of its frame's origin, loads within
/// 10 000 N of zero.
std::string Problem(const stream::ContactFrame& frame);

/// A frame without a problem as samples, one a point. Without a rig they are of `default_rig`.
std::vector<stream::HandSample> ToSamples(const stream::HandFrame& frame, std::int64_t received_ns,
                                          const std::string& default_rig);

stream::ContactSample ToSample(const stream::ContactFrame& frame, std::int64_t received_ns,
                               const std::string& default_rig);

stream::ReferencePose ToPose(const stream::ReferenceFrame& frame, std::int64_t received_ns,
                             const std::string& default_rig);

}  // namespace footing::hands
