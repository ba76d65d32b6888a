#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/motion/edit.h"
#include "common/virtual_sensors/scene.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/training/alignment.h"
#include "daemon/offline/training/basis.h"

namespace footing::train {
namespace {

constexpr double kRootHeightM = 1;

struct Options {
  MotionOptions motions;
  ModelOptions model;
};

/// On the ground, and as large as a person whose root is 1 m high in the T-pose.
motion::Motion Standing(motion::Motion motion, const body::Landmarks& landmarks) {
  motion.q.row(2).array() -= virtual_sensors::FloorHeight(motion, landmarks);
  motion.q.topRows<3>() *= kRootHeightM / body::TPose(motion.skeleton, landmarks)(2);
  return motion;
}

/// The motions and their mirror images: people are as often left as right.
std::vector<motion::Motion> WithMirrors(const std::vector<Clip>& clips) {
  std::vector<motion::Motion> motions;
  for (const Clip& clip : clips) {
    const body::Landmarks& landmarks = clip.body.landmarks;
    motions.push_back(Standing(clip.motion, landmarks));
    motions.push_back(
        Standing(training::Aligned(motion::Mirrored(clip.motion), landmarks), landmarks));
  }
  return motions;
}

/// Poses 60 times a second, a column each; all clips must have one layout.
Result<Eigen::MatrixXd> Poses(const std::vector<Clip>& clips,
                              const std::vector<motion::Motion>& motions) {
  constexpr double kRateHz = 60;
  const std::vector<std::string> dofs = DofNames(clips.front().motion.skeleton);
  std::vector<Eigen::VectorXd> columns;
  for (const Clip& clip : clips) {
    if (DofNames(clip.motion.skeleton) != dofs) {
      return InvalidData(clip.name + ": another skeleton layout than " + clips.front().name +
                         "; train a basis of one layout at a time");
    }
  }
  for (const motion::Motion& motion : motions) {
    const double step = std::max(1.0, motion.rate_hz / kRateHz);
    for (double at = 0; at < static_cast<double>(motion.frames()); at += step) {
      columns.emplace_back(motion.q.col(static_cast<Eigen::Index>(at)));
    }
  }
  Eigen::MatrixXd poses(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    poses.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return poses;
}

int Run(const Options& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<Clips> clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  const std::vector<motion::Motion> motions = WithMirrors(clips->train);
  const Result<Eigen::MatrixXd> poses = Poses(clips->train, motions);
  if (!poses) return cli::Report(poses.error());
  training::PoseBasis basis =
      training::MakeBasis(*poses, DofNames(clips->train.front().motion.skeleton));
  std::vector<const motion::Motion*> all;
  for (const motion::Motion& motion : motions) all.push_back(&motion);
  training::AddRates(all, basis);

  model::Model model{.kind = "basis",
                     .provenance = {.program_version = cli::Version(),
                                    .command = shared.command_line,
                                    .seed = options.model.seed,
                                    .data = DataFiles(clips->train),
                                    .subjects = clips->subjects},
                     .tensors = {}};
  training::AppendTensors(basis, model);
  model.tensors.push_back({.name = "root_height_m", .shape = {1}, .values = {kRootHeightM}});
  if (auto written = WriteModel(model, options.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"dof", basis.mean.size()},
                                         {"poses", poses->cols()},
                                         {"subjects", clips->subjects},
                                         {"components_90", basis.ComponentsFor(0.9)},
                                         {"components_99", basis.ComponentsFor(0.99)},
                                         {"components_9999", basis.ComponentsFor(0.9999)}};
  if (shared.json) {
    std::cout << report.dump() << std::endl;
  } else {
    std::cout << options.model.out << ": " << basis.mean.size() << " components of "
              << poses->cols() << " poses; " << basis.ComponentsFor(0.9) << " hold 90 %, "
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
