#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/offline/bench/row.h"

namespace footing::bench {

/// Runs ours and the baseline in turn (A B B A A B B A ...), so that a slow drift of the machine
/// falls on both alike. Each call returns one figure, larger is worse.
Row RunPairs(const std::string& name, const std::string& unit, int pairs,
             const std::function<double()>& ours, const std::function<double()>& baseline);

}  // namespace footing::bench
