#pragma once

#include <string>
#include <vector>

#include "clients/study/bundle/bids.h"
#include "clients/study/records/trials.h"
#include "common/recording/recorded_session.h"
#include "common/result/result.h"

namespace footing::study::bundle {

struct TrialTables {
  std::vector<MotionTable> tables;  ///< "sim", then one for each device that sent samples.
  std::vector<TrialEvent> events;
  std::string config;  ///< The last EffectiveConfig of the recording; empty: it has none.
};

/// What a recording says of its trial. Time counts from the first frame of the trial, in seconds on
/// the wall clock of the recorder's host, for both servers. Devices are named by their roles, never
/// by their serials. InvalidData when the recording has no marks of a trial, or no
/// frame of it.
Result<TrialTables> ReadTrial(const recording::RecordedSession& session,
                              const records::Trial& trial);

}  // namespace footing::study::bundle
