#pragma once

#include <string>
#include <vector>

#include "common/runtime/config.h"

namespace footing::config {

/// What a program says that has read its config again: `before` held until now, `after` holds from
/// now on, and `wanted` was read. `files` are settings whose files have another content. One line,
/// and another one where what was read needs a restart.
std::vector<std::string> DescribeReload(const Binder& before, const Binder& after,
                                        const Binder& wanted,
                                        const std::vector<std::string>& files);

}  // namespace footing::config
