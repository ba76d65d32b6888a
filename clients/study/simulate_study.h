#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/study/plan/phases.h"
#include "common/base/result.h"

namespace footing::study::simulate {

struct StudyOptions {
  std::string protocol_path;
  std::string protocol_text;
  std::string study_folder;  ///< Of simulated sessions alone.
  std::vector<plan::Session> sessions;
  std::uint64_t seed = 1;
  int jobs = 1;                  ///< Sessions at once, each on about one processor.
  bool real_time = false;        ///< As in SimulatedSession.
  std::string turn_by = "head";  ///< As in SimulatedSession.
};

/// One participant's session in the folder.
struct SessionTime {
  std::string participant;
  double simulated_s = 0;  ///< From the first event to the last one.
  bool before = false;     ///< It was there already.
};

/// Simulates the sessions that the folder does not have yet. A session comes into the folder as a
/// whole once it has ended, so a run that is interrupted can be run again. A usage error where the
/// folder has the session of a person.
Result<std::vector<SessionTime>> SimulateStudy(const StudyOptions& options);

}  // namespace footing::study::simulate
