#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "clients/study/plan/phases.h"
#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "clients/study/session/trial_events.h"
#include "common/base/result.h"

namespace footing::study {

/// Runs one attempt at a trial: begins the recording and the trial, writes every failure into the
/// journal, and ends both. Returns the outcome: "finished", "timed_out" or "stopped". Keys during
/// an attended trial: s stops it, u undoes the latest failure. `events` carries the trial's id and
/// goes on listening to corrections. `on_placed` is called once the character stands at the start.
Result<std::string> RunTrial(SessionContext& context, Servers& servers, const ActiveTime& active,
                             TrialEvents& events, const plan::Phase& phase, std::size_t attempt,
                             std::function<void()> on_placed);

/// Puts the character at the start of a track, for demonstration and practice.
Result<void> PlaceOnTrack(Servers& servers, const std::string& id, const plan::Phase& phase);

}  // namespace footing::study
