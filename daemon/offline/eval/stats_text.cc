#include "daemon/offline/eval/stats_text.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "common/base/utf8.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

/// Four significant digits; "-" where the report has none.
std::string Cell(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number()) return "-";
  const double number = value.get<double>();
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

std::string Table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], text::Characters(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - text::Characters(row[i]), ' ');
      line += (i == 0 ? row[i] + padding : "  " + padding + row[i]);
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::string StatsText(const ordered_json& report) {
  std::string text = report.at("procedure").get<std::string>() + " (" +
                     report.at("alternative").get<std::string>() + ", " +
                     report.at("method").get<std::string>() + ")\n\n";
  std::vector<std::vector<std::string>> groups = {{"group", "n", "mean", "sd", "median"}};
  for (const ordered_json& group : report.at("groups")) {
    groups.push_back({Cell(group.at("group")), Cell(group.at("n")), Cell(group.at("mean")),
                      Cell(group.at("standard_deviation")), Cell(group.at("median"))});
  }
  text += Table(groups) + "\n";
  std::vector<std::string> names = {"estimate", "low", "high", "statistic", "df", "p"};
  for (const char* name : {"paired_p", "block_dunnett_p", "wilcoxon_exact_holm"}) {
    if (report.at("rows").front().contains(name)) names.emplace_back(name);
  }
  std::vector<std::vector<std::string>> rows = {{"comparison"}};
  rows.front().insert(rows.front().end(), names.begin(), names.end());
  for (const ordered_json& row : report.at("rows")) {
    std::vector<std::string>& cells = rows.emplace_back();
    cells.push_back(Cell(row.at("comparison")));
    for (const std::string& name : names) cells.push_back(Cell(row.at(name)));
  }
  text += Table(rows);
  if (report.contains("friedman_p")) {
    text += "Friedman: chi2 " + Cell(report.at("friedman_chi2")) + ", df " +
            Cell(report.at("friedman_df")) + ", p " + Cell(report.at("friedman_p")) + "\n";
  }
  return text + "\n" + report.at("note").get<std::string>() + "\n";
}

}  // namespace footing::eval
