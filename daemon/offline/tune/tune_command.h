#pragma once

#include <string>
#include <vector>

#include "daemon/offline/compute/ranks.h"

namespace footing::tune {

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
  bool json = false;
  std::string command_line;  ///< As typed, for the table's comment.
};

/// Tunes, as one of these ranks; returns the exit code.
int Run(const Options& options, const ranks::Ranks& ranks);

}  // namespace footing::tune
