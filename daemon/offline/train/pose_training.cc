#include "daemon/offline/train/pose_training.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/cli/cli.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/virtual/motion/edit.h"
#include "common/wire/model_file.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/network.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::train {
namespace {

constexpr double kPieceS = 10;  // A piece of one person's clips: a fold where there is nobody else.
constexpr int kPieceFolds = 5;
constexpr int kDevices = 2;  // Sets of devices that each clip is felt with.

struct ArmOptions {
  MotionOptions motions;
  ModelOptions model;
  std::string kind = "linear";
  std::optional<int> rounds, every, hidden_max;
  std::vector<double> noises_rad;
  std::vector<int> hidden_min;
};

/// Measurements of simulated devices in the hands during one motion, and how the arms were:
/// `add(arm, since_s, input, truth)` for every frame and arm, as of a left one.
template <typename Add>
Result<void> ForEachFrame(const Clip& clip, std::uint64_t seed, const Add& add) {
  pose_run::Settings settings;
  settings.seed = seed;
  const auto run = pose_run::RunArms(clip.motion, settings, clip.name);
  if (!run) return run.error();
  const std::array geometry{arms::ArmGeometry(run->body, 0), arms::ArmGeometry(run->body, 1)};
  std::array<arms::HandAttitude, arms::kArms> hands;
  arms::ArmFeatures features;
  body::Kinematics at(run->body.skeleton);
  const double step_s = 1 / run->rate_hz;
  for (std::size_t i = 0; i < run->frames.size(); ++i) {
    const pose_run::ArmFrame& frame = run->frames[i];
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const arms::HandReading& reading : frame.readings[arm][0]) {
        hands[arm].Advance(reading, run->reading_s);
      }
      if (i == run->aligned) hands[arm].Align();
    }
    if (i < run->aligned) continue;
    features.Advance({hands[0].state(), hands[1].state()}, step_s);
    const double since_s = static_cast<double>(i) * step_s - pose_run::kStandS;
    if (since_s < 0) continue;
    body::ComputeKinematics(run->body.skeleton, frame.q, at);
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      arms::ArmDirections truth = geometry[arm].Directions(at);
      if (arm == 1) truth = arms::Mirrored(truth);
      add(arm, since_s, step_s, arm_network::MakeInput(arm, hands[arm].state(), features), truth);
    }
  }
  return {};
}

Result<void> AddExamples(const Clip& clip, std::uint64_t seed, const std::vector<int>& folds,
                         learning::ArmExamples& examples) {
  return ForEachFrame(
      clip, seed,
      [&](std::size_t, double since_s, double, const arm_network::FrameInput& input,
          const arms::ArmDirections& truth) {
        examples.features.push_back(input.features);
        examples.directions.push_back(arms::Stacked(truth));
        examples.folds.push_back(folds[static_cast<std::size_t>(since_s / kPieceS) % folds.size()]);
      });
}

/// A fold a person; of one person alone, pieces of ten seconds.
Result<learning::ArmExamples> Examples(const Clips& clips, std::uint64_t seed) {
  learning::ArmExamples examples;
  const bool people = clips.subjects.size() >= 2;
  examples.fold_count = people ? static_cast<int>(clips.subjects.size()) : kPieceFolds;
  int piece = 0;
  for (const Clip& clip : clips.train) {
    std::vector<int> folds;
    if (people) {
      const auto place = std::find(clips.subjects.begin(), clips.subjects.end(), clip.subject);
      folds.push_back(static_cast<int>(place - clips.subjects.begin()));
    } else {
      for (int k = 0; k < kPieceFolds; ++k) folds.push_back((piece + k) % kPieceFolds);
      piece += 1 + static_cast<int>(clip.motion.duration_s() / kPieceS);
    }
    for (int device = 0; device < kDevices; ++device) {
      if (auto added = AddExamples(clip, ++seed, folds, examples); !added) return added.error();
    }
  }
  return examples;
}

Result<std::vector<arm_network::Sequence>> Sequences(const Clips& clips, std::uint64_t seed) {
  std::vector<arm_network::Sequence> sequences;
  for (const Clip& clip : clips.train) {
    std::array<arm_network::Sequence, arms::kArms> both;
    const auto added = ForEachFrame(
        clip, ++seed,
        [&both](std::size_t arm, double, double step_s, const arm_network::FrameInput& input,
                const arms::ArmDirections& truth) {
          both[arm].step_s = step_s;
          both[arm].inputs.push_back(input);
          both[arm].truth.push_back(arm_network::ToPose(truth));
          both[arm].forearm.push_back(truth.forearm);
        });
    if (!added) return added.error();
    for (arm_network::Sequence& one : both) {
      if (one.truth.size() > 1) sequences.push_back(std::move(one));
    }
  }
  return sequences;
}

/// Those of the kind, with the flags that are given.
arm_network::TrainingOptions NetworkOptions(arm_network::Kind kind, const ArmOptions& flags) {
  arm_network::TrainingOptions options = kind == arm_network::Kind::kPaper
                                             ? arm_network::PaperOptions()
                                             : arm_network::TrainingOptions{};
  options.rounds = flags.rounds.value_or(options.rounds);
  options.every = flags.every.value_or(options.every);
  options.hidden_max = flags.hidden_max.value_or(options.hidden_max);
  if (!flags.noises_rad.empty()) options.noises_rad = flags.noises_rad;
  if (!flags.hidden_min.empty()) options.hidden_min = flags.hidden_min;
  for (int& least : options.hidden_min) least = std::min(least, options.hidden_max);
  return options;
}

int RunNetwork(const ArmOptions& options, const Clips& clips, const Shared& shared) {
  const auto kind =
      options.kind == "paper" ? arm_network::Kind::kPaper : arm_network::Kind::kResidual;
  const auto sequences = Sequences(clips, options.model.seed);
  if (!sequences) return cli::Report(sequences.error());
  const auto trained =
      arm_network::Train(kind, *sequences, NetworkOptions(kind, options), options.model.seed);
  model::Model model = NewModel(arm_network::KindName(kind), shared, options.model,
                                DataFiles(clips.train), clips.subjects);
  arm_network::AppendTensors(trained.network, model);
  const nlohmann::ordered_json report = {{"rows", trained.rows},
                                         {"subjects", clips.subjects},
                                         {"hidden_units", trained.hidden_units},
                                         {"round", trained.round},
                                         {"noise_rad", trained.noise_rad},
                                         {"closed_loop_error", trained.closed_loop}};
  return Deliver(model, options.model, report, shared);
}

int Run(const ArmOptions& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<Clips> clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  if (options.kind != "linear") return RunNetwork(options, *clips, shared);
  const auto examples = Examples(*clips, options.model.seed);
  if (!examples) return cli::Report(examples.error());
  const learning::FittedArm fitted = learning::FitArm(*examples);
  model::Model model =
      NewModel("arm", shared, options.model, DataFiles(clips->train), clips->subjects);
  learning::AppendTensors(fitted.model, model);
  const nlohmann::ordered_json report = {
      {"examples", examples->features.size()}, {"subjects", clips->subjects},
      {"folds", examples->fold_count},         {"ridge", fitted.ridge},
      {"left_out_error", fitted.error},        {"spread", fitted.spread}};
  return Deliver(model, options.model, report, shared);
}

}  // namespace

void AddArmCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ArmOptions>();
  CLI::App* command =
      app.add_subcommand("arm", "Arm model: arm poses from a Wiimote with MotionPlus in each hand");
  AddMotionOptions(*command, options->motions);
  AddModelOptions(*command, options->model);
  command
      ->add_option(
          "--kind", options->kind,
          "linear: for best mode; paper: the network of paper mode; residual: another that "
          "receives its own last estimate, for footing-eval arm --network (default linear)")
      ->check(CLI::IsMember({"linear", "paper", "residual"}));
  command
      ->add_option("--rounds", options->rounds,
                   "Rounds of training of a network, the last ones on its own estimates")
      ->check(CLI::Range(1, 50));
  command
      ->add_option("--noise", options->noises_rad,
                   "Noise of the fed-back angles in the training of a network, rad; may be "
                   "repeated; the best "
                   "in closed loop is written")
      ->check(CLI::Range(0.0, 2.0));
  command
      ->add_option("--every", options->every,
                   "Frames from one row of a network's training to the next")
      ->check(CLI::Range(1, 120));
  command
      ->add_option("--hidden-min", options->hidden_min,
                   "Minimum number of hidden units of a network; may be repeated likewise")
      ->check(CLI::Range(0, 64));
  command
      ->add_option("--hidden-max", options->hidden_max,
                   "Maximum number of hidden units of a network")
      ->check(CLI::Range(0, 64));
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

namespace {

struct BasisOptions {
  MotionOptions motions;
  OwnOptions own;
  ModelOptions model;
};

constexpr double kEnoughS = 90;  // Range of motion, s: section 6.

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

namespace {

struct CascadeOptions {
  DataOptions data;
  learning::CascadeOptions cascade;
  bool sigmoid = false;
  bool covariance = false;
};

int Run(const CascadeOptions& options, const Shared& shared) {
  const Result<TrainingData> data = Load(options.data);
  if (!data) return cli::Report(data.error());
  learning::CascadeOptions cascade = options.cascade;
  if (options.sigmoid) cascade.outputs = learning::Outputs::kSigmoid;
  if (options.covariance) cascade.objective = learning::Objective::kCovariance;

  const learning::Split& split = data->split;
  if (options.sigmoid && split.train.targets.cwiseAbs().maxCoeff() > 0.5) {
    return cli::Report(InvalidData(options.data.data + ": --sigmoid outputs lie within +-0.5"));
  }
  const std::int64_t start_ns = clock::MonotonicNs();
  const learning::CascadeResult result =
      learning::TrainCascade(split.train, split.validation, cascade, options.data.model.seed);
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model =
      NewModel("cascade", shared, options.data.model, {data->file}, options.data.subjects);
  cascade::AppendTensors(result.network, "", model);
  if (auto written = WriteModel(model, options.data.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"hidden_units", result.hidden_units},
                                         {"epochs", result.epochs},
                                         {"train_mse", result.train_mse},
                                         {"validation_mse", result.validation_mse},
                                         {"seconds", seconds}};
  if (shared.json) {
    std::cout << text::ToText(report) << std::endl;
  } else {
    std::cout << options.data.model.out << ": " << result.hidden_units << " hidden units after "
              << result.epochs << " epochs, mean squared error " << result.train_mse
              << " in training, " << result.validation_mse << " in validation, " << seconds << " s"
              << std::endl;
  }
  return 0;
}

}  // namespace

void AddCascadeCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<CascadeOptions>();
  learning::CascadeOptions& cascade = options->cascade;
  CLI::App* command =
      app.add_subcommand("cascade", "Cascade-correlation network for any table of numbers");
  AddDataOptions(*command, options->data);
  command->add_option("--hidden-max", cascade.hidden_max, "Maximum number of hidden units")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--patience", cascade.patience,
                   "Number of hidden units without a lower validation error before training stops")
      ->check(CLI::Range(1, 256));
  command
      ->add_option("--mse-goal", cascade.mse_goal,
                   "Training error at which training stops, mean square")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--pool", cascade.candidates.pool, "Number of candidates for each hidden unit")
      ->check(CLI::Range(1, 256));
  command
      ->add_option("--epochs-max", cascade.candidates.epochs_max,
                   "Maximum number of epochs for a pool of candidates")
      ->check(CLI::Range(1, 100000));
  command->add_flag("--sigmoid", options->sigmoid,
                    "Use sigmoid outputs of +-0.5, trained by Quickprop");
  command->add_flag("--covariance", options->covariance,
                    "Train candidates by covariance (1990) in place of error reduction");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

namespace {

struct MlpOptions {
  DataOptions data;
  learning::MlpOptions mlp;
};

int Run(const MlpOptions& options, const Shared& shared) {
  const Result<TrainingData> data = Load(options.data);
  if (!data) return cli::Report(data.error());
  const std::int64_t start_ns = clock::MonotonicNs();
  const learning::MlpResult result = learning::TrainMlp(data->split.train, data->split.validation,
                                                        options.mlp, options.data.model.seed);
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model =
      NewModel("mlp", shared, options.data.model, {data->file}, options.data.subjects);
  learning::AppendTensors(result.network, model);
  if (auto written = WriteModel(model, options.data.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"hidden_units", options.mlp.hidden},
                                         {"epochs", result.epochs},
                                         {"train_mse", result.train_mse},
                                         {"validation_mse", result.validation_mse},
                                         {"seconds", seconds},
                                         {"goal_reached", result.goal_reached}};
  if (shared.json) {
    std::cout << text::ToText(report) << std::endl;
  } else {
    std::cout << options.data.model.out << ": " << options.mlp.hidden << " hidden units after "
              << result.epochs << " epochs, mean squared error " << result.train_mse
              << " in training, " << result.validation_mse << " in validation, " << seconds << " s"
              << (result.goal_reached ? ", goal reached" : "") << std::endl;
  }
  return 0;
}

}  // namespace

void AddMlpCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<MlpOptions>();
  learning::MlpOptions& mlp = options->mlp;
  CLI::App* command = app.add_subcommand(
      "mlp", "Multilayer perceptron trained by back-propagation on the same table, for comparison");
  AddDataOptions(*command, options->data);
  command->add_option("--hidden", mlp.hidden, "Number of hidden units")->check(CLI::Range(1, 256));
  command->add_option("--rate", mlp.rate, "Learning rate")->check(CLI::Range(1e-6, 10.0));
  command
      ->add_option("--momentum", mlp.momentum, "Momentum: share of the previous step, 0 to 0.999")
      ->check(CLI::Range(0.0, 0.999));
  command->add_option("--batch", mlp.batch, "Number of rows in a batch")
      ->check(CLI::Range(1, 100000));
  command->add_option("--epochs-max", mlp.epochs_max, "Maximum number of passes over the data")
      ->check(CLI::Range(1, 1000000));
  command
      ->add_option("--patience", mlp.patience,
                   "Number of epochs without a lower error before training stops")
      ->check(CLI::Range(1, 1000000));
  command
      ->add_option("--mse-goal", mlp.mse_goal,
                   "Validation error at which training stops, mean square")
      ->check(CLI::NonNegativeNumber);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

namespace {

constexpr double kEnoughPoseS = 90;  // Range of motion, s: section 6.

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

/// Examples of all clips and their mirror images, and of the own recordings.
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
  if (examples.poses.empty() && set.own.empty()) {
    return InvalidData("no clip whose T-pose stands still on the boards: nothing to train on");
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

void AddModelOptions(CLI::App& command, ModelOptions& options) {
  command.add_option("--out", options.out, "Output model, NAME.fmodel")->required();
  command.add_option("--seed", options.seed,
                     "Seed of initial weights and noise; equal seeds give equal models");
  command.add_flag("--force", options.force, "Overwrite an existing model");
  command.add_option("--licence", options.licences,
                     "Owner and terms of the motion data, stored in the model; may be repeated");
}

Result<void> CheckFree(const ModelOptions& options) {
  return recording::CheckCreatable(options.out, options.force);
}

model::Model NewModel(const std::string& kind, const Shared& shared, const ModelOptions& options,
                      std::vector<model::DataFile> data, std::vector<std::string> subjects) {
  return {.kind = kind,
          .provenance = {.program_version = cli::Version(),
                         .command = shared.command_line,
                         .seed = options.seed,
                         .data = std::move(data),
                         .subjects = std::move(subjects)},
          .tensors = {}};
}

Result<void> WriteModel(const model::Model& model, const ModelOptions& options) {
  const Result<std::string> bytes = wire::ToModelFile(model);
  if (!bytes) return bytes.error();
  Result<recording::OutputFile> file = recording::OutputFile::Create(options.out, options.force);
  if (!file) return file.error();
  if (auto written = file->Write(*bytes); !written) return written;
  return file->Sync();
}

int Deliver(const model::Model& model, const ModelOptions& options,
            const nlohmann::ordered_json& report, const Shared& shared) {
  if (auto written = WriteModel(model, options); !written) return cli::Report(written.error());
  if (!shared.json) std::cout << options.out << ": ";
  std::cout << text::ToText(report) << std::endl;
  return 0;
}

namespace {

constexpr double kCellNoiseKg = 0.05;

}  // namespace

std::vector<PoseTake> TakesOf(const std::vector<const Clip*>& clips, std::uint64_t seed,
                              int& piece) {
  std::vector<PoseTake> takes;
  std::map<std::string, int> people;
  for (const Clip* clip : clips) {
    const int person = people.emplace(clip->subject, static_cast<int>(people.size())).first->second;
    for (const bool mirrored : {false, true}) {
      takes.push_back({clip, mirrored, piece, person, false,
                       seed + 2 * static_cast<std::uint64_t>(piece) + (mirrored ? 1 : 0)});
    }
    piece += 1 + static_cast<int>(clip->motion.duration_s() / kPosePieceS);
  }
  for (PoseTake& take : takes) take.by_person = people.size() >= kFewestPeople;
  return takes;
}

Result<pose_run::PoseRun> SimulateTake(const PoseTake& take, pose_run::HeadDevice head, bool belt) {
  pose_run::Settings settings;
  settings.head = head;
  if (belt) settings.segments = {reconstruction::BodySite::kPelvis};
  settings.errors.noise_kg = kCellNoiseKg;
  settings.errors.seed = settings.seed = take.seed;
  const motion::Motion& motion = take.clip->motion;
  return pose_run::RunPose(take.mirrored ? motion::Mirrored(motion) : motion, settings,
                           take.clip->name);
}

Result<void> AddExamples(const PoseTake& take, const reconstruction::Models& models,
                         learning::PoseCues cues, learning::PoseExamples& examples) {
  const auto run = SimulateTake(take);
  if (!run) return run.error();
  reconstruction::Options options;
  options.rate_hz = run->rate_hz;
  auto made = reconstruction::Reconstruction::Create(run->body, models, options);
  if (!made) return made.error();
  const auto first = static_cast<std::size_t>((pose_run::kStandS + kSettledS) * run->rate_hz);
  const auto piece_frames = static_cast<std::size_t>(kPosePieceS * run->rate_hz);
  for (std::size_t i = 0; i < run->frames.size(); ++i) {
    const auto& output = made->Advance(run->frames[i].inputs);
    if (i < first) continue;
    if (!output.calibrated) {
      if (cues == learning::PoseCues::kPosture) {
        log::Warning(take.clip->name + (take.mirrored ? ", mirrored" : "") +
                     ": its T-pose never stands still on the boards: not trained on");
      }
      return {};
    }
    const int piece = take.piece + static_cast<int>((i - first) / piece_frames);
    const int fold = take.by_person ? take.person : piece % learning::kFolds;
    examples.Add(*made, cues, run->frames[i].q, fold, take.person);
  }
  return {};
}

learning::FittedPoseRegression AppendPoses(const learning::PoseExamples& examples,
                                           learning::PoseCues cues, const Eigen::VectorXd& scale,
                                           std::uint64_t seed, model::Model& model) {
  learning::RandomWaves waves = learning::kPoseWaves;
  waves.seed = seed;
  auto fitted = learning::FitPoseRegression(examples, scale, waves);
  learning::AppendTensors(
      fitted, model, cues == learning::PoseCues::kPosture ? reconstruction::kPosturePrefix : "");
  return fitted;
}

namespace {

constexpr std::size_t kMostBytes = 256u << 20;
constexpr Eigen::Index kFewestRows = 10;

Result<std::vector<std::vector<Eigen::Index>>> FeedbackColumns(const DataOptions& options,
                                                               const Table& table) {
  std::vector<std::vector<Eigen::Index>> groups;
  for (const std::string& group : options.feedback) {
    std::vector<Eigen::Index>& columns = groups.emplace_back();
    std::istringstream names(group);
    for (std::string name; std::getline(names, name, ',');) {
      const auto end = table.columns.begin() + options.inputs;
      const auto found = std::find(table.columns.begin(), end, name);
      if (found == end) {
        return UsageError("--feedback " + group + ": " + name + " is none of the first " +
                          std::to_string(options.inputs) + " columns of " + options.data);
      }
      columns.push_back(found - table.columns.begin());
    }
  }
  return groups;
}

}  // namespace

void AddDataOptions(CLI::App& command, DataOptions& options) {
  command
      .add_option("--data", options.data,
                  "Training data, CSV: a row of column names, then one row per example")
      ->required();
  command
      .add_option("--inputs", options.inputs,
                  "Number of input columns, counted from the left; the other columns are outputs")
      ->required()
      ->check(CLI::Range(1, 256));
  command
      .add_option("--validation", options.validation,
                  "Share of the rows used for validation, taken from the end")
      ->check(CLI::Range(0.0, 0.9));
  command.add_option(
      "--feedback", options.feedback,
      "Input columns A,B,... that are earlier outputs of one signal; may be repeated");
  command
      .add_option("--noise", options.noise_sd,
                  "Noise of the feedback columns, in their unit: shared by a group, plus a tenth "
                  "of it per column")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--copies", options.copies,
                  "Number of copies of each row, each with its own noise")
      ->check(CLI::Range(1, 100));
  command.add_option("--subject", options.subjects,
                     "Subject of the data; the model is never evaluated on it; may be repeated");
  AddModelOptions(command, options.model);
}

Result<TrainingData> Load(const DataOptions& options) {
  if (auto free = CheckFree(options.model); !free) return free.error();
  const Result<std::string> text = config::ReadTextFile(options.data, kMostBytes);
  if (!text) return text.error();
  const Result<Table> table = ParseTable(*text, options.data);
  if (!table) return table.error();
  const Eigen::Index outputs = table->values.cols() - options.inputs;
  if (outputs < 1 || outputs > 64) {
    return UsageError("--inputs " + std::to_string(options.inputs) + " leaves " +
                      std::to_string(outputs) + " of the " + std::to_string(table->values.cols()) +
                      " columns of " + options.data + " as outputs; 1 to 64 are possible");
  }
  const Result<std::vector<std::vector<Eigen::Index>>> groups = FeedbackColumns(options, *table);
  if (!groups) return groups.error();

  TrainingData data;
  data.file = {.name = std::filesystem::path(options.data).filename().string(),
               .sha256 = model::Sha256(*text)};
  data.split = learning::SplitInTime({.inputs = table->values.leftCols(options.inputs),
                                      .targets = table->values.rightCols(outputs)},
                                     options.validation);
  if (data.split.train.rows() < kFewestRows) {
    return InvalidData(options.data + ": " + std::to_string(data.split.train.rows()) +
                       " rows are left for training, at least " + std::to_string(kFewestRows) +
                       " are needed");
  }
  learning::FeedbackNoise noise{.groups = *groups,
                                .common_sd = options.noise_sd,
                                .own_sd = options.noise_sd / 10,
                                .copies = options.copies};
  if (options.noise_sd > 0) {
    data.split.train = learning::WithFeedbackNoise(data.split.train, noise, options.model.seed);
    noise.copies = 1;
    data.split.validation =
        learning::WithFeedbackNoise(data.split.validation, noise, options.model.seed + 1);
  }
  return data;
}

Result<Table> ParseTable(std::string_view text, const std::string& origin) {
  Table table;
  std::vector<double> numbers;
  text::Lines lines(text, origin);
  while (const auto line = lines.NextRow()) {
    if (table.columns.empty()) {
      for (const std::string_view name : text::Cells(*line)) table.columns.emplace_back(name);
      const std::set<std::string> names(table.columns.begin(), table.columns.end());
      if (names.count("") != 0 || names.size() != table.columns.size()) {
        return lines.Fault("the first line must name every column, each differently");
      }
      continue;
    }
    const auto row = text::NumberRow(*line, table.columns.size());
    if (!row) return lines.Fault(row.error().message);
    numbers.insert(numbers.end(), row->begin(), row->end());
  }
  if (numbers.empty()) {
    return InvalidData(origin + ": no rows; a line of column names comes first, then numbers");
  }
  const auto columns = static_cast<Eigen::Index>(table.columns.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.values =
      RowMajor::Map(numbers.data(), static_cast<Eigen::Index>(numbers.size()) / columns, columns);
  return table;
}

}  // namespace footing::train
