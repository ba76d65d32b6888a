#include "clients/study/report/page.h"

#include <cmath>
#include <utility>

#include "clients/study/report/figure.h"
#include "clients/study/report/measure_table.h"
#include "clients/study/report/tables.h"

namespace footing::study::report {
namespace {

using nlohmann::ordered_json;

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:72rem;margin:2rem auto;"
    "padding:0 1rem}h1,h2,h3{font-weight:300}h2{margin-top:3rem;border-bottom:1px solid #ccc}"
    "h3{margin-bottom:.3rem}table{border-collapse:collapse;margin:.5rem 0;display:block;"
    "overflow-x:auto;max-width:100%}.pair-of-columns>*{min-width:0;max-width:100%}"
    "td,th{font-weight:400;text-align:right;padding:.1rem .8rem .1rem 0;"
    "border-bottom:1px solid #e5e5e5}td:first-child,th:first-child{text-align:left}"
    "th{color:#777}.pair-of-columns{display:flex;flex-wrap:wrap;gap:0 2rem;align-items:flex-start}"
    "svg{max-width:100%;height:auto}svg text{font-size:11px;fill:#555}.grid{stroke:#eee}"
    ".zero{stroke:#999}rect{fill:#dfe8f1;stroke:#89a}.bar{stroke:none}"
    ".median{stroke:#246;stroke-width:2}.pair{fill:none;stroke:#246;opacity:.25}"
    "circle{fill:#246;opacity:.7}.censored{fill:#fff;stroke:#246}.synthetic{background:#fff3cd;"
    "padding:.5rem 1rem}"
    ".note{color:#777;font-size:13px;max-width:60rem}.believe{border-left:3px solid #246;"
    "padding-left:.8rem;max-width:60rem}@media print{.measure{break-inside:avoid}}"
    "@media(max-width:30rem){table{font-size:12px}td,th{padding-right:.4rem}}";

constexpr const char* kHowToRead =
    "Each point is a participant, each box reaches from the lower to the upper quartile with the "
    "median as a line, and thin lines join the values of one participant. A hollow point is a "
    "censored time: the trial ended without a failure. Each p is adjusted for "
    "the comparisons of its measure, not for the number of measures: decide before the study "
    "which measures it is about. The paired p permutes the labels within each participant and "
    "takes the greatest mean difference from the control, which needs neither normal values nor "
    "one variance; the blocked Dunnett test needs both, Wilcoxon's test uses ranks only, and "
    "Friedman's says only whether any interface differs.";
/// Gait paper, footnote 1.
constexpr const char* kWhyNoRate =
    "The gait paper ranks failure counts and fits no rate model: each failure delays the goal and "
    "counts on until it is reached, so it takes the count as a measure of the difficulty of the "
    "task. Ranks do not say how many times as many failures there are; the rate ratio does. It "
    "takes the groups as independent.";
constexpr const char* kLatencyNote =
    "From the report of a controller to the first frame that shows the new gait. The wait for "
    "contact belongs to a simulated character: it can answer only with the right foot on the "
    "ground. Time that the features need to notice a change of motion lies before the first "
    "report that is counted; what is left of their window when that report comes is the stage "
    "command, since a change of gait is held until it has lasted. Without it and the contact 95 % "
    "should stay within 20 ms. Anticipation is positive where the command came before the "
    "character "
    "reached the line. The figure stacks the medians of the stages; the number behind them is the "
    "median of whole responses.";
constexpr const char* kSimulatedTime =
    "Time was simulated: these latencies have the waits for samples, ticks and steps in them, and "
    "no time of computing or of a radio.";
constexpr const char* kSynthetic =
    "Synthetic: simulated devices or random answers. It says nothing about people.";

/// Where the test for independent groups has failed.
constexpr const char* kBelievePaired =
    "Believe the paired p: each participant used every interface.";

std::string Paragraph(const std::string& kind, const std::string& text) {
  return "<p class=\"" + kind + "\">" + Escaped(text) + "</p>";
}

std::string Heading(const ordered_json& json) {
  const auto participants = json["participants"].get<std::size_t>();
  std::string text = std::to_string(participants) + " participant" + (participants == 1 ? "" : "s");
  for (const char* kind : {"withdrawn", "unfinished"}) {
    const auto count = json[kind].get<std::size_t>();
    if (count > 0) text += ", " + std::to_string(count) + " " + kind;
  }
  text += "; control: " + json["control"].get<std::string>();
  const std::string alternative = json["tests"]["alternative"];
  if (alternative == "two.sided") return text;
  return text + "; tests look for values " + alternative + " than the control's only";
}

/// What the tests within participants say of one comparison.
std::string PairedText(const ordered_json& row) {
  return "paired p " + PText(row, "permutation_p") + ", Wilcoxon " +
         PText(row, "wilcoxon_exact_holm") + ", blocked Dunnett " + PText(row, "block_dunnett_p") +
         ", Cliff's delta " + Short(row["cliffs_delta"], "estimate");
}

bool Has(const ordered_json& measure, const char* test) {
  return measure.contains(test) && !measure[test].contains("error");
}

/// Of each comparison: what both tests say, as far as they could be made.
std::string ComparisonLines(const ordered_json& measure) {
  const bool independent = Has(measure, "test"), paired = Has(measure, "paired");
  if (!independent && !paired) return "";
  const ordered_json& rows = measure[independent ? "test" : "paired"]["rows"];
  std::string lines;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    lines += "\n  " + NameOfRow(rows[i]) + ": ";
    if (independent) {
      lines += measure["test"]["test"].get<std::string>() + " p " + IndependentPText(rows[i]);
    }
    if (paired) lines += (independent ? "; " : "") + PairedText(measure["paired"]["rows"][i]);
  }
  return lines;
}

/// A remark of a test, which names fields of its report, in words of the page.
std::string ForTheReader(std::string remark) {
  for (const auto& [field, words] : {std::pair("wilcoxon_exact_holm", "Wilcoxon's p"),
                                     std::pair("block_t", "the blocked Dunnett test")}) {
    const auto at = remark.find(field);
    if (at != std::string::npos) remark.replace(at, std::string(field).size(), words);
  }
  return remark;
}

/// What stands below the tests within participants.
std::string PairedNotes(const ordered_json& json) {
  const ordered_json& paired = json["paired"];
  std::string participants = "Within participants: " + Short(json, "paired_participants") + " of " +
                             Short(json, "participants") +
                             " participants, those with a value for every interface";
  for (const ordered_json& one : paired["remarks"]) participants += "; " + ForTheReader(one);
  return Paragraph("note", FriedmanText(paired)) + Paragraph("note", participants + ".");
}

/// The figure beside its numbers, then the tests with the sentence on which to believe.
std::string MeasureBlock(const Measure& measure, const ordered_json& json,
                         const plan::Protocol& protocol) {
  std::string block = "<div class=\"measure\"><h3>" + Escaped(measure.title) +
                      "</h3><div class=\"pair-of-columns\">" + Figure(measure, protocol) + "<div>" +
                      GroupTable(json["groups"]);
  if (json.contains("rate")) block += RateTable(json["rate"]);
  block += "</div></div>";
  if (json.contains("note")) block += Paragraph("believe", json["note"]);
  if (!json.contains("test")) return block + "</div>";
  const ordered_json& test = json["test"];
  block += TestTable(test);
  if (json.contains("paired")) block += PairedTable(json["paired"]);
  if (!test.contains("error")) {
    block += Paragraph("believe", test.value("note", "")) +
             Paragraph("note", test.value("procedure", "") + ".");
  } else if (json.contains("paired")) {
    block += Paragraph("believe", kBelievePaired);
  }
  if (json.contains("paired") && !json["paired"].contains("error")) block += PairedNotes(json);
  return block + "</div>";
}

std::string SectionBlock(Section section, const Analysis& analysis,
                         const plan::Protocol& protocol) {
  std::string block, zeros;
  for (std::size_t i = 0; i < analysis.measures.size(); ++i) {
    const Measure& measure = analysis.measures[i];
    if (measure.section != section) continue;
    if (measure.counts && measure.all_zero()) {
      zeros += (zeros.empty() ? "None at all: " : "; ") + measure.title;
    } else {
      block += MeasureBlock(measure, analysis.json["measures"][i], protocol);
    }
  }
  if (!zeros.empty()) block += Paragraph("note", zeros + ".");
  if (section == Section::kFailures && !block.empty()) block += Paragraph("note", kWhyNoRate);
  if (section == Section::kLatency && !analysis.latency.empty()) {
    block = LatencyFigure(analysis.latency) + LatencyTable(analysis.latency) +
            (analysis.simulated_time ? Paragraph("synthetic", kSimulatedTime) : "") +
            Paragraph("note", kLatencyNote) + block;
  }
  if (block.empty()) return "";
  return std::string("<h2>") + Title(section) + "</h2>" + block;
}

std::string GroupLines(const ordered_json& measure) {
  std::string lines;
  for (const ordered_json& group : measure["groups"]) {
    lines += "\n  " + group["interface"].get<std::string>() + ": median " + Short(group, "median") +
             ", mean " + Short(group, "mean") + ", n " + Short(group, "n") +
             (group.contains("censored") ? ", censored " + Short(group, "censored") : "");
  }
  return measure.contains("note") ? lines + "\n  " + measure["note"].get<std::string>() : lines;
}

/// What to believe of the tests of a measure, without the reasons, and what there is to remark on
/// the data.
std::string BelieveText(const ordered_json& measure) {
  const std::string note = measure["test"].value("note", kBelievePaired);
  std::string text = note.substr(0, note.find(':'));
  for (const char* key : {"test", "paired"}) {
    if (!Has(measure, key)) continue;
    for (const ordered_json& remark : measure[key]["remarks"]) text += "; " + ForTheReader(remark);
  }
  return text + ".";
}

std::string TestLines(const ordered_json& measure) {
  if (!measure.contains("test")) return "";
  std::string lines;
  if (!Has(measure, "test")) lines += "\n  " + measure["test"]["error"].get<std::string>();
  lines += ComparisonLines(measure);
  if (Has(measure, "rate")) {
    for (const ordered_json& row : measure["rate"]["rows"]) lines += "\n  " + RateText(row);
  }
  if (Has(measure, "paired")) lines += "\n  " + FriedmanText(measure["paired"]);
  if (!Has(measure, "test") && !Has(measure, "paired")) return lines;
  return lines + "\n  " + BelieveText(measure);
}

}  // namespace

std::string Page(const Analysis& analysis, const plan::Protocol& protocol,
                 const std::vector<records::Records>& people) {
  const ordered_json& json = analysis.json;
  std::string page = "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     Escaped(protocol.name) + "</title><style>" + kStyle +
                     "</style></head><body><h1>" + Escaped(protocol.name) + "</h1><p>" +
                     Escaped(Heading(json)) + "</p>";
  if (analysis.synthetic) page += Paragraph("synthetic", kSynthetic);
  page +=
      "<h2>Overview</h2>" + OverviewTable(json, InOrder(protocol)) + Paragraph("note", kHowToRead);
  for (const Section section : kSections) page += SectionBlock(section, analysis, protocol);
  return page + WholeStudyTable(people) + AnswerTable(people) + "</body></html>\n";
}

std::string Summary(const Analysis& analysis) {
  const ordered_json& json = analysis.json;
  std::string text = json["name"].get<std::string>() + ": " + Heading(json);
  if (analysis.synthetic) text += std::string("\n") + kSynthetic;
  bool tested = false;
  for (std::size_t i = 0; i < analysis.measures.size(); ++i) {
    const ordered_json& one = json["measures"][i];
    tested = tested || one.contains("test");
    text += "\n" + one["title"].get<std::string>();
    if (analysis.measures[i].counts && analysis.measures[i].all_zero()) {
      text += "\n  none at all";
    } else {
      text += GroupLines(one) + TestLines(one);
    }
  }
  return tested ? text + "\nWhy to believe which p: see the notes in --json or the report." : text;
}

}  // namespace footing::study::report
