#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/tune/team.h"
#include "daemon/simulation/engine/engine.h"

namespace footing::tune {

/// Options of footing-tune's command line.
struct Options {
  std::string gait;
  std::vector<double> speeds_mps;
  std::vector<double> keep_mps;  ///< Sets of the start that the table has besides.
  std::string out;
  std::vector<std::string> from;
  std::uint64_t seed = 1;
  std::string method = "descent";
  int iterations = 6;
  int trials = 24;
  double step = 1;  ///< The search's first: CMA-ES's sigma.
  int threads = 0;  ///< 0: one a core.
  bool style = false;
  bool json = false;
  std::string command_line;  ///< As typed, for the table's comment.
};

/// Tunes, as one of these ranks; returns the exit code.
int Run(const Options& options, const ranks::Ranks& ranks);

/// The table of these texts, with the files of `paths` read after them.
Result<gait::GainTable> TableOf(const std::vector<engine::GainText>& texts,
                                const std::vector<std::string>& paths);

/// Writes beside `path` and renames, so that what is there is always whole.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

/// One set at the end: evaluated on trials that no iteration saw.
struct TunedSet {
  gait::GainSet set;  ///< The answer's gains when it is better, else the start's.
  Score before, after;
  Difference difference;  ///< The answer's objective less the start's; below 0 is better.
  bool better = false;    ///< No more falls, and lower with its whole 95 % interval.
};

/// The gait table, with seed, command line and scores in its comment; only columns that differ
/// from gains.h. `kept` are sets besides the tuned ones.
std::string TableText(const Options& options, const std::vector<gait::GainSet>& kept,
                      const std::vector<TunedSet>& tuned);

/// The objective over the iterations, as SVG.
std::string Plot(const Options& options, const std::vector<SearchState>& searches);

/// The report of a run, as --json prints it.
nlohmann::ordered_json ReportOf(const Options& options, const std::vector<Dimension>& dimensions,
                                const std::vector<TunedSet>& tuned);

}  // namespace footing::tune
