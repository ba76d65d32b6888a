#pragma once

#include "clients/view/app/options.h"
#include "clients/view/app/play_session.h"
#include "common/base/result.h"

namespace footing::view {

/// Plays in the window, until it is closed, Ctrl-C or options.seconds. A recording that is over
/// stays at its last state.
Result<void> RunPlayWindow(const Options& options, PlaySession& session);

}  // namespace footing::view
