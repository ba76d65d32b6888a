#include "clients/study/report/page.h"

#include <cmath>

#include "clients/study/report/figure.h"
#include "common/text/number.h"

namespace footing::study::report {
namespace {

using nlohmann::ordered_json;

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:2rem auto;"
    "padding:0 1rem}h1,h2{font-weight:300}table{border-collapse:collapse;margin:.5rem 0}"
    "td,th{font-weight:400;text-align:right;padding:.1rem .8rem .1rem 0;"
    "border-bottom:1px solid #e5e5e5}td:first-child,th:first-child{text-align:left}"
    "th{color:#777}svg text{font-size:11px;fill:#555}.grid{stroke:#eee}"
    "rect{fill:#dfe8f1;stroke:#89a}.median{stroke:#246;stroke-width:2}"
    ".pair{fill:none;stroke:#246;opacity:.25}circle{fill:#246;opacity:.7}"
    ".synthetic{background:#fff3cd;padding:.5rem 1rem}.note{color:#777;font-size:13px}";

/// Four significant digits, or an en dash where there is no number.
std::string Short(const ordered_json& object, const char* key) {
  if (!object.contains(key) || !object[key].is_number()) return "–";
  const double value = object[key].get<double>();
  if (value == 0) return "0";
  const double scale = std::pow(10, 3 - std::floor(std::log10(std::abs(value))));
  return text::Shortest(std::round(value * scale) / scale);
}

std::string NameOfRow(const ordered_json& row) {
  for (const char* key : {"comparison", "group"}) {
    if (row.contains(key) && row[key].is_string()) return row[key];
  }
  return "";
}

std::string Row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    row += std::string("<") + tag + ">" + Escaped(cell) + "</" + tag + ">";
  }
  return row + "</tr>";
}

std::string GroupTable(const ordered_json& groups) {
  std::string table =
      "<table>" + Row({"interface", "n", "mean", "median", "least", "greatest"}, "th");
  for (const ordered_json& group : groups) {
    table += Row({group["interface"], Short(group, "n"), Short(group, "mean"),
                  Short(group, "median"), Short(group, "least"), Short(group, "greatest")},
                 "td");
  }
  return table + "</table>";
}

std::string TestTable(const ordered_json& test) {
  if (test.contains("error")) {
    return "<p class=\"note\">" + Escaped(test["error"].get<std::string>()) + "</p>";
  }
  std::string table =
      "<table>" + Row({"against the control", "estimate", "statistic", "p", "p, paired"}, "th");
  for (const ordered_json& row : test["rows"]) {
    table += Row({NameOfRow(row), Short(row, "estimate"), Short(row, "statistic"), Short(row, "p"),
                  Short(row, "paired_p")},
                 "td");
  }
  return table + "</table><p class=\"note\">" + Escaped(test.value("procedure", "")) + ". " +
         Escaped(test.value("note", "")) + "</p>";
}

std::string Answers(const std::vector<records::Records>& people) {
  std::string table;
  for (const records::Records& person : people) {
    if (person.withdrawn) continue;
    for (const records::Answer& answer : person.answers) {
      if (answer.text.empty()) continue;
      table += Row({answer.interface.empty() ? "whole study" : answer.interface, answer.question,
                    answer.text},
                   "td");
    }
  }
  if (table.empty()) return "";
  return "<h2>Answers</h2><table>" + Row({"interface", "question", "answer"}, "th") + table +
         "</table>";
}

std::string Heading(const ordered_json& json) {
  std::string text = std::to_string(json["participants"].get<std::size_t>()) + " participants";
  for (const char* kind : {"withdrawn", "unfinished"}) {
    const auto count = json[kind].get<std::size_t>();
    if (count > 0) text += ", " + std::to_string(count) + " " + kind;
  }
  return text + "; control: " + json["control"].get<std::string>();
}

constexpr const char* kSynthetic =
    "Synthetic: simulated devices or random answers. It says nothing about people.";

}  // namespace

std::string Page(const Analysis& analysis, const plan::Protocol& protocol,
                 const std::vector<records::Records>& people) {
  const ordered_json& json = analysis.json;
  std::string page = "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     Escaped(protocol.name) + "</title><style>" + kStyle +
                     "</style></head><body><h1>" + Escaped(protocol.name) + "</h1><p>" +
                     Escaped(Heading(json)) + "</p>";
  if (analysis.synthetic) {
    page += std::string("<p class=\"synthetic\">") + kSynthetic + "</p>";
  }
  for (std::size_t i = 0; i < analysis.measures.size(); ++i) {
    const ordered_json& one = json["measures"][i];
    page += "<h2>" + Escaped(analysis.measures[i].title) + "</h2>" +
            Figure(analysis.measures[i], protocol) + GroupTable(one["groups"]);
    if (one.contains("test")) page += TestTable(one["test"]);
  }
  return page + Answers(people) + "</body></html>\n";
}

std::string Summary(const Analysis& analysis) {
  const ordered_json& json = analysis.json;
  std::string text = json["name"].get<std::string>() + ": " + Heading(json);
  if (analysis.synthetic) text += std::string("\n") + kSynthetic;
  for (const ordered_json& one : json["measures"]) {
    text += "\n" + one["title"].get<std::string>();
    for (const ordered_json& group : one["groups"]) {
      text += "\n  " + group["interface"].get<std::string>() + ": median " +
              Short(group, "median") + ", mean " + Short(group, "mean") + ", n " +
              Short(group, "n");
    }
    if (!one.contains("test") || one["test"].contains("error")) continue;
    for (const ordered_json& row : one["test"]["rows"]) {
      text += "\n  " + NameOfRow(row) + ": " + one["test"]["test"].get<std::string>() + " p " +
              Short(row, "p") + ", paired p " + Short(row, "paired_p");
    }
  }
  return text;
}

}  // namespace footing::study::report
