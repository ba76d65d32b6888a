#pragma once

#include <array>
#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/records/trials.h"
#include "common/statistics/analysis.h"
#include "common/statistics/samples.h"
#include "common/statistics/study_table.h"

namespace footing::study::report {

/// The parts of a report, in their order.
enum class Section { kControl, kFailures, kLatency, kSurvey };
inline constexpr std::array kSections{Section::kControl, Section::kFailures, Section::kLatency,
                                      Section::kSurvey};
const char* Title(Section section);

struct Value {
  std::string participant;
  std::string interface;
  double value = 0;
  double exposure_min = 0;  ///< Of a count: the time behind it.
};

/// Something that is compared between interfaces, one value for each participant and interface.
struct Measure {
  Section section = Section::kControl;
  std::string id;     ///< Such as "test_failures_curve".
  std::string title;  ///< For a person, with its unit.
  /// As in the gait paper: Dunnett's for the oscillation of heading, otherwise Steel's.
  statistics::TestKind test = statistics::TestKind::kSteel;
  std::vector<Value> values;
  /// Every value is a count over a time. Without a time or one of the planned trials there is none.
  bool counts = false;

  /// Of an interface, in the order of the participants.
  std::vector<double> Of(const std::string& interface) const;
  bool all_zero() const;
};

/// All measures of a study that have a value (gait paper, section 8.1): time to completion, mean
/// time to failure, oscillation of heading, failures by kind, latency and anticipation, active
/// minutes, ratings. Participants who have withdrawn are left out.
std::vector<Measure> Measures(const plan::Protocol& protocol,
                              const std::vector<records::Records>& people);

/// The interfaces of a protocol, the control first.
std::vector<std::string> InOrder(const plan::Protocol& protocol);

/// In their order. Interfaces without a value are left out; the blocks are of the participants with
/// a value in each group, where there are two of them.
statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol);

}  // namespace footing::study::report
