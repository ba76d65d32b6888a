#pragma once

#include "clients/view/app/options.h"
#include "common/base/result.h"

namespace footing::view {

/// Plays options.play: into the window, into pictures, or as text.
Result<void> RunPlayback(const Options& options);

}  // namespace footing::view
