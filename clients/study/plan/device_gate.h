#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/phases.h"
#include "clients/study/plan/protocol.h"
#include "common/stream/device.h"

namespace footing::study::gate {

/// Whether a device that the interface needs is simulated.
bool AnySimulated(const plan::Played& played, const std::vector<stream::DeviceStatus>& devices);

/// Problems that keep a trial from beginning, one sentence each with the remedy; empty: none.
std::vector<std::string> Problems(const plan::DeviceGate& gate, const plan::Played& played,
                                  const std::vector<stream::DeviceStatus>& devices);

/// Problems that let a trial begin but make the interface worse, one sentence each with the remedy:
/// a shin or trunk worn without a mounting, a board that is not tared.
std::vector<std::string> Warnings(const plan::Played& played,
                                  const std::vector<stream::DeviceStatus>& devices);

}  // namespace footing::study::gate
