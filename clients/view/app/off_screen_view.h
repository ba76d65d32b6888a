#pragma once

#include "clients/view/app/options.h"
#include "common/base/result.h"

namespace footing::view {

/// Draws without any display: one picture options.at_s seconds after the first data (or after the
/// start, while no server answers: then it shows what the viewer waits for), or a folder of
/// numbered ones.
Result<void> RunOffScreen(const Options& options);

}  // namespace footing::view
