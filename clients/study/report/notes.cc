#include "clients/study/report/notes.h"

#include <algorithm>
#include <vector>

#include "clients/study/report/measure_table.h"
#include "common/base/joined.h"

namespace footing::study::report {
namespace {

/// The gait paper (section 8.1) names the mean time to failure and does not define it. With time
/// over failures, none and one failure give the same value.
std::string NoteOnCensoring(const Measure& measure, const plan::Protocol& protocol) {
  std::vector<std::string> counts;
  std::size_t censored = 0;
  for (const std::string& interface : InOrder(protocol)) {
    const std::size_t trials = measure.Of(interface).size();
    if (trials == 0) continue;
    censored += measure.censored(interface);
    counts.push_back(interface + " " + std::to_string(measure.censored(interface)) + " of " +
                     std::to_string(trials));
  }
  const std::string note =
      "A trial without failures is censored at its duration, the value of a trial with one "
      "failure. Censored trials: " +
      text::Joined(counts) +
      ". With few failures this measures the time to completion rather than reliability, and a "
      "slower interface has the greater value. ";
  if (censored == measure.values.size()) {
    return note + "No trial had a failure, so nothing here compares reliability.";
  }
  return note +
         "To compare reliability, believe the rate of failures per minute (negative binomial), "
         "under test track, failures of every kind.";
}

std::string NoteOnZeros(const Measure& measure, const plan::Protocol& protocol) {
  const Measure measured = Measured(measure);
  std::vector<std::string> names;
  for (const std::string& interface : InOrder(protocol)) {
    if (measure.Of(interface).empty() || !measured.Of(interface).empty()) continue;
    names.push_back(interface);
  }
  if (names.empty()) return "";
  const std::string note =
      "Not compared, since it is zero for every participant: " + text::Joined(names) +
      ". A command by stick or balance needs no motion of a controller.";
  const bool control = !measured.Of(protocol.control).empty();
  return control ? note : note + " Without the control there is no comparison.";
}

}  // namespace

std::string NoteOn(const Measure& measure, const plan::Protocol& protocol) {
  if (measure.times_to_failure) return NoteOnCensoring(measure, protocol);
  return measure.zeros_unmeasured ? NoteOnZeros(measure, protocol) : "";
}

}  // namespace footing::study::report
