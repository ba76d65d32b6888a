#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/centre_line.h"
#include "common/stream/character.h"

/// Tracks as data: a ribbon of segments, 4 m wide in the paper (section 8.2).
namespace footing::terrain {

/// A character starts, and is put back, at the start of a track: so much ground is under it.
inline constexpr double kGroundAtStartM = 1;

/// Reads a track. The file is one object:
///   version   1
///   name      text; comment   text, ignored
///   width_m   (0, 100], 4 by default
///   open      true: a character may leave the ribbon; otherwise that is a failure
///   extendable  true: segments may be added later; those of the file are then 1 to 32
///             of at least 2 m
///   endless   true: the track continues itself ahead of the character; level
///   help_over_pits  false: the gait controllers do not see pits; a jump's timing is the user's
///   start_m, finish_m  lines across the track, m along it: where a trial's clock starts (1 by
///             default) and stops (5 m before the end; 0, without a finish, on a track that is open
///             or grows)
///   mark      {at_m, within_m, tasks: [{name, before, after}]}: a line at which a trial's task is
///             due: the gait `after`, within 15 m by default; `before` is the gait up to the line
///   segments  1 to 1000 objects {length_m (0, 10000], slope_deg [-30, 30], curve_deg [-90, 90],
///             step_m [-0.5, 0.5], pit true or false, repeat}; all but the length default to
///             nothing, repeat to 1. The first pit begins kGroundAtStartM or more from the start; a
///             pit has no curve.
/// The start line is on ground, kGroundAtStartM or more before the end. A track that neither is
/// open nor grows is long enough for its finish line, unless finish_m is 0 or another place. The
/// track starts at the origin along x. curve_deg turns the heading and step_m raises the ground at
/// the segment's start; positive is left and up. `origin` names the file in errors.
Result<stream::Track> ParseTrack(const std::string& text, const std::string& origin);

/// True when segments are added to the track while a character is on it.
bool Grows(const stream::Track& track);

/// True when no segment has a slope or a pit or begins with a step.
bool IsFlat(const stream::Track& track);

/// The track as it looks to whoever does not see its pits.
stream::Track WithPitsFilled(stream::Track track);

/// The centre line's geometry.
using track::CentreAhead;
using track::CentreBehind;
using track::CentrePoint;
using track::IsOffRibbon;
using track::LengthOf;
using track::LengthTo;
using track::Locate;
using track::PlaceAt;
using track::TrackPlace;

// Ground that is added to a track's end while a character is on it, as in the gait paper's terrain
// editor (section 8). Nothing here allocates while the track's capacity suffices.

/// A segment to add: 2 to 4 m long, of a pit 0.3 to 1.5 m, its slope within 5 degrees, its curve
/// within 15 degrees, its step within 0.10 m. A pit has none of these three.
using NewSegment = track::Piece;

/// More segments than this are not kept: the oldest one goes for each that is added.
inline constexpr std::size_t kMostSegments = 256;
/// The same of an endless track, whose past nobody comes back to.
inline constexpr std::size_t kMostEndlessSegments = 64;
/// Segments that this track keeps at most.
std::size_t MostSegments(const stream::Track& track);
/// The oldest segment only goes when the character is at least so many segments further.
inline constexpr int kKeptBehind = 12;

/// Why a segment may not be added, as text of static storage that names the limit; null when it
/// may. `here` is the index of the segment on which the character is.
const char* WhyNotAppended(const stream::Track& track, const NewSegment& segment, int here);

/// Adds a segment that may be added, counts the revision up, and drops the oldest segment beyond
/// MostSegments.
void Append(const NewSegment& segment, stream::Track& track);
/// The same with a segment that Append has placed on another copy of the track.
void Add(const stream::TrackSegment& placed, stream::Track& track);

// A track that continues itself ahead of a character, so that whoever practises stays on it. The
// segments follow the direction of travel of the last ten metres: short turns to the left and
// right leave the track straight, a lasting turn bends it.

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
