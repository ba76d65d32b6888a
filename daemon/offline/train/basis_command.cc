#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/poses.h"

namespace footing::train {
namespace {

struct Options {
  MotionOptions motions;
  ModelOptions model;
};

int Run(const Options& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<Clips> clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  const Result<TrainedBasis> trained = TrainBasis(clips->train);
  if (!trained) return cli::Report(trained.error());
  const training::PoseBasis& basis = trained->basis;

  model::Model model =
      NewModel("basis", shared, options.model, DataFiles(clips->train), clips->subjects);
  AppendBasis(basis, model);
  if (auto written = WriteModel(model, options.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"dof", basis.mean.size()},
                                         {"poses", trained->poses},
                                         {"subjects", clips->subjects},
                                         {"components_90", basis.ComponentsFor(0.9)},
                                         {"components_99", basis.ComponentsFor(0.99)},
                                         {"components_9999", basis.ComponentsFor(0.9999)}};
  if (shared.json) {
    std::cout << report.dump() << std::endl;
  } else {
    std::cout << options.model.out << ": " << basis.mean.size() << " components of "
              << trained->poses << " poses; " << basis.ComponentsFor(0.9) << " hold 90 %, "
              << basis.ComponentsFor(0.99) << " hold 99 % of the variance" << std::endl;
  }
  return 0;
}

}  // namespace

void AddBasisCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("basis", "Principal components of the poses in motion files");
  AddMotionOptions(*command, options->motions);
  AddModelOptions(*command, options->model);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
