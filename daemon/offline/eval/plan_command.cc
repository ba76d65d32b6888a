#include "daemon/offline/eval/plan_command.h"

#include <cerrno>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "common/cli/cli.h"
#include "common/runtime/data_file.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/track_plan.h"
#include "daemon/simulation/biped/track.h"

namespace footing::eval {
namespace {

struct PlanOptions {
  std::vector<std::string> tracks;
  std::string out;
};

int DrawPlan(const PlanOptions& options, bool json) {
  std::vector<plot::PlanPanel> panels;
  for (const std::string& name : options.tracks) {
    const auto text = config::ReadNamedOrPath(name, "tracks");
    if (!text) return cli::Report(text.error());
    const auto track = terrain::ParseTrack(*text, name);
    if (!track) return cli::Report(track.error());
    panels.push_back(PlanOf(name, *track));
  }
  std::ofstream file(options.out);
  file << plot::PlanPlot("Tracks from above", panels, PlanKeys());
  if (!file.flush()) {
    return cli::Report(Failure("cannot write " + options.out + ": " +
                               std::generic_category().message(errno) + "; name another file"));
  }
  PrintReport({{"out", options.out}, {"tracks", options.tracks}}, json);
  return 0;
}

}  // namespace

void AddPlanCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("plan", "Plan view of tracks, as SVG");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("TRACK", options->tracks, "Built-in names, or JSON files")->required();
  command->add_option("--out", options->out, "SVG file to write")->required();
  command->callback([options, &shared] { shared.exit_code = DrawPlan(*options, shared.json); });
}

}  // namespace footing::eval
