#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/runtime/log.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/offline/train/poses.h"

namespace footing::train {
namespace {

constexpr double kEnoughPoseS = 90;  // Of range of motion: section 6.

struct PoseOptions {
  MotionOptions motions;
  OwnOptions own;
  ModelOptions model;
};

/// The same of an own recording, with what its boards measured, `weight` times.
Result<void> AddOwn(const OwnRecording& own, const reconstruction::Models& models,
                    learning::PoseCues cues, int weight, std::uint64_t seed, int piece,
                    learning::PoseExamples& examples) {
  learning::OwnExampleSettings settings;
  settings.cues = cues;
  settings.piece_s = kPosePieceS;
  settings.first_piece = piece;
  settings.settled_s = kSettledS;
  const auto image = learning::MirrorImage(own.take);
  if (!image) return image.error();
  for (int i = 0; i < weight; ++i) {
    for (const learning::OwnTake* take : {&own.take, &*image}) {
      settings.seed = seed++;
      const auto added = learning::AddOwnExamples(*take, models, settings, examples);
      if (!added) return added;
    }
  }
  return {};
}

/// Of all clips and their mirror images, and of the own recordings.
Result<learning::PoseExamples> Examples(const TrainingSet& set, const model::Model& model,
                                        learning::PoseCues cues, std::uint64_t seed) {
  const auto models = reconstruction::MakeModels({{"the new model", model}});
  if (!models) return models.error();
  learning::PoseExamples examples;
  int piece = 0;
  std::vector<const Clip*> clips;
  for (const Clip& clip : set.clips.train) clips.push_back(&clip);
  for (const PoseTake& take : TakesOf(clips, seed, piece)) {
    if (const auto added = AddExamples(take, *models, cues, examples); !added) {
      return added.error();
    }
    if (take.mirrored) log::Info("simulated " + take.clip->name);
  }
  for (const OwnRecording& own : set.own) {
    const auto added = AddOwn(own, *models, cues, set.weight,
                              seed + 2 * static_cast<std::uint64_t>(piece), piece, examples);
    if (!added) return added.error();
    piece += 1 + static_cast<int>(own.take.motion.duration_s() / kPosePieceS);
    log::Info("replayed " + own.file.name);
  }
  return examples;
}

int Run(const PoseOptions& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<TrainingSet> set =
      ReadTrainingSet(options.motions, options.own, kEnoughPoseS, "for the basis of poses");
  if (!set) return cli::Report(set.error());
  const Result<TrainedBasis> trained = TrainBasis(set->AllClips());
  if (!trained) return cli::Report(trained.error());
  model::Model model =
      NewModel("basis", shared, options.model, set->DataFiles(), set->clips.subjects);
  AppendBasis(trained->basis, model);
  // The momentum's filters take postures in, so these are learned first.
  const std::uint64_t seed = options.model.seed;
  const auto postures = Examples(*set, model, learning::PoseCues::kPosture, seed);
  if (!postures) return cli::Report(postures.error());
  const Eigen::VectorXd& scale = trained->basis.scale;
  const auto posture = AppendPoses(*postures, learning::PoseCues::kPosture, scale, seed, model);
  const auto examples = Examples(*set, model, learning::PoseCues::kMomentum, seed);
  if (!examples) return cli::Report(examples.error());
  const auto fitted = AppendPoses(*examples, learning::PoseCues::kMomentum, scale, seed, model);
  model.kind = "pose";
  nlohmann::ordered_json report = {{"dof", trained->basis.mean.size()},
                                   {"poses", trained->poses},
                                   {"examples", examples->poses.size()},
                                   {"subjects", set->clips.subjects},
                                   {"ridge", fitted.ridge},
                                   {"left_out_error", fitted.error},
                                   {"left_out_posture_error", posture.error},
                                   {"spread", fitted.spread}};
  AppendOwn(*set, report);
  return Deliver(model, options.model, report, shared);
}

}  // namespace

void AddPoseCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command = app.add_subcommand(
      "pose", "Pose model: the pose basis and a regression from boards and hands to a pose");
  AddMotionOptions(*command, options->motions);
  AddOwnOptions(*command, options->own);
  AddModelOptions(*command, options->model);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
