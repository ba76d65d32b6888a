#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Sets constants of the best mode by "name=value", to choose them on clips for validation. An
/// error lists the names.
Result<void> SetConstants(const std::vector<std::string>& assignments,
                          reconstruction::BestConstants& constants);

}  // namespace footing::eval
