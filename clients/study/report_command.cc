#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "clients/study/commands.h"
#include "clients/study/report/analysis.h"
#include "clients/study/report/page.h"
#include "common/recording/output_file.h"
#include "common/cli/statistics_options.h"

namespace footing::study {
namespace {

struct ReportOptions {
  ProtocolOptions protocol;
  statistics_options::Options tests{"two.sided", "pairwise", ""};
  std::optional<std::uint64_t> seed;
  std::string out;
  bool force = false;
};

Result<void> Write(const std::string& path, const std::string& text, bool force) {
  auto file = recording::OutputFile::Create(path, force);
  if (!file) return file.error();
  if (const auto done = file->Write(text); !done) return done;
  return file->Sync();
}

/// The study's records with the analysis of them.
struct Analysed {
  LoadedProtocol loaded;
  std::vector<records::Records> people;
  report::Analysis analysis;
};

Result<Analysed> ReadAndAnalyze(const ReportOptions& options) {
  auto loaded = Load(options.protocol.path, options.protocol.folder);
  if (!loaded) return loaded.error();
  auto people = ReadPeople(*loaded);
  if (!people) return people.error();
  const auto chosen = statistics_options::ChosenIn(options.tests);
  const report::TestOptions tests{chosen.alternative, chosen.ties, chosen.method, options.seed};
  report::Analysis analysis = report::Analyze(loaded->protocol, *people, tests);
  return Analysed{std::move(*loaded), std::move(*people), std::move(analysis)};
}

Result<Answer> Analyze(const ReportOptions& options) {
  const auto analysed = ReadAndAnalyze(options);
  if (!analysed) return analysed.error();
  return Answer{analysed->analysis.json, report::Summary(analysed->analysis)};
}

Result<Answer> Report(const ReportOptions& options) {
  const auto analysed = ReadAndAnalyze(options);
  if (!analysed) return analysed.error();
  const auto& [loaded, people, analysis] = *analysed;
  const std::string page = options.out.empty() ? loaded.folder + "/report.html" : options.out;
  const std::string csv =
      (page.ends_with(".html") ? page.substr(0, page.size() - 5) : page) + ".csv";
  const std::string html = report::Page(analysis, loaded.protocol, people);
  if (const auto done = Write(page, html, options.force); !done) return done.error();
  if (const auto done = Write(csv, report::ValuesCsv(analysis), options.force); !done) {
    return done.error();
  }
  return Answer{{{"page", page}, {"csv", csv}, {"synthetic", analysis.synthetic}},
                "wrote " + page + " and " + csv};
}

void AddTestOptions(CLI::App& command, ReportOptions& options) {
  statistics_options::Add(command, options.tests,
                          "Source of Steel's p (default: exact where feasible, otherwise "
                          "permutation)");
  command.add_option("--seed", options.seed,
                     "Seed of the random permutations (default: the protocol's)");
}

}  // namespace

void AddReportCommands(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* analyze = app.add_subcommand("analyze", "Compare the interfaces with the control");
  AddProtocolOptions(*analyze, options->protocol);
  AddTestOptions(*analyze, *options);
  analyze->callback([options, &shared] { Finish(Analyze(*options), shared); });
  CLI::App* report = app.add_subcommand("report", "Write the analysis as an HTML page and a CSV");
  AddProtocolOptions(*report, options->protocol);
  AddTestOptions(*report, *options);
  report->add_option("--out", options->out,
                     "HTML file; the CSV is beside it (default: report.html in the folder)");
  report->add_flag("--force", options->force, "Overwrite existing files");
  report->callback([options, &shared] { Finish(Report(*options), shared); });
}

}  // namespace footing::study
