#pragma once

#include "clients/study/report/trials.h"
#include "common/recording/recorded_motion.h"
#include "common/recording/recorded_session.h"
#include "common/base/result.h"

namespace footing::study::bundle {

/// What a recording says of its trial, from the trial's first frame on; only devices that have a
/// role. InvalidData when the recording has no marks of a trial, or no frame of it.
Result<bids::RecordedMotion> ReadTrial(const recording::RecordedSession& session,
                                       const records::Trial& trial);

}  // namespace footing::study::bundle
