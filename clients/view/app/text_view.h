#pragma once

#include "clients/view/app/options.h"
#include "common/result/result.h"

namespace footing::view {

/// The live state in the terminal: one screen redrawn four times a second, or, when standard output
/// is not a terminal, a line a second. Runs until Ctrl-C or options.seconds.
Result<void> RunTextView(const Options& options);

}  // namespace footing::view
