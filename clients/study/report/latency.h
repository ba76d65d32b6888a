#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/trials.h"

namespace footing::study::report {

/// The stage of StageLatency that stands for all but the wait for contact.
inline constexpr const char* kWithoutContact = "without contact";

/// The same without what is left of the features' window: a change of gait is held until it has
/// lasted, and the stage "command" ends there.
inline constexpr const char* kWithoutWindow = "without contact and feature window";

/// The stage of StageLatency that stands for all of a response. Its median is not the sum of the
/// medians of the stages.
inline constexpr const char* kWhole = "whole";

/// All stages but the wait for the contact from which the character can answer, ms.
double WithoutContactMs(const records::Response& response);
/// The same without the stage "command", ms.
double WithoutWindowMs(const records::Response& response);

/// Over all responses with an interface.
struct StageLatency {
  std::string interface;
  std::string stage;  ///< As in stream::ResponseTimes, kWithoutContact, kWithoutWindow or kWhole.
  std::size_t responses = 0;
  double p50_ms = 0;
  double p95_ms = 0;
};

/// Whether the figure draws it: a stage, not a sum of stages.
bool IsBar(const StageLatency& latency);

/// Of the trials that count, interfaces in the order of `interfaces`, stages in theirs; interfaces
/// without a response are left out, and so are participants who have withdrawn.
std::vector<StageLatency> LatencyByStage(const std::vector<std::string>& interfaces,
                                         const std::vector<records::Records>& people);

/// A bar for each interface, its stages' medians one behind the other, then that of the
/// whole, as SVG.
std::string LatencyFigure(const std::vector<StageLatency>& latency);

}  // namespace footing::study::report
