#include "clients/study/report/tables.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "clients/study/report/figure.h"
#include "common/base/number.h"

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

/// Of a test against the control: within subjects where that is known, otherwise of the test that
/// takes the groups as independent, and says so. Empty where it is not below 0.05.
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

}  // namespace footing::study::report
