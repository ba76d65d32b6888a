#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/records/trials.h"
#include "common/statistics/analysis.h"
#include "common/statistics/samples.h"
#include "common/statistics/study_table.h"

namespace footing::study::report {

struct Value {
  std::string participant;
  std::string interface;
  double value = 0;
};

/// Something that is compared between interfaces, one value for each participant and interface.
struct Measure {
  std::string id;     ///< Such as "test_failures_curve".
  std::string title;  ///< For a person, with its unit.
  /// As in the gait paper: Dunnett's for the oscillation of heading, otherwise Steel's.
  statistics::TestKind test = statistics::TestKind::kSteel;
  std::vector<Value> values;

  /// Of an interface, in the order of the participants.
  std::vector<double> Of(const std::string& interface) const;
};

/// All measures of a study that have a value (gait paper, section 8.1): failures by kind, time to
/// completion, mean time to failure, oscillation of heading, ratings. Participants who have
/// withdrawn are left out.
std::vector<Measure> Measures(const plan::Protocol& protocol,
                              const std::vector<records::Records>& people);

/// The control first. Interfaces without a value are left out; blocks where every participant with
/// a value has one in each group.
statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol);

}  // namespace footing::study::report
