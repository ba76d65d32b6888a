#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/trials.h"
#include "common/statistics/analysis.h"
#include "common/statistics/study_table.h"

namespace footing::study::report {

/// The parts of a report, in their order.
enum class Section { kControl, kFailures, kLatency, kSurvey };
inline constexpr std::array kSections{Section::kControl, Section::kFailures, Section::kLatency,
                                      Section::kSurvey};
const char* Title(Section section);

/// Value of a measure for one participant and interface.
struct Value {
  std::string participant;
  std::string interface;
  double value = 0;
  double exposure_min = 0;  ///< Exposure behind a count.
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

  /// Values of an interface, in the order of the participants.
  std::vector<double> Of(const std::string& interface) const;
  std::size_t censored(const std::string& interface) const;
  bool all_zero() const;
};

/// All measures of a study that have a value (gait paper, section 8.1): time to completion, mean
/// time to failure, oscillation of heading, failures by kind, latency and anticipation, active
/// minutes, ratings. Participants who have withdrawn are left out.
std::vector<Measure> Measures(const plan::Protocol& protocol,
                              const std::vector<records::Records>& people);

/// Values to test: without those of interfaces that were not measured.
Measure Measured(const Measure& measure);

/// The interfaces of a protocol, the control first.
std::vector<std::string> InOrder(const plan::Protocol& protocol);

/// Table of a measure, interfaces in their order. Interfaces without a value are left out; the
/// blocks are of the participants with a value in each group, where there are two of them.
statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol);

/// Table of counts whose rates are compared: the blocks have counts per minute.
statistics::StudyTable RateTableOf(const Measure& counts, const plan::Protocol& protocol);

/// Caveats on the values of a measure that limit its tests, in sentences; empty: none.
std::string NoteOn(const Measure& measure, const plan::Protocol& protocol);

// Figures as SVG that stands in an HTML page: classes take their colours from the page's style.

/// Marks of an axis, evenly spaced at 1, 2 or 5 times a power of ten, that enclose both values; of
/// counts at whole numbers.
std::vector<double> Ticks(double least, double greatest, bool counts = false);

/// The box of an interface: between the lower and the upper quartile.
struct Quartiles {
  double low = 0;
  double median = 0;
  double high = 0;
};
/// `values` has one at least.
Quartiles QuartilesOf(const std::vector<double>& values);

/// A measure: a point for each value, a box with the median for each interface, and a line that
/// joins the values of each participant.
std::string Figure(const Measure& measure, const plan::Protocol& protocol);

/// The opening of a figure of this size, px; `title` is read out to those who do not see it.
std::string OpenSvg(double width, double height, const std::string& title);
/// `anchor` is "start", "middle" or "end".
std::string Label(double x, double y, const std::string& anchor, const std::string& text);
/// Text with the characters that HTML reserves replaced.
std::string Escaped(const std::string& text);

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

/// Latency of one stage over all responses with an interface.
struct StageLatency {
  std::string interface;
  std::string stage;  ///< As in stream::ResponseTimes, kWithoutContact, kWithoutWindow or kWhole.
  std::size_t responses = 0;
  double p50_ms = 0;
  double p95_ms = 0;
};

/// Whether the figure draws it: a stage, not a sum of stages.
bool IsBar(const StageLatency& latency);

/// Latencies of the trials that count, interfaces in the order of `interfaces`, stages in theirs;
/// interfaces without a response are left out, and so are participants who have withdrawn.
std::vector<StageLatency> LatencyByStage(const std::vector<std::string>& interfaces,
                                         const std::vector<records::Records>& people);

/// A bar for each interface, its stages' medians one behind the other, then that of the
/// whole, as SVG.
std::string LatencyFigure(const std::vector<StageLatency>& latency);

/// Options of the tests, as in footing-eval stats.
struct TestOptions {
  statistics::Alternative alternative = statistics::Alternative::kTwoSided;
  statistics::Ties ties = statistics::Ties::kPairwise;  ///< Treatment of ties in Steel's test.
  std::optional<statistics::Method> method;  ///< Method for Steel's p; nothing: its default.
  std::optional<std::uint64_t> seed;  ///< Seed of random permutations; nothing: the protocol's.
};

/// Result of Analyze(): the report as JSON, and the values behind it.
struct Analysis {
  /// {name, control, participants, withdrawn, unfinished, synthetic, simulated_time, tests:
  /// {alternative, ties, method, seed}, measures: [{id, title, groups: [{interface, n, mean,
  /// median, least, greatest, censored}], note, participants, test, paired_participants, paired,
  /// rate}], latency: [{interface, stage, n, p50_ms, p95_ms}]}; `test`, `paired` and `rate` (of all
  /// failures together) are reports of footing-eval stats, or {error}; `censored` is of times to
  /// failure; `note` is there where the values need one.
  nlohmann::ordered_json json;
  std::vector<Measure> measures;
  std::vector<StageLatency> latency;
  bool synthetic = false;       ///< Any part of it does not come from a person.
  bool simulated_time = false;  ///< Any session ran on simulated time.
};

/// Every measure of a study with its tests against the control.
Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people,
                 const TestOptions& options = {});

/// A row for everything that a figure shows: measure,plotted,participant,interface,value. `plotted`
/// is point, lower_quartile, median, upper_quartile, bar or label.
std::string ValuesCsv(const Analysis& analysis);

}  // namespace footing::study::report
