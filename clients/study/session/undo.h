#pragma once

#include <cstdint>
#include <string>

#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "common/base/result.h"

namespace footing::study {

/// Takes a failure of an attempt out of the counts: with footing-sim as long as that shows the
/// attempt, whose events must be listened to (TrialEvents), otherwise in the journal alone. What
/// prevents it is printed; an error ends the session.
Result<void> UndoFailure(SessionContext& context, Servers& servers, const std::string& trial,
                         std::uint64_t number);

/// The same with the newest failure of the attempt that counts.
Result<void> UndoNewest(SessionContext& context, Servers& servers, const std::string& trial);

}  // namespace footing::study
