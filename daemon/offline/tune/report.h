#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/offline/tune/team.h"
#include "daemon/offline/tune/tune_command.h"

namespace footing::tune {

/// One set at the end: evaluated on trials that no iteration saw.
struct TunedSet {
  gait::GainSet set;  ///< The answer's gains when it is better, else the start's.
  Score before, after;
  Difference difference;  ///< Of the answer's objective from the start's; below 0 is better.
  bool better = false;    ///< No more falls, and lower with its whole 95 % interval.
};

/// The gait table, with seed, command line and scores in its comment; only columns that differ
/// from gains.h. `kept` are sets besides the tuned ones.
std::string TableText(const Options& options, const std::vector<gait::GainSet>& kept,
                      const std::vector<TunedSet>& tuned);

/// The objective over the iterations, as SVG.
std::string Plot(const Options& options, const std::vector<SearchState>& searches);

nlohmann::ordered_json ReportOf(const Options& options, const std::vector<Dimension>& dimensions,
                                const std::vector<TunedSet>& tuned);

}  // namespace footing::tune
