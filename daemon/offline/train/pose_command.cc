#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/log/log.h"
#include "common/virtual/motion/edit.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/offline/train/poses.h"

namespace footing::train {
namespace {

constexpr double kPosePieceS = 10;  // Frames of one piece are left out together.
constexpr double kSettledS = 1.5;   // After the T-pose.
constexpr double kCellNoiseKg = 0.05;
constexpr double kEnoughPoseS = 90;  // Of range of motion: section 6.

struct PoseOptions {
  MotionOptions motions;
  OwnOptions own;
  ModelOptions model;
};

/// What the sensors would have measured in one motion, and its poses.
Result<void> AddExamples(const motion::Motion& motion, const std::string& name,
                         const reconstruction::Models& basis, std::uint64_t seed, int& piece,
                         learning::PoseExamples& examples) {
  pose_run::Settings settings;
  settings.errors.noise_kg = kCellNoiseKg;
  settings.errors.seed = settings.seed = seed;
  const auto run = pose_run::RunPose(motion, settings, name);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = settings.rate_hz;
  auto made = reconstruction::Reconstruction::Create(run->body, basis, options);
  if (!made) return made.error();
  const double root_m = body::TPose(run->body.skeleton, run->body.landmarks)(2);
  const auto first = static_cast<std::size_t>((pose_run::kStandS + kSettledS) * settings.rate_hz);
  const auto piece_frames = static_cast<std::size_t>(kPosePieceS * settings.rate_hz);
  for (std::size_t i = 0; i < run->frames.size(); ++i) {
    const auto& output = made->Advance(run->frames[i].inputs);
    if (i < first) continue;
    if (!output.calibrated) return InvalidData(name + ": its T-pose never stood still");
    Eigen::VectorXd pose = run->frames[i].q;
    pose.head<3>() = (pose.head<3>() - output.momentum.p_WC_m) / root_m;
    examples.features.push_back(made->features().values());
    examples.poses.push_back(std::move(pose));
    examples.folds.push_back((piece + static_cast<int>((i - first) / piece_frames)) %
                             learning::kFolds);
  }
  return {};
}

/// The same of an own recording, with what its boards measured, `weight` times.
Result<void> AddOwn(const OwnRecording& own, const reconstruction::Models& basis, int weight,
                    std::uint64_t seed, int piece, learning::PoseExamples& examples) {
  learning::OwnExampleSettings settings;
  settings.piece_s = kPosePieceS;
  settings.first_piece = piece;
  settings.settled_s = kSettledS;
  const auto image = learning::MirrorImage(own.take);
  if (!image) return image.error();
  for (int i = 0; i < weight; ++i) {
    for (const learning::OwnTake* take : {&own.take, &*image}) {
      settings.seed = seed++;
      const auto added = learning::AddOwnExamples(*take, basis, settings, examples);
      if (!added) return added;
    }
  }
  return {};
}

/// Of all clips and their mirror images; a clip and its image are in the same folds.
Result<learning::PoseExamples> Examples(const TrainingSet& set, const model::Model& basis,
                                        std::uint64_t seed) {
  const auto models = reconstruction::MakeModels({{"the new basis", basis}});
  if (!models) return models.error();
  learning::PoseExamples examples;
  int piece = 0;
  for (const Clip& clip : set.clips.train) {
    for (const bool mirrored : {false, true}) {
      const auto added = AddExamples(
          mirrored ? motion::Mirrored(clip.motion) : clip.motion, clip.name, *models,
          seed + 2 * static_cast<std::uint64_t>(piece) + (mirrored ? 1 : 0), piece, examples);
      if (!added) return added.error();
    }
    piece += 1 + static_cast<int>(clip.motion.duration_s() / kPosePieceS);
    log::Info("simulated " + clip.name);
  }
  for (const OwnRecording& own : set.own) {
    const auto added = AddOwn(own, *models, set.weight,
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
  const auto examples = Examples(*set, model, options.model.seed);
  if (!examples) return cli::Report(examples.error());
  learning::RandomWaves waves = learning::kPoseWaves;
  waves.seed = options.model.seed;
  const learning::FittedPoseRegression fitted =
      learning::FitPoseRegression(*examples, trained->basis.scale, waves);
  model.kind = "pose";
  learning::AppendTensors(fitted, model);
  nlohmann::ordered_json report = {{"dof", trained->basis.mean.size()},
                                   {"poses", trained->poses},
                                   {"examples", examples->poses.size()},
                                   {"subjects", set->clips.subjects},
                                   {"ridge", fitted.ridge},
                                   {"left_out_error", fitted.error},
                                   {"spread", fitted.spread}};
  AppendOwn(*set, report);
  return Deliver(model, options.model, report, shared);
}

}  // namespace

void AddPoseCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command = app.add_subcommand(
      "pose", "Pose model: the pose basis and a network from boards and hands to a pose");
  AddMotionOptions(*command, options->motions);
  AddOwnOptions(*command, options->own);
  AddModelOptions(*command, options->model);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
