#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/trials.h"
#include "common/statistics/analysis.h"

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
  bool censored = false;    ///< A time to failure without a failure: a lower bound.
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
  /// Every value is a time to failure; some may be censored.
  bool times_to_failure = false;
  /// An interface with zeros only was not measured, so it is not tested.
  bool zeros_unmeasured = false;

  /// Of an interface, in the order of the participants.
  std::vector<double> Of(const std::string& interface) const;
  std::size_t censored(const std::string& interface) const;
  bool all_zero() const;
};

/// All measures of a study that have a value (gait paper, section 8.1): time to completion, mean
/// time to failure, oscillation of heading, failures by kind, latency and anticipation, active
/// minutes, ratings. Participants who have withdrawn are left out.
std::vector<Measure> Measures(const plan::Protocol& protocol,
                              const std::vector<records::Records>& people);

}  // namespace footing::study::report
