#include "clients/study/report/analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/statistics/analysis.h"
#include "common/stream/response.h"
#include "common/stream/trial.h"

namespace footing::study::report {
namespace {

using records::Records;
using records::Trial;
using statistics::TestKind;
using Trials = std::vector<const Trial*>;

constexpr double kSecondsPerMinute = 60;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A value from the trials that a participant made with an interface; NaN: none.
using FromTrials = std::function<double(const Trials&)>;

double TimeS(const Trials& trials) {
  double time_s = 0;
  for (const Trial* trial : trials) time_s += trial->time_s;
  return time_s;
}

/// The mean of a figure over the trials that have it.
double Mean(const Trials& trials, double Trial::*figure) {
  double sum = 0;
  std::size_t count = 0;
  for (const Trial* trial : trials) {
    if (!std::isfinite(trial->*figure)) continue;
    sum += trial->*figure;
    ++count;
  }
  return count == 0 ? kNone : sum / static_cast<double>(count);
}

/// NaN unless all of them reached the finish line.
double CompletionS(const Trials& trials) {
  for (const Trial* trial : trials) {
    if (trial->outcome != "finished") return kNone;
  }
  return TimeS(trials) / static_cast<double>(trials.size());
}

std::size_t FailuresIn(const Trials& trials) {
  std::size_t failures = 0;
  for (const Trial* trial : trials) failures += trial->failure_count();
  return failures;
}

double MeanTimeToFailureS(const Trials& trials) {
  const std::size_t failures = FailuresIn(trials);
  const double time_s = TimeS(trials);
  return time_s > 0 ? time_s / static_cast<double>(std::max<std::size_t>(1, failures)) : kNone;
}

double LatencyMs(const Trials& trials) {
  std::vector<double> times_ms;
  for (const Trial* trial : trials) {
    for (const records::Response& one : trial->responses) times_ms.push_back(WithoutContactMs(one));
  }
  return times_ms.empty() ? kNone : statistics::MedianOf(std::move(times_ms));
}

/// Makes the measures of trials, one after the other.
class TrialMeasures {
 public:
  TrialMeasures(const plan::Protocol& protocol, const std::vector<Records>& people)
      : planned_{{"straight", protocol.straight_trials}, {"test_track", 1}} {
    for (const Records& person : people) {
      const auto counting = records::Counting(person);
      for (const std::string& interface : protocol.interfaces) {
        for (const Trial* trial : counting) {
          if (trial->interface != interface) continue;
          trials_[{person.participant, interface, trial->kind}].push_back(trial);
          trials_[{person.participant, interface, ""}].push_back(trial);
        }
      }
    }
  }

  /// `kind` is "straight" or "test_track"; empty: both.
  void Add(const std::string& kind, Measure measure, const FromTrials& from) {
    for (const auto& [key, trials] : trials_) {
      if (std::get<2>(key) != kind) continue;
      const double value = from(trials);
      const double exposure_min = TimeS(trials) / kSecondsPerMinute;
      const bool whole = trials.size() >= Planned(kind) && exposure_min > 0;
      if (!std::isfinite(value) || (measure.counts && !whole)) continue;
      const bool censored = measure.times_to_failure && FailuresIn(trials) == 0;
      measure.values.push_back({std::get<0>(key), std::get<1>(key), value, exposure_min, censored});
    }
    list.push_back(std::move(measure));
  }

  /// Failures by kind, and all together.
  void AddFailures(const std::string& kind, const std::string& id, const std::string& where) {
    const auto add = [&](const std::string& name, const std::string& title, const auto& count_of) {
      Add(kind,
          {Section::kFailures,
           id + "_failures_" + name,
           where + ", " + title,
           TestKind::kSteel,
           {},
           /*counts=*/true},
          [&count_of](const Trials& trials) {
            double count = 0;
            for (const Trial* trial : trials) count += static_cast<double>(count_of(*trial));
            return count;
          });
    };
    add("all", "failures of every kind", [](const Trial& trial) { return trial.failure_count(); });
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      const std::string name = stream::Name(cause);
      add(name, "failures of kind " + name, [&](const Trial& trial) { return trial.Count(name); });
    }
  }

  std::vector<Measure> list;

 private:
  std::size_t Planned(const std::string& kind) const {
    const auto found = planned_.find(kind);
    return found == planned_.end() ? 0 : found->second;
  }

  std::map<std::string, std::size_t> planned_;  ///< Trials of a kind with each interface.
  /// By participant, interface and kind.
  std::map<std::tuple<std::string, std::string, std::string>, Trials> trials_;
};

/// Ratings of each interface: right after it, and at the end.
std::vector<Measure> OfRatings(const std::vector<Records>& people) {
  std::vector<Measure> measures;
  std::map<std::string, std::size_t> index;
  for (const Records& person : people) {
    for (const records::Rating& rating : person.ratings) {
      if (rating.interface.empty()) continue;
      const std::string id = (rating.at_end ? "final_rating " : "rating ") + rating.item;
      const bool exertion = rating.item == plan::kExertionItem;
      if (index.emplace(id, measures.size()).second) {
        measures.push_back({Section::kSurvey,
                            id,
                            rating.item + (rating.at_end ? ", at the end" : "") +
                                (exertion ? ", 0 to 10" : ", rating 1 to 5"),
                            TestKind::kSteel,
                            {}});
      }
      measures[index.at(id)].values.push_back({rating.participant, rating.interface, rating.value});
    }
  }
  return measures;
}

Measure OfActiveTime(const std::vector<Records>& people) {
  Measure measure{Section::kSurvey, "active_min", "Time in motion, minutes", TestKind::kSteel, {}};
  measure.zeros_unmeasured = true;  // The controllers of a joystick and boards are not body-worn.
  for (const Records& person : people) {
    for (const auto& [interface, active_s] : person.active_s) {
      measure.values.push_back({person.participant, interface, active_s / kSecondsPerMinute});
    }
  }
  return measure;
}

}  // namespace

const char* Title(Section section) {
  switch (section) {
    case Section::kControl:
      return "Completion and control";
    case Section::kFailures:
      return "Failures";
    case Section::kLatency:
      return "Latency and anticipation";
    case Section::kSurvey:
      return "Survey and effort";
  }
  return "";
}

std::vector<double> Measure::Of(const std::string& interface) const {
  std::vector<double> found;
  for (const Value& one : values) {
    if (one.interface == interface) found.push_back(one.value);
  }
  return found;
}

std::size_t Measure::censored(const std::string& interface) const {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(),
                    [&](const Value& one) { return one.censored && one.interface == interface; }));
}

bool Measure::all_zero() const {
  return std::all_of(values.begin(), values.end(), [](const Value& one) { return one.value == 0; });
}

std::vector<Measure> Measures(const plan::Protocol& protocol, const std::vector<Records>& all) {
  std::vector<Records> people;
  for (const Records& person : all) {
    if (!person.withdrawn) people.push_back(person);
  }
  TrialMeasures measures(protocol, people);
  measures.Add("test_track",
               {Section::kControl,
                "test_time_to_completion_s",
                "Test track, time to completion, s",
                TestKind::kSteel,
                {}},
               CompletionS);
  measures.Add("test_track",
               {Section::kControl,
                "test_mean_time_to_failure_s",
                "Test track, mean time to failure, s",
                TestKind::kSteel,
                {},
                /*counts=*/false,
                /*times_to_failure=*/true},
               MeanTimeToFailureS);
  measures.Add("straight",
               {Section::kControl,
                "straight_oscillation_deg",
                "Straight tracks, oscillation of heading, degrees",
                TestKind::kDunnett,
                {}},
               [](const Trials& trials) {
                 return RadiansToDegrees(Mean(trials, &Trial::heading_oscillation_rad));
               });
  measures.AddFailures("straight", "straight", "Straight tracks");
  measures.AddFailures("test_track", "test", "Test track");
  measures.Add("",
               {Section::kLatency,
                "latency_without_contact_ms",
                "Latency without the wait for contact, median, ms",
                TestKind::kSteel,
                {}},
               LatencyMs);
  measures.Add("straight",
               {Section::kLatency,
                "anticipation_s",
                "Command before the line of the task, s",
                TestKind::kSteel,
                {}},
               [](const Trials& trials) { return Mean(trials, &Trial::anticipation_s); });
  measures.list.push_back(OfActiveTime(people));
  for (Measure& rating : OfRatings(people)) measures.list.push_back(std::move(rating));
  std::erase_if(measures.list, [](const Measure& one) { return one.values.empty(); });
  return std::move(measures.list);
}

Measure Measured(const Measure& measure) {
  Measure measured = measure;
  if (!measure.zeros_unmeasured) return measured;
  std::erase_if(measured.values, [&](const Value& one) {
    const std::vector<double> of = measure.Of(one.interface);
    return std::all_of(of.begin(), of.end(), [](double value) { return value == 0; });
  });
  return measured;
}

std::vector<std::string> InOrder(const plan::Protocol& protocol) {
  std::vector<std::string> names = {protocol.control};
  for (const std::string& interface : protocol.interfaces) {
    if (interface != protocol.control) names.push_back(interface);
  }
  return names;
}

statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol) {
  statistics::StudyTable table;
  std::vector<std::string> kept;
  for (const std::string& name : InOrder(protocol)) {
    std::vector<double> values = measure.Of(name);
    if (values.empty()) continue;
    kept.push_back(name);
    std::vector<double>& exposures = table.exposures.emplace_back();
    for (const Value& one : measure.values) {
      if (one.interface == name) exposures.push_back(measure.counts ? one.exposure_min : 1);
    }
    table.groups.push_back({name, std::move(values)});
  }
  std::map<std::string, std::map<std::string, double>> by_person;
  for (const Value& one : measure.values) by_person[one.participant][one.interface] = one.value;
  statistics::Blocks blocks;
  blocks.groups = kept;
  for (const auto& [participant, values] : by_person) {
    if (values.size() != kept.size()) continue;
    blocks.subjects.push_back(participant);
    std::vector<double>& row = blocks.values.emplace_back();
    for (const std::string& name : kept) row.push_back(values.at(name));
  }
  if (blocks.subjects.size() > 1) {
    table.blocks = std::move(blocks);
  } else if (by_person.size() < measure.values.size()) {
    table.unpaired = "fewer than two participants have a value for every interface";
  }
  return table;
}

statistics::StudyTable RateTableOf(const Measure& counts, const plan::Protocol& protocol) {
  Measure rates = counts;
  for (Value& one : rates.values) one.value /= one.exposure_min;
  statistics::StudyTable table = TableOf(counts, protocol);
  table.blocks = TableOf(rates, protocol).blocks;
  return table;
}

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

namespace {

// Pixels.
constexpr double kHeight = 220, kTop = 10, kBottom = 30, kLeft = 50, kColumn = 110;
constexpr double kBoxWidth = 44, kPointRadius = 3;
constexpr double kMostTicks = 6;

std::string N(double value) { return text::Fixed(value, 1); }

std::string Line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + N(x1) + "\" y1=\"" + N(y1) + "\" x2=\"" + N(x2) +
         "\" y2=\"" + N(y2) + "\"/>";
}

/// The middle of a column.
double ColumnX(std::size_t i) { return kLeft + kColumn * (static_cast<double>(i) + 0.5); }

struct Axis {
  double least = 0, greatest = 1;
  double Y(double value) const {
    return kTop + (kHeight - kTop - kBottom) * (greatest - value) / (greatest - least);
  }
};

std::string Box(double x, const Axis& axis, const std::vector<double>& values) {
  const Quartiles box = QuartilesOf(values);
  const double low = axis.Y(box.low), high = axis.Y(box.high), median = axis.Y(box.median);
  return "<rect x=\"" + N(x - kBoxWidth / 2) + "\" y=\"" + N(high) + "\" width=\"" + N(kBoxWidth) +
         "\" height=\"" + N(low - high) + "\"/>" +
         Line(x - kBoxWidth / 2, median, x + kBoxWidth / 2, median, "median");
}

struct Point {
  double x = 0, y = 0;
  std::string title;
  bool censored = false;
};

/// By participant, then from left to right. Points that would cover each other stand side by side.
std::map<std::string, std::vector<Point>> PointsOf(const Measure& measure, const Axis& axis,
                                                   const std::vector<std::string>& names) {
  std::map<std::string, std::vector<Point>> people;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::map<long, std::vector<const Value*>> at_height;
    for (const Value& one : measure.values) {
      if (one.interface == names[i]) at_height[std::lround(axis.Y(one.value))].push_back(&one);
    }
    for (const auto& [height, together] : at_height) {
      const auto count = static_cast<double>(together.size());
      const double apart = std::min(2 * kPointRadius, kBoxWidth / count);
      for (std::size_t k = 0; k < together.size(); ++k) {
        const Value& one = *together[k];
        people[one.participant].push_back(
            {ColumnX(i) + apart * (static_cast<double>(k) - (count - 1) / 2), axis.Y(one.value),
             one.participant + ": " + text::Shortest(one.value), one.censored});
      }
    }
  }
  return people;
}

}  // namespace

Quartiles QuartilesOf(const std::vector<double>& values) {
  using statistics::QuantileOf;
  return {QuantileOf(values, 0.25), QuantileOf(values, 0.5), QuantileOf(values, 0.75)};
}

std::vector<double> Ticks(double least, double greatest, bool counts) {
  const double span = std::max(greatest - least, 1e-9);
  double step = std::pow(10, std::floor(std::log10(span / kMostTicks)));
  for (const double factor : {2.0, 2.5, 2.0}) {  // 1, 2, 5, 10 times the power of ten.
    if (span / step > kMostTicks) step *= factor;
  }
  if (counts) step = std::max(step, 1.0);
  std::vector<double> ticks;
  const double first = std::floor(least / step), last = std::ceil(greatest / step);
  for (double i = first; i <= std::max(last, first + 1); ++i) ticks.push_back(i * step);
  return ticks;
}

std::string Figure(const Measure& measure, const plan::Protocol& protocol) {
  const std::vector<std::string> names = InOrder(protocol);
  double least = 0, greatest = 0;  // Zero belongs to all of the scales.
  for (const Value& one : measure.values) {
    least = std::min(least, one.value);
    greatest = std::max(greatest, one.value);
  }
  const std::vector<double> ticks = Ticks(least, greatest, measure.counts);
  const Axis axis{ticks.front(), ticks.back()};
  const double width = kLeft + kColumn * static_cast<double>(names.size());
  std::string svg = OpenSvg(width, kHeight, measure.title);
  for (const double tick : ticks) {
    svg += Line(kLeft, axis.Y(tick), width, axis.Y(tick), tick == 0 ? "zero" : "grid") +
           Label(kLeft - 6, axis.Y(tick) + 4, "end", text::Shortest(std::round(tick * 1e9) / 1e9));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    svg += Label(ColumnX(i), kHeight - 8, "middle", names[i]);
    const std::vector<double> values = measure.Of(names[i]);
    if (!values.empty()) svg += Box(ColumnX(i), axis, values);
  }
  for (const auto& [participant, points] : PointsOf(measure, axis, names)) {
    std::string path, circles;
    for (const Point& one : points) {
      path += (path.empty() ? "M" : "L") + N(one.x) + " " + N(one.y);
      circles += std::string("<circle") + (one.censored ? " class=\"censored\"" : "") + " cx=\"" +
                 N(one.x) + "\" cy=\"" + N(one.y) + "\" r=\"" + N(kPointRadius) + "\"><title>" +
                 Escaped(one.title) + "</title></circle>";
    }
    svg += "<path class=\"pair\" d=\"" + path + "\"/>" + circles;
  }
  return svg + "</svg>";
}

std::string OpenSvg(double width, double height, const std::string& title) {
  return "<svg viewBox=\"0 0 " + N(width) + " " + N(height) + "\" width=\"" + N(width) +
         "\" role=\"img\" aria-label=\"" + Escaped(title) + "\">";
}

std::string Label(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + N(x) + "\" y=\"" + N(y) + "\" text-anchor=\"" + anchor + "\">" +
         Escaped(text) + "</text>";
}

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

namespace {

using records::StageTime;

/// As stream::ResponseTimes names it.
constexpr const char* kCommandStage = "command";

// Pixels.
constexpr double kBarHeight = 22, kRowHeight = 34, kBarLeft = 80, kBarsWidth = 560, kLegend = 26,
                 kKey = 10;
/// Colours of the stages, in their order.
constexpr std::array kColours{"#1f5fa8", "#5b93c9", "#9dbfe0", "#3d8b37", "#d9d9d9", "#c2571a"};

std::string Rectangle(double x, double y, double width, double height, const char* colour,
                      const std::string& title) {
  return "<rect class=\"bar\" x=\"" + text::Fixed(x, 1) + "\" y=\"" + text::Fixed(y, 1) +
         "\" width=\"" + text::Fixed(width, 1) + "\" height=\"" + text::Fixed(height, 0) +
         "\" style=\"fill:" + colour + "\"><title>" + Escaped(title) + "</title></rect>";
}

double WholeMs(const records::Response& response) {
  double sum_ms = 0;
  for (const StageTime& one : response) sum_ms += one.ms;
  return sum_ms;
}

/// Duration of one stage, ms; 0 where there is none.
double MsOf(const records::Response& response, const std::string& stage) {
  double ms = 0;
  for (const StageTime& one : response) ms += one.stage == stage ? one.ms : 0;
  return ms;
}

struct Bars {
  std::vector<std::string> interfaces;
  std::vector<std::string> stages;
  std::map<std::string, double> length_ms;  ///< By interface: the sum of the stages' medians.
  std::map<std::string, double> whole_ms;   ///< By interface.
};

Bars BarsOf(const std::vector<StageLatency>& latency) {
  Bars bars;
  const auto add = [](std::vector<std::string>& list, const std::string& one) {
    if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  };
  for (const StageLatency& one : latency) {
    if (one.stage == kWhole) bars.whole_ms[one.interface] = one.p50_ms;
    if (!IsBar(one)) continue;
    add(bars.interfaces, one.interface);
    add(bars.stages, one.stage);
    bars.length_ms[one.interface] += one.p50_ms;
  }
  return bars;
}

}  // namespace

bool IsBar(const StageLatency& latency) {
  return latency.stage != kWithoutContact && latency.stage != kWithoutWindow &&
         latency.stage != kWhole;
}

double WithoutContactMs(const records::Response& response) {
  return WholeMs(response) - MsOf(response, stream::kContactStage);
}

double WithoutWindowMs(const records::Response& response) {
  return WithoutContactMs(response) - MsOf(response, kCommandStage);
}

std::vector<StageLatency> LatencyByStage(const std::vector<std::string>& interfaces,
                                         const std::vector<records::Records>& people) {
  std::vector<StageLatency> latency;
  for (const std::string& interface : interfaces) {
    std::vector<std::pair<std::string, std::vector<double>>> stages;
    const auto add = [&stages](const std::string& stage, double ms) {
      const auto found = std::find_if(stages.begin(), stages.end(),
                                      [&](const auto& one) { return one.first == stage; });
      (found == stages.end() ? stages.emplace_back(stage, std::vector<double>()) : *found)
          .second.push_back(ms);
    };
    for (const records::Records& person : people) {
      if (person.withdrawn) continue;
      for (const records::Trial* trial : records::Counting(person)) {
        if (trial->interface != interface) continue;
        for (const records::Response& response : trial->responses) {
          for (const StageTime& one : response) add(one.stage, one.ms);
          add(kWithoutContact, WithoutContactMs(response));
          add(kWithoutWindow, WithoutWindowMs(response));
          add(kWhole, WholeMs(response));
        }
      }
    }
    for (const auto& [stage, times_ms] : stages) {
      latency.push_back({interface, stage, times_ms.size(), statistics::MedianOf(times_ms),
                         statistics::QuantileOf(times_ms, 0.95)});
    }
  }
  return latency;
}

std::string LatencyFigure(const std::vector<StageLatency>& latency) {
  const Bars bars = BarsOf(latency);
  double greatest_ms = 0;
  for (const auto& [interface, length_ms] : bars.length_ms) {
    greatest_ms = std::max(greatest_ms, length_ms);
  }
  if (greatest_ms <= 0) return "";
  const double scale = kBarsWidth / greatest_ms;
  const double height = kLegend + kRowHeight * static_cast<double>(bars.interfaces.size());
  std::string svg = OpenSvg(kBarLeft + kBarsWidth + 60, height, "Median latency by stage");
  const auto colour = [&](std::size_t stage) { return kColours[stage % kColours.size()]; };
  for (std::size_t i = 0; i < bars.stages.size(); ++i) {
    const double x = kBarLeft + 95 * static_cast<double>(i);
    svg += Rectangle(x, 4, kKey, kKey, colour(i), "") + Label(x + 14, 13, "start", bars.stages[i]);
  }
  for (std::size_t row = 0; row < bars.interfaces.size(); ++row) {
    const double y = kLegend + kRowHeight * static_cast<double>(row);
    double x = kBarLeft;
    svg += Label(kBarLeft - 8, y + 15, "end", bars.interfaces[row]);
    for (const StageLatency& one : latency) {
      if (one.interface != bars.interfaces[row] || !IsBar(one)) continue;
      const auto stage = std::find(bars.stages.begin(), bars.stages.end(), one.stage);
      svg += Rectangle(x, y, one.p50_ms * scale, kBarHeight,
                       colour(static_cast<std::size_t>(stage - bars.stages.begin())),
                       one.stage + " " + text::Fixed(one.p50_ms, 1) + " ms");
      x += one.p50_ms * scale;
    }
    svg += Label(x + 6, y + 15, "start",
                 text::Fixed(bars.whole_ms.at(bars.interfaces[row]), 0) + " ms");
  }
  return svg + "</svg>";
}

namespace {

using nlohmann::ordered_json;

ordered_json Tested(const statistics::StudyTable& table, statistics::TestKind test,
                    const TestOptions& options) {
  statistics::AnalysisRequest request;
  request.test = test;
  request.alternative = options.alternative;
  if (test == statistics::TestKind::kSteel) {
    request.ties = options.ties;
    request.method = options.method;
  }
  request.seed = options.seed.value_or(1);
  auto report = statistics::Analyze(table, request);
  if (report) return std::move(*report);
  return {{"test", statistics::NameOf(test)}, {"error", report.error().message}};
}

/// At least one other interface beside the control, and two values.
bool Comparable(const statistics::StudyTable& table, const std::string& control) {
  return table.groups.size() > 1 && table.groups.front().name == control;
}

ordered_json Groups(const Measure& measure, const plan::Protocol& protocol) {
  ordered_json groups = ordered_json::array();
  for (const statistics::Group& group : TableOf(measure, protocol).groups) {
    const auto [least, greatest] = std::minmax_element(group.values.begin(), group.values.end());
    double sum = 0;
    for (const double value : group.values) sum += value;
    groups.push_back({{"interface", group.name},
                      {"n", group.values.size()},
                      {"mean", sum / static_cast<double>(group.values.size())},
                      {"median", QuartilesOf(group.values).median},
                      {"least", *least},
                      {"greatest", *greatest}});
    if (measure.times_to_failure) groups.back()["censored"] = measure.censored(group.name);
  }
  return groups;
}

ordered_json ToJson(const TestOptions& options) {
  return {{"alternative", NameOf(options.alternative)},
          {"ties", NameOf(options.ties)},
          {"method", options.method ? ordered_json(NameOf(*options.method)) : ordered_json()},
          {"seed", options.seed.value_or(1)}};
}

/// A measure with its groups and tests.
ordered_json ToJson(const Measure& measure, const plan::Protocol& protocol,
                    const TestOptions& options) {
  const statistics::StudyTable table = TableOf(Measured(measure), protocol);
  ordered_json one = {
      {"id", measure.id}, {"title", measure.title}, {"groups", Groups(measure, protocol)}};
  if (std::string note = NoteOn(measure, protocol); !note.empty()) one["note"] = std::move(note);
  std::set<std::string> participants;
  for (const Value& value : measure.values) participants.insert(value.participant);
  one["participants"] = participants.size();
  if (!Comparable(table, protocol.control)) return one;
  one["test"] = Tested(table, measure.test, options);
  if (table.blocks) {
    one["paired_participants"] = table.blocks->subjects.size();
    one["paired"] = Tested(table, statistics::TestKind::kPaired, options);
  }
  if (measure.id.ends_with("_failures_all") && !measure.all_zero()) {
    one["rate"] = Tested(RateTableOf(measure, protocol), statistics::TestKind::kRate, options);
  }
  return one;
}

/// RFC 4180.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people,
                 const TestOptions& given) {
  TestOptions options = given;
  if (!options.seed) options.seed = protocol.seed;
  Analysis analysis;
  analysis.measures = Measures(protocol, people);
  std::size_t withdrawn = 0, unfinished = 0;
  for (const records::Records& person : people) {
    withdrawn += person.withdrawn ? 1 : 0;
    unfinished += !person.finished && !person.withdrawn ? 1 : 0;
    analysis.synthetic = analysis.synthetic || (person.synthetic && !person.withdrawn);
    analysis.simulated_time =
        analysis.simulated_time || (person.simulated_time && !person.withdrawn);
  }
  ordered_json measures = ordered_json::array();
  for (const Measure& measure : analysis.measures) {
    measures.push_back(ToJson(measure, protocol, options));
  }
  analysis.latency = LatencyByStage(InOrder(protocol), people);
  ordered_json latency = ordered_json::array();
  for (const StageLatency& one : analysis.latency) {
    latency.push_back({{"interface", one.interface},
                       {"stage", one.stage},
                       {"n", one.responses},
                       {"p50_ms", one.p50_ms},
                       {"p95_ms", one.p95_ms}});
  }
  analysis.json = {{"name", protocol.name},
                   {"control", protocol.control},
                   {"participants", people.size()},
                   {"withdrawn", withdrawn},
                   {"unfinished", unfinished},
                   {"synthetic", analysis.synthetic},
                   {"simulated_time", analysis.simulated_time},
                   {"tests", ToJson(options)},
                   {"measures", measures},
                   {"latency", latency}};
  return analysis;
}

std::string ValuesCsv(const Analysis& analysis) {
  std::string csv = "measure,plotted,participant,interface,value\n";
  const auto add = [&csv](const std::string& measure, const char* plotted,
                          const std::string& participant, const std::string& interface,
                          double value) {
    csv += Cell(measure) + "," + plotted + "," + Cell(participant) + "," + Cell(interface) + "," +
           text::Shortest(value) + "\n";
  };
  for (const Measure& measure : analysis.measures) {
    std::set<std::string> interfaces;
    for (const Value& one : measure.values) {
      add(measure.id, "point", one.participant, one.interface, one.value);
      interfaces.insert(one.interface);
    }
    for (const std::string& interface : interfaces) {
      const Quartiles box = QuartilesOf(measure.Of(interface));
      add(measure.id, "lower_quartile", "", interface, box.low);
      add(measure.id, "median", "", interface, box.median);
      add(measure.id, "upper_quartile", "", interface, box.high);
    }
  }
  for (const StageLatency& one : analysis.latency) {
    if (one.stage == kWhole) {
      add("latency_whole_ms", "label", "", one.interface, one.p50_ms);
    } else if (IsBar(one)) {
      add("latency_" + one.stage + "_ms", "bar", "", one.interface, one.p50_ms);
    }
  }
  return csv;
}

}  // namespace footing::study::report
