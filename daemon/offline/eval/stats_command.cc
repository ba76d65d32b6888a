#include "daemon/offline/eval/stats_command.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/cli/cli.h"
#include "common/runtime/data_file.h"
#include "common/statistics/analysis.h"
#include "common/statistics/study_table.h"
#include "common/cli/statistics_options.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/stats_text.h"

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

}  // namespace footing::eval
