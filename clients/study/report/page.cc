#include "clients/study/report/page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "clients/study/report/analysis.h"
#include "common/base/text.h"

namespace footing::study::report {
namespace {

using nlohmann::ordered_json;

constexpr double kSignificant = 0.05;
constexpr double kLeastP = 0.0001;
constexpr const char* kNoBreak = "\u00a0";

std::string Rounded(double value) {
  if (value == 0) return "0";
  const double scale = std::pow(10, 3 - std::floor(std::log10(std::abs(value))));
  return text::Shortest(std::round(value * scale) / scale);
}

/// JSON and CSV have all digits.
std::string P(double p) { return p < kLeastP ? "<" + text::Fixed(kLeastP, 4) : text::Fixed(p, 4); }

/// "low to high", of simultaneous intervals.
std::string IntervalText(const ordered_json& ends) {
  return Short(ends, "low") + " to " + Short(ends, "high");
}

/// An effect size with its interval.
std::string EffectText(const ordered_json& row, const char* key) {
  if (!row.contains(key)) return "–";
  return Short(row[key], "estimate") + " (" + IntervalText(row[key]) + ")";
}

std::string Capitalised(std::string name) {
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::string Row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    row += std::string("<") + tag + ">" + Escaped(cell) + "</" + tag + ">";
  }
  return row + "</tr>";
}

/// Significant p of a test against the control: within subjects where that is known, otherwise from
/// the test of independent groups, marked as such. Empty where it is not below 0.05.
std::string SignificantP(const ordered_json& measure, const std::string& interface) {
  if (!measure.contains("test") || measure["test"].contains("error")) return "";
  for (const ordered_json& row : measure["test"]["rows"]) {
    if (row.value("group", "") != interface) continue;
    const bool paired = row.contains("paired_p") && row["paired_p"].is_number();
    const ordered_json& p = row[paired ? "paired_p" : "p"];
    if (!p.is_number() || p.get<double>() >= kSignificant) return "";
    return std::string(" (p") + kNoBreak + P(p) + (paired ? ")" : ", independent)");
  }
  return "";
}

bool AllZero(const ordered_json& measure) {
  return std::all_of(
      measure["groups"].begin(), measure["groups"].end(),
      [](const ordered_json& group) { return group["least"] == 0 && group["greatest"] == 0; });
}

/// How many trials of a group are lower bounds of a time to failure; empty: none.
std::string CensoredText(const ordered_json& group) {
  const auto censored = group.value("censored", std::size_t{0});
  if (censored == 0) return "";
  return ", " + std::to_string(censored) + " of " + Short(group, "n") + " censored";
}

std::string ErrorNote(const ordered_json& test) {
  return "<p class=\"note\">" + Escaped(test["error"].get<std::string>()) + "</p>";
}

}  // namespace

std::string Short(const ordered_json& object, const char* key) {
  if (!object.contains(key) || !object[key].is_number()) return "–";
  return Rounded(object[key].get<double>());
}

std::string PText(const ordered_json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? P(object[key].get<double>()) : "–";
}

std::string IndependentPText(const ordered_json& row) {
  const bool too_few = row.value("n", 2) < 2 && row.value("n_control", 2) < 2;
  return too_few ? "– (too few values)" : PText(row, "p");
}

std::string NameOfRow(const ordered_json& row) {
  for (const char* key : {"comparison", "group"}) {
    if (row.contains(key) && row[key].is_string()) return row[key];
  }
  return "";
}

std::string OverviewTable(const ordered_json& analysis,
                          const std::vector<std::string>& interfaces) {
  std::vector<std::string> heads = {"median; p against the control below 0.05"};
  heads.insert(heads.end(), interfaces.begin(), interfaces.end());
  std::string table = "<table>" + Row(heads, "th");
  for (const ordered_json& measure : analysis["measures"]) {
    if (AllZero(measure)) continue;
    std::vector<std::string> cells = {measure["title"]};
    for (const std::string& interface : interfaces) {
      std::string cell = "–";
      for (const ordered_json& group : measure["groups"]) {
        if (group["interface"] != interface) continue;
        cell = Short(group, "median") + SignificantP(measure, interface) + CensoredText(group);
      }
      cells.push_back(cell);
    }
    table += Row(cells, "td");
  }
  return table + "</table>";
}

std::string GroupTable(const ordered_json& groups) {
  std::vector<std::string> heads = {"interface", "n", "mean", "median", "least", "greatest"};
  const bool censored = std::any_of(groups.begin(), groups.end(), [](const ordered_json& group) {
    return group.contains("censored");
  });
  if (censored) heads.emplace_back("censored");
  std::string table = "<table>" + Row(heads, "th");
  for (const ordered_json& group : groups) {
    std::vector<std::string> cells = {group["interface"]};
    for (const char* key : {"n", "mean", "median", "least", "greatest"}) {
      cells.push_back(Short(group, key));
    }
    if (censored) cells.push_back(Short(group, "censored"));
    table += Row(cells, "td");
  }
  return table + "</table>";
}

std::string TestTable(const ordered_json& test) {
  if (test.contains("error")) return ErrorNote(test);
  const std::string name = test.value("test", "");
  const bool of_means = name == "dunnett";
  std::vector<std::string> heads = {Capitalised(name) + ", independent groups", "statistic", "p"};
  if (of_means) heads.insert(heads.end(), {"mean difference", "95 % interval"});
  heads.insert(heads.end(), {"Hodges-Lehmann (95 %)", "Cliff's delta (95 %)"});
  std::string table = "<table>" + Row(heads, "th");
  for (const ordered_json& row : test["rows"]) {
    std::vector<std::string> cells = {NameOfRow(row), Short(row, "statistic"),
                                      IndependentPText(row)};
    if (of_means) {
      cells.insert(cells.end(),
                   {Short(row, "estimate"), IntervalText(row), EffectText(row, "hodges_lehmann")});
    } else {  // The estimate of a rank test is that shift.
      cells.push_back(Short(row, "estimate") + " (" + IntervalText(row) + ")");
    }
    cells.push_back(EffectText(row, "cliffs_delta"));
    table += Row(cells, "td");
  }
  return table + "</table>";
}

std::string PairedTable(const ordered_json& paired) {
  if (paired.contains("error")) return ErrorNote(paired);
  std::string table =
      "<table>" + Row({"Within participants", "paired p", "Wilcoxon p (Holm)", "blocked Dunnett p",
                       "mean difference (95 %)", "Hodges-Lehmann (95 %)", "Cliff's delta (95 %)"},
                      "th");
  for (const ordered_json& row : paired["rows"]) {
    table +=
        Row({NameOfRow(row), PText(row, "permutation_p"), PText(row, "wilcoxon_exact_holm"),
             PText(row, "block_dunnett_p"), Short(row, "estimate") + " (" + IntervalText(row) + ")",
             EffectText(row, "hodges_lehmann"), EffectText(row, "cliffs_delta")},
            "td");
  }
  return table + "</table>";
}

std::string FriedmanText(const ordered_json& paired) {
  if (!paired.contains("friedman_p")) return "";
  return "Friedman's test: chi-square " + Short(paired, "friedman_chi2") + ", degrees of freedom " +
         Short(paired, "friedman_df") + ", p " + PText(paired, "friedman_p") + ", by permutation " +
         PText(paired, "friedman_permutation_p") + ".";
}

std::string RateText(const ordered_json& row) {
  return NameOfRow(row) + ": " + Short(row, "estimate") + " times the failures per minute (" +
         IntervalText(row) + "), p " + PText(row, "p") + ", paired p " + PText(row, "paired_p");
}

std::string RateTable(const ordered_json& rate) {
  if (rate.contains("error")) return ErrorNote(rate);
  std::string table =
      "<table>" +
      Row({"failures a minute", "ratio of rates", "95 % interval", "p", "paired p"}, "th");
  for (const ordered_json& row : rate["rows"]) {
    table += Row({NameOfRow(row), Short(row, "estimate"), IntervalText(row), PText(row, "p"),
                  PText(row, "paired_p")},
                 "td");
  }
  return table + "</table>";
}

std::string LatencyTable(const std::vector<StageLatency>& latency) {
  std::vector<std::string> heads = {"median / 95 %, ms"};
  std::vector<std::string> counts = {"responses"};
  std::vector<std::string> stages;
  std::map<std::string, std::vector<std::string>> cells;  // By stage: one for each interface.
  for (const StageLatency& one : latency) {
    if (one.interface != heads.back()) {
      heads.push_back(one.interface);
      counts.push_back(std::to_string(one.responses));
    }
    if (!cells.contains(one.stage)) stages.push_back(one.stage);
    std::vector<std::string>& row = cells[one.stage];
    row.resize(heads.size() - 1, "–");
    row.back() = text::Fixed(one.p50_ms, 1) + " / " + text::Fixed(one.p95_ms, 1);
  }
  std::string table = "<table>" + Row(heads, "th");
  for (const std::string& stage : stages) {
    std::vector<std::string> row = cells[stage];
    row.resize(heads.size() - 1, "–");
    row.insert(row.begin(), stage);
    table += Row(row, "td");
  }
  return table + Row(counts, "td") + "</table>";
}

std::string WholeStudyTable(const std::vector<records::Records>& people) {
  std::map<std::string, std::vector<double>> values;  // By item.
  for (const records::Records& person : people) {
    if (person.withdrawn) continue;
    for (const records::Rating& rating : person.ratings) {
      const bool exertion = rating.item == plan::kExertionItem;
      const std::string item = rating.item + (exertion ? ", 0 to 10" : ", rating 1 to 5");
      if (rating.interface.empty()) values[item].push_back(rating.value);
    }
  }
  std::string table;
  for (const auto& [item, all] : values) {
    const Quartiles box = QuartilesOf(all);
    table += Row({item, std::to_string(all.size()), Rounded(box.median),
                  Rounded(box.low) + " to " + Rounded(box.high)},
                 "td");
  }
  if (table.empty()) return "";
  return "<h2>Ratings of the whole study</h2><table>" +
         Row({"item", "n", "median", "quartiles"}, "th") + table + "</table>";
}

std::string AnswerTable(const std::vector<records::Records>& people) {
  // Sorted, since the order of the participants would say whose they are.
  std::vector<std::vector<std::string>> answers;
  for (const records::Records& person : people) {
    if (person.withdrawn) continue;
    for (const records::Answer& answer : person.answers) {
      if (answer.text.empty()) continue;
      const bool looks_back = answer.at_end && !answer.interface.empty();
      answers.push_back({answer.interface.empty() ? "whole study" : answer.interface,
                         answer.question + (looks_back ? ", at the end" : ""), answer.text});
    }
  }
  if (answers.empty()) return "";
  std::sort(answers.begin(), answers.end());
  std::string table;
  for (const std::vector<std::string>& answer : answers) table += Row(answer, "td");
  return "<h2>Answers</h2><table>" + Row({"interface", "question", "answer"}, "th") + table +
         "</table>";
}

namespace {

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

/// Results of the tests within participants for one comparison.
std::string PairedText(const ordered_json& row) {
  return "paired p " + PText(row, "permutation_p") + ", Wilcoxon " +
         PText(row, "wilcoxon_exact_holm") + ", blocked Dunnett " + PText(row, "block_dunnett_p") +
         ", Cliff's delta " + Short(row["cliffs_delta"], "estimate");
}

bool Has(const ordered_json& measure, const char* test) {
  return measure.contains(test) && !measure[test].contains("error");
}

/// Results of both tests for each comparison, as far as they could be made.
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

/// Notes below the tests within participants.
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

/// Tests of a measure to rely on, without the reasons, and remarks on the data.
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
