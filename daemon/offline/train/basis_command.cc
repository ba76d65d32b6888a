#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/base/json_text.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/offline/train/poses.h"

namespace footing::train {
namespace {

struct BasisOptions {
  MotionOptions motions;
  OwnOptions own;
  ModelOptions model;
};

constexpr double kEnoughS = 90;  // Of range of motion: section 6.

int Run(const BasisOptions& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<TrainingSet> set =
      ReadTrainingSet(options.motions, options.own, kEnoughS, "for the basis of poses");
  if (!set) return cli::Report(set.error());
  const Result<TrainedBasis> trained = TrainBasis(set->AllClips());
  if (!trained) return cli::Report(trained.error());
  const learning::PoseBasis& basis = trained->basis;

  model::Model model =
      NewModel("basis", shared, options.model, set->DataFiles(), set->clips.subjects);
  AppendBasis(basis, model);
  if (auto written = WriteModel(model, options.model); !written) {
    return cli::Report(written.error());
  }
  nlohmann::ordered_json report = {{"dof", basis.mean.size()},
                                   {"poses", trained->poses},
                                   {"subjects", set->clips.subjects},
                                   {"components_90", basis.ComponentsFor(0.9)},
                                   {"components_99", basis.ComponentsFor(0.99)},
                                   {"components_9999", basis.ComponentsFor(0.9999)}};
  AppendOwn(*set, report);
  if (shared.json) {
    std::cout << text::ToText(report) << std::endl;
  } else {
    std::cout << options.model.out << ": " << basis.mean.size() << " components of "
              << trained->poses << " poses; " << basis.ComponentsFor(0.9) << " hold 90 %, "
              << basis.ComponentsFor(0.99) << " hold 99 % of the variance" << std::endl;
  }
  return 0;
}

}  // namespace

void AddBasisCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<BasisOptions>();
  CLI::App* command =
      app.add_subcommand("basis", "Pose basis: principal components of the poses in motion files");
  AddMotionOptions(*command, options->motions);
  AddOwnOptions(*command, options->own);
  AddModelOptions(*command, options->model);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
