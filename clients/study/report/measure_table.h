#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/measures.h"
#include "common/statistics/study_table.h"

/// From a measure to the table that is tested.
namespace footing::study::report {

/// The values to test: without those of interfaces that were not measured.
Measure Measured(const Measure& measure);

/// The interfaces of a protocol, the control first.
std::vector<std::string> InOrder(const plan::Protocol& protocol);

/// In their order. Interfaces without a value are left out; the blocks are of the participants with
/// a value in each group, where there are two of them.
statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol);

/// The same of counts whose rates are compared: the blocks have counts per minute.
statistics::StudyTable RateTableOf(const Measure& counts, const plan::Protocol& protocol);

}  // namespace footing::study::report
