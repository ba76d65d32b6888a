#pragma once

#include <string>

#include "common/net/process_usage.h"
#include "common/stream/server_stats.h"

namespace footing::monitoring {

/// Whose stats they are.
struct Program {
  std::string name;
  std::string version;
};

/// The stats in Prometheus' text format 0.0.4: base units, counters end in _total, a line # HELP
/// and # TYPE each. What is unknown (a battery, a clock) has no line.
std::string PrometheusText(const stream::ServerStats& stats, const Program& program,
                           const ProcessUsage& usage);

}  // namespace footing::monitoring
