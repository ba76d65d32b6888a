#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/plan/phases.h"
#include "common/base/result.h"

/// A person's comfortable range for an interface (gait paper, section 7: the mapping goes from "the
/// user's comfortable range of motion" to the character's stable one).
namespace footing::study::ranges {

using plan::Played;

/// Names of the measured quantities of a person's motion.
namespace quantity {
inline constexpr const char* kAlternateHz = "alternate_hz";  ///< Frequency of alternate swings.
inline constexpr const char* kStraightHz = "straight_hz";    ///< Frequency of straight arms.
inline constexpr const char* kBentHz = "bent_hz";            ///< Frequency of bent arms.
inline constexpr const char* kTogetherHz = "together_hz";    ///< Frequency of common swings.
/// Half peak to peak acceleration of common swings, m/s2.
inline constexpr const char* kTogetherMps2 = "together_mps2";
/// Turn to the right: degrees, or a share with turn_by feet.
inline constexpr const char* kTurnRight = "turn_right";
inline constexpr const char* kRestRadius = "rest_radius";        ///< Radius of a stick at rest.
inline constexpr const char* kForwardRadius = "forward_radius";  ///< Radius of a forward push.
inline constexpr const char* kSideRadius = "side_radius";
inline constexpr const char* kFootHz = "foot_hz";  ///< Stepping in place on boards, of one foot.
/// Push of a heel rise above the weight, as its share.
inline constexpr const char* kRiseShare = "rise_share";
/// Load that leans to the right, -1 to 1: stepping the mean of two steps; standing.
inline constexpr const char* kStepLean = "step_lean";
inline constexpr const char* kStandLean = "stand_lean";
}  // namespace quantity

/// Ends of a comfortable range: robust, percentiles of what was seen.
struct Range {
  double low = 0;
  double high = 0;
  double seconds = 0;  ///< For how long it was seen; of a group: 0.
};

/// Measured range of each quantity, by its name.
using Ranges = std::map<std::string, Range>;

/// Prompt for one motion of a person, with its duration.
struct Motion {
  std::string prompt;
  double duration_s = 0;
};
/// Motions that measure an interface's ranges, in order; about 20 s together, boards 33 s.
std::vector<Motion> MotionsOf(const Played& played);
/// Duration of all motions together, s.
double DurationOf(const Played& played);

/// Origin of a table's numbers.
struct Provenance {
  std::vector<std::string> participants;  ///< Codes, never names.
  std::string when;                       ///< UTC, ISO 8601.
  std::string how;                        ///< Live, or the recording.
  std::string by;                         ///< Program and version.
  bool simulated = false;                 ///< By simulated devices.
};

/// The interface's table with the numbers that follow from a range; all others are those of
/// `built_in`, the text of NAME_mapping.json. The ranges and where they come from stand under the
/// key "measured". Failure, with the motion to repeat, where a range is too small or contradicts
/// itself.
Result<nlohmann::ordered_json> TableOf(const Played& played, const Ranges& ranges,
                                       const Provenance& provenance, const std::string& built_in);

/// Measurement recorded in a table: interface, ranges and provenance.
struct Measured {
  Played played;
  Ranges ranges;
  Provenance provenance;
};
/// InvalidData, with `file`, for a table that footing-study has not measured.
Result<Measured> MeasuredOf(const std::string& table, const std::string& file);

/// The ranges of a group: the median of each end over its people, so that half of them reach it. A
/// usage error where the tables are of different interfaces or one person comes twice.
Result<Measured> Merge(const std::vector<Measured>& people);

}  // namespace footing::study::ranges
