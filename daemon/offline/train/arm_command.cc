#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/body/kinematics.h"
#include "common/cli/cli.h"
#include "daemon/offline/learning/training.h"
#include "daemon/offline/learning/arm_regression.h"
#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/simulation/pose/arm_geometry.h"

namespace footing::train {
namespace {

constexpr double kPieceS = 10;  // Of one person's clips: a fold where there is nobody else.
constexpr int kPieceFolds = 5;
constexpr int kDevices = 2;  // Sets of devices that each clip is felt with.

struct ArmOptions {
  MotionOptions motions;
  ModelOptions model;
  std::string kind = "linear";
};

/// What devices in the hands would have measured in one motion, and how the arms were: `add(arm,
/// since_s, input, truth)` for every frame and arm, as of a left one.
template <typename Add>
Result<void> ForEachFrame(const Clip& clip, std::uint64_t seed, const Add& add) {
  pose_run::Settings settings;
  settings.seed = seed;
  const auto run = pose_run::RunArms(clip.motion, settings, clip.name);
  if (!run) return run.error();
  const std::array geometry{arms::ArmGeometry(run->body, 0), arms::ArmGeometry(run->body, 1)};
  std::array<arms::HandAttitude, arms::kArms> hands;
  std::array<arms::HandReading, arms::kArms> newest;
  arms::ArmFeatures features;
  body::Kinematics at(run->body.skeleton);
  const double step_s = 1 / run->rate_hz;
  for (std::size_t i = 0; i < run->frames.size(); ++i) {
    const pose_run::ArmFrame& frame = run->frames[i];
    for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
      for (const arms::HandReading& reading : frame.readings[arm][0]) {
        hands[arm].Advance(reading, run->reading_s);
        newest[arm] = reading;
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
      add(arm, since_s, step_s,
          arm_network::MakeInput(arm, newest[arm], hands[arm].state(), features), truth);
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

int RunNetwork(const ArmOptions& options, const Clips& clips, const Shared& shared) {
  const auto kind =
      options.kind == "paper" ? arm_network::Kind::kPaper : arm_network::Kind::kResidual;
  const auto sequences = Sequences(clips, options.model.seed);
  if (!sequences) return cli::Report(sequences.error());
  const auto trained =
      arm_network::Train(kind, *sequences,
                         kind == arm_network::Kind::kPaper ? arm_network::PaperOptions()
                                                           : arm_network::TrainingOptions{},
                         options.model.seed);
  model::Model model = NewModel(arm_network::KindName(kind), shared, options.model,
                                DataFiles(clips.train), clips.subjects);
  arm_network::AppendTensors(trained.network, model);
  const nlohmann::ordered_json report = {{"rows", trained.rows},
                                         {"subjects", clips.subjects},
                                         {"hidden_units", trained.hidden_units},
                                         {"round", trained.round},
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
      ->add_option("--kind", options->kind,
                   "linear: what the product uses; paper, residual: networks that receive their "
                   "own last estimate, for footing-eval arm --network (default linear)")
      ->check(CLI::IsMember({"linear", "paper", "residual"}));
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
