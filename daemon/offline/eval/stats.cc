#include "daemon/offline/eval/stats.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/cli/statistics_options.h"
#include "common/runtime/files.h"
#include "common/statistics/analysis.h"
#include "common/statistics/study_table.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;
using statistics::NamesOf;

struct StatsOptions {
  std::string data;
  std::string test;
  statistics_options::Options shared;
  std::string control;
  statistics::AnalysisRequest request;
};

Result<ordered_json> EvaluateStats(const StatsOptions& options) {
  statistics::AnalysisRequest request = options.request;
  request.test = statistics::Named(options.test, statistics::kTests);
  if (!options.shared.ties.empty() && request.test != statistics::TestKind::kSteel) {
    return UsageError("--ties applies to --test steel only");
  }
  const auto chosen = statistics_options::ChosenIn(options.shared);
  request.alternative = chosen.alternative;
  request.ties = chosen.ties;
  request.method = chosen.method;
  const auto text = config::ReadTextFile(options.data);
  if (!text) return text.error();
  const auto table = statistics::ParseStudyTable(
      *text, {options.data, options.control, statistics::UseOf(request.test)});
  if (!table) return table.error();
  auto report = statistics::Analyze(*table, request);
  if (!report && report.error().kind == ErrorKind::kInvalidData) {
    return InvalidData(options.data + ": " + report.error().message);
  }
  return report;
}

void AddStatsOptions(CLI::App& command, StatsOptions& options) {
  command.add_option("--test", options.test, "Test of each group against the control")
      ->required()
      ->check(CLI::IsMember(NamesOf(statistics::kTests)));
  command
      .add_option("--data", options.data,
                  "CSV with the columns group_index,group,value, where group_index 0 is the "
                  "control; paired: subject,group,value; rate: whole values, and optionally "
                  "exposure")
      ->required();
  statistics_options::Add(command, options.shared,
                          "Source of p (default: exact where feasible, otherwise permutation; "
                          "rate: asymptotic)");
  command.add_option("--seed", options.request.seed, "Seed of the random permutations");
  command
      .add_option("--permutations", options.request.permutations, "Number of random permutations")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  command
      .add_option("--confidence", options.request.confidence,
                  "Confidence of all intervals together")
      ->check(CLI::Range(0.501, 0.999999));
  command.add_option("--control", options.control,
                     "Name of the control group (default: the one with group_index 0; paired: the "
                     "one named control, otherwise the first)");
}

}  // namespace

void AddStatsCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand(
      "stats", "Tests of several groups against one control: Dunnett, Steel, paired, rates");
  const auto options = std::make_shared<StatsOptions>();
  AddStatsOptions(*command, *options);
  command->footer(
      "Examples:\n"
      "  footing-eval stats --test steel --data ratings.csv --json\n"
      "  footing-eval stats --test dunnett --data oscillation.csv --alternative less\n"
      "  footing-eval stats --test paired --data oscillation.csv\n"
      "  footing-eval stats --test rate --data failures.csv --json\n"
      "docs/statistics.md explains which test answers what. footing-stream sample . writes these "
      "files.");
  command->callback([options, &shared] {
    const Result<ordered_json> out = EvaluateStats(*options);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
      return;
    }
    if (shared.json) {
      PrintReport(*out, true);
    } else {
      std::fputs(StatsText(*out).c_str(), stdout);
    }
  });
}

namespace {

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
