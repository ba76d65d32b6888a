#pragma once

#include <cstddef>

#include "common/stream/character.h"
#include "common/body/piece.h"

/// Ground that is added to a track's end while a character is on it, as in the gait paper's terrain
/// editor (section 8). Nothing here allocates while the track's capacity suffices.
namespace footing::terrain {

/// A segment to add: 2 to 4 m long, of a pit 0.3 to 1.5 m, its slope within 5 degrees, its curve
/// within 15 degrees, its step within 0.10 m. A pit has none of these three.
using NewSegment = track::Piece;

/// More segments than this are not kept: the oldest one goes for each that is added.
inline constexpr std::size_t kMostSegments = 256;
/// The same of an endless track, whose past nobody comes back to.
inline constexpr std::size_t kMostEndlessSegments = 64;
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

}  // namespace footing::terrain
