#include <memory>

#include "clients/study/commands.h"
#include "clients/study/report/analysis.h"
#include "clients/study/report/page.h"
#include "common/recording/output_file.h"

namespace footing::study {
namespace {

struct ReportOptions {
  ProtocolOptions protocol;
  std::string out;
  bool force = false;
};

Result<void> Write(const std::string& path, const std::string& text, bool force) {
  auto file = recording::OutputFile::Create(path, force);
  if (!file) return file.error();
  if (const auto done = file->Write(text); !done) return done;
  return file->Sync();
}

Result<Answer> Analyze(const ProtocolOptions& options) {
  const auto loaded = Load(options.path, options.folder);
  if (!loaded) return loaded.error();
  const auto people = ReadPeople(*loaded);
  if (!people) return people.error();
  const report::Analysis analysis = report::Analyze(loaded->protocol, *people);
  return Answer{analysis.json, report::Summary(analysis)};
}

Result<Answer> Report(const ReportOptions& options) {
  const auto loaded = Load(options.protocol.path, options.protocol.folder);
  if (!loaded) return loaded.error();
  const auto people = ReadPeople(*loaded);
  if (!people) return people.error();
  const report::Analysis analysis = report::Analyze(loaded->protocol, *people);
  const std::string page = options.out.empty() ? loaded->folder + "/report.html" : options.out;
  const std::string csv =
      (page.ends_with(".html") ? page.substr(0, page.size() - 5) : page) + ".csv";
  const std::string html = report::Page(analysis, loaded->protocol, *people);
  if (const auto done = Write(page, html, options.force); !done) return done.error();
  if (const auto done = Write(csv, report::ValuesCsv(analysis), options.force); !done) {
    return done.error();
  }
  return Answer{{{"page", page}, {"csv", csv}, {"synthetic", analysis.synthetic}},
                "wrote " + page + " and " + csv};
}

}  // namespace

void AddReportCommands(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* analyze = app.add_subcommand("analyze", "Compare the interfaces with the control");
  AddProtocolOptions(*analyze, options->protocol);
  analyze->callback([options, &shared] { Finish(Analyze(options->protocol), shared); });
  CLI::App* report = app.add_subcommand("report", "Write the analysis as an HTML page and a CSV");
  AddProtocolOptions(*report, options->protocol);
  report->add_option("--out", options->out,
                     "HTML file; the CSV is beside it (default: report.html in the folder)");
  report->add_flag("--force", options->force, "Overwrite existing files");
  report->callback([options, &shared] { Finish(Report(*options), shared); });
}

}  // namespace footing::study
