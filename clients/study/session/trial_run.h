#pragma once

#include <cstddef>
#include <string>

#include "clients/study/plan/phases.h"
#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "common/result/result.h"

namespace footing::study {

/// Runs one attempt at a trial: begins the recording and the trial, writes every failure into the
/// journal, and ends both. Returns the outcome: "finished", "timed_out" or "stopped". Keys during
/// an attended trial: s stops it, u undoes the newest failure.
Result<std::string> RunTrial(SessionContext& context, Servers& servers, const ActiveTime& active,
                             const plan::Phase& phase, std::size_t attempt);

/// Puts the character at the start of a track, for demonstration and practice.
Result<void> PlaceOnTrack(Servers& servers, const std::string& id, const plan::Phase& phase);

/// Takes a failure out of the counts, with footing-sim and in the journal.
Result<void> UndoFailure(SessionContext& context, Servers& servers, std::uint64_t failure);

}  // namespace footing::study
