#pragma once

#include "clients/view/app/options.h"
#include "common/base/result.h"

namespace footing::view {

/// True when there is a display to open a window on.
bool HasDisplay();

/// The window, until it is closed, Ctrl-C or options.seconds. Fails at once, before anything is
/// shown, when no window can be opened.
Result<void> RunWindow(const Options& options);

}  // namespace footing::view
