#pragma once

#include <string>

namespace footing::study::simulate {

/// How far a simulated study is, when one of its sessions has just ended.
struct StudyProgress {
  int ended = 0, all = 0;  ///< Sessions of this run.
  int at_once = 1;         ///< As many run beside each other.
  double mean_s = 0;       ///< Wall time of a session, mean of those that have ended.
};

/// ", 3 of 16 sessions; about 4 min left"; after the last one the count alone.
std::string ProgressText(const StudyProgress& progress);

}  // namespace footing::study::simulate
