#pragma once

#include <string>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "common/body/centre_line.h"

/// Tracks as data: a ribbon of segments, 4 m wide in the paper (section 8.2).
namespace footing::terrain {

/// A character starts, and is put back, at the start of a track: so much ground is under it.
inline constexpr double kGroundAtStartM = 1;

/// Reads a track. The file is one object:
///   version   1
///   name      text; comment   text, ignored
///   width_m   (0, 100], 4 by default
///   open      true: a character may leave the ribbon; otherwise that is a failure
///   extendable  true: segments may be added later (append.h); those of the file are then 1 to 32
///             of at least 2 m
///   endless   true: the track continues itself ahead of the character (endless.h); level
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

}  // namespace footing::terrain
