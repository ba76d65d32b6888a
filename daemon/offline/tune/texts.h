#pragma once

#include "common/base/result.h"
#include "daemon/simulation/engine/engine.h"

namespace footing::tune {

/// The table of these texts, with the files of `paths` read after them.
Result<gait::GainTable> TableOf(const engine::EngineTexts& texts,
                                const std::vector<std::string>& paths);

/// Writes beside `path` and renames, so that what is there is always whole.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

}  // namespace footing::tune
