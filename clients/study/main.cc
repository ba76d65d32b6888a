#include "clients/study/commands.h"
#include "common/cli/cli.h"

int main(int argc, char** argv) {
  auto app = footing::cli::NewApp(
      "footing-study", "Runs a user study of interfaces, from the protocol file to the report.",
      "  footing-study check study.json\n"
      "  footing-study run study.json --participant P01\n"
      "  footing-study run study.json --participant P01 --unattended --folder trial.study\n"
      "  footing-study simulate study.json --folder trial.study\n"
      "  footing-study ranges --interface wrist --participant P01 --out P01_wrist.json\n"
      "  footing-study analyze study.json --folder trial.study\n"
      "  footing-study report study.json --folder trial.study --force\n"
      "  footing-study export study.json --folder trial.study --out trial.bids\n");
  footing::study::Shared shared;
  app->add_flag("--json", shared.json, "Print one JSON object on standard output");
  app->require_subcommand(1);
  app->fallthrough();
  footing::study::AddCheckCommand(*app, shared);
  footing::study::AddRunCommand(*app, shared);
  footing::study::AddSimulateCommand(*app, shared);
  footing::study::AddSurveyCommand(*app, shared);
  footing::study::AddRangesCommand(*app, shared);
  footing::study::AddReportCommands(*app, shared);
  footing::study::AddExportCommand(*app, shared);
  if (const auto code = footing::cli::Parse(*app, argc, argv)) return *code;
  return shared.exit_code;
}
