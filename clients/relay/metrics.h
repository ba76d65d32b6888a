#pragma once

#include <string>

#include "clients/relay/edge.h"
#include "clients/relay/publisher.h"

/// How a relay fares, in Prometheus' text format, with what this process takes of the host.
namespace footing::relay {

std::string MetricsText(const PublisherReport& report, const std::string& version);
std::string MetricsText(const EdgeReport& report, const std::string& version);

}  // namespace footing::relay
