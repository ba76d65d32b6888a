#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/units.h"
#include "daemon/offline/learning/board_loads.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/simulation/cascade/model.h"

namespace footing::train {
namespace {

using learning::LoadClip;

constexpr const char* kAxes[] = {"x", "y"};
constexpr double kValidationPart = 0.2;  // The end of every clip.
constexpr std::size_t kRoundsKept = 3;   // Whose examples are trained on, beside those with noise.
constexpr double kEnoughComS = 180;      // Of the paper's, section 4.2.
constexpr double kRestartS = 10;         // Duration of a run on its own outputs in training.

/// A hidden unit fits the people of the training: it makes the COM of a person left out worse
/// forward (docs/models.md).
constexpr int kHiddenMax = 0;

struct ComOptions {
  MotionOptions motions;
  OwnOptions own;
  ModelOptions model;
  learning::CascadeOptions cascade;
  std::vector<double> noises_m = {0.01, 0.02, 0.04};
  int copies = 1;
  int rounds = 6;
  bool mirror = true;
};

struct Recordings {
  std::vector<LoadClip> train, validation;
};

std::vector<LoadClip> Loads(const std::vector<Clip>& clips, bool mirrored, std::uint64_t seed) {
  std::vector<LoadClip> loads;
  for (const Clip& clip : clips) {
    learning::BoardLoadSettings settings;
    settings.mirrored = mirrored;
    const LoadClip all = learning::BoardLoads(clip.motion, clip.body, settings, seed++);
    for (LoadClip& part : learning::PartsInPlace(all)) loads.push_back(std::move(part));
  }
  return loads;
}

/// What the own boards measured, with its mirror image, `weight` times.
Result<void> AddOwn(const TrainingSet& set, bool mirror, std::vector<LoadClip>& loads) {
  for (const OwnRecording& own : set.own) {
    std::vector<learning::OwnTake> takes{own.take};
    if (mirror) {
      auto image = learning::MirrorImage(own.take);
      if (!image) return image.error();
      takes.push_back(*std::move(image));
    }
    for (const learning::OwnTake& take : takes) {
      for (const LoadClip& clip : learning::OwnLoads(take)) {
        for (const LoadClip& part : learning::PartsInPlace(clip)) {
          for (int i = 0; i < set.weight; ++i) loads.push_back(part);
        }
      }
    }
  }
  return {};
}

Recordings SplitClips(const std::vector<LoadClip>& clips) {
  Recordings recordings;
  for (const LoadClip& clip : clips) {
    const auto middle =
        clip.begin() +
        static_cast<std::ptrdiff_t>((1 - kValidationPart) * static_cast<double>(clip.size()));
    recordings.train.emplace_back(clip.begin(), middle);
    recordings.validation.emplace_back(middle, clip.end());
  }
  return recordings;
}

/// What one axis learns from.
struct Lesson {
  learning::Examples noisy, noisy_validation;
  std::vector<learning::Examples> rounds;  ///< Of own outputs, the latest last.
};

Lesson FirstLesson(const Recordings& recordings, int axis, double noise_m,
                   const ComOptions& options) {
  learning::FeedbackNoise noise{.groups = learning::FeedbackColumns(),
                                .common_sd = noise_m,
                                .own_sd = noise_m / 10,
                                .copies = options.copies};
  const std::uint64_t seed = options.model.seed;
  Lesson lesson;
  lesson.noisy =
      WithFeedbackNoise(learning::HorizontalExamples(recordings.train, axis), noise, seed);
  noise.copies = 1;
  lesson.noisy_validation =
      WithFeedbackNoise(learning::HorizontalExamples(recordings.validation, axis), noise, seed + 1);
  return lesson;
}

/// Mean square of the error in closed loop, both axes together.
double ClosedLoopMse(const learning::Networks& networks, const std::vector<LoadClip>& clips) {
  double sum = 0, frames = 0;
  for (const LoadClip& clip : clips) {
    const auto size = static_cast<double>(clip.size());
    frames += size;
    sum += size * ClosedLoopError(networks, clip).squaredNorm();
  }
  return sum / std::max(frames, 1.0);
}

struct Trained {
  std::vector<learning::CascadeResult> axes;
  double noise_m = 0;
  int round = 0;

  learning::Networks networks() const { return {axes[0].network, axes[1].network}; }
};

Trained TrainAxes(const std::array<Lesson, 2>& lessons, const ComOptions& options) {
  Trained trained;
  for (const Lesson& lesson : lessons) {
    std::vector<const learning::Examples*> parts{&lesson.noisy};
    for (const learning::Examples& round : lesson.rounds) parts.push_back(&round);
    trained.axes.push_back(learning::TrainCascade(learning::Joined(parts), lesson.noisy_validation,
                                                  options.cascade, options.model.seed));
  }
  return trained;
}

/// For each noise a pair of networks, and then, round by round, one that has also learned to go on
/// from the outputs of those before it: the errors it meets in use are not white noise. Of all, the
/// one that goes on best from its own outputs is kept. The error of one step says nothing of that.
Trained Train(const Recordings& recordings, const ComOptions& options) {
  Trained best;
  double best_mse = std::numeric_limits<double>::infinity();
  for (const double noise_m : options.noises_m) {
    std::array<Lesson, 2> lessons;
    for (int axis = 0; axis < 2; ++axis)
      lessons[static_cast<std::size_t>(axis)] = FirstLesson(recordings, axis, noise_m, options);
    for (int round = 0; round <= options.rounds; ++round) {
      Trained trained = TrainAxes(lessons, options);
      trained.noise_m = noise_m;
      trained.round = round;
      const learning::Networks networks = trained.networks();
      for (int axis = 0; axis < 2; ++axis) {
        auto& rounds = lessons[static_cast<std::size_t>(axis)].rounds;
        rounds.push_back(learning::RolledOutExamples(networks, recordings.train, axis, kRestartS));
        if (rounds.size() > kRoundsKept) rounds.erase(rounds.begin());
      }
      const double mse = ClosedLoopMse(networks, recordings.validation);
      if (mse < best_mse) {
        best_mse = mse;
        best = std::move(trained);
      }
    }
  }
  return best;
}

/// Root mean squares over whole clips: one step from the truth, the closed loop, and the COP.
nlohmann::ordered_json ScoreNetworks(const learning::Networks& networks,
                                     const std::vector<LoadClip>& clips) {
  Eigen::Vector2d one_step = Eigen::Vector2d::Zero(), loop = one_step, cop = one_step;
  double frames = 0;
  for (const LoadClip& clip : clips) {
    const auto size = static_cast<double>(clip.size());
    frames += size;
    loop += size * ClosedLoopError(networks, clip).cwiseAbs2();
    cop += size * CopError(clip).cwiseAbs2();
  }
  const auto rms = [&](const Eigen::Vector2d& sum) {
    const Eigen::Vector2d value = (sum / std::max(frames, 1.0)).cwiseSqrt();
    return nlohmann::ordered_json{value.x(), value.y()};
  };
  for (int axis = 0; axis < 2; ++axis) {
    one_step(axis) = frames * MeanSquaredError(networks[static_cast<std::size_t>(axis)],
                                               learning::HorizontalExamples(clips, axis));
  }
  return {
      {"one_step_rms_m", rms(one_step)}, {"closed_loop_rms_m", rms(loop)}, {"cop_rms_m", rms(cop)}};
}

Result<void> CheckHidden(const learning::CascadeOptions& options) {
  if (options.hidden_min <= options.hidden_max) return {};
  return UsageError("--hidden-min " + std::to_string(options.hidden_min) +
                    " is above --hidden-max " + std::to_string(options.hidden_max) +
                    "; give a --hidden-max of at least as many");
}

int Run(const ComOptions& options, const Shared& shared) {
  if (auto checked = CheckHidden(options.cascade); !checked) return cli::Report(checked.error());
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<TrainingSet> set =
      ReadTrainingSet(options.motions, options.own, kEnoughComS, "for the horizontal COM");
  if (!set) return cli::Report(set.error());
  const Clips* clips = &set->clips;
  std::vector<LoadClip> loads = Loads(clips->train, false, options.model.seed);
  if (options.mirror) {
    for (LoadClip& clip : Loads(clips->train, true, options.model.seed + 500))
      loads.push_back(std::move(clip));
  }
  if (auto added = AddOwn(*set, options.mirror, loads); !added) return cli::Report(added.error());
  if (loads.empty()) {
    return cli::Report(
        InvalidData("no motion stays in place for three seconds; nothing to train on"));
  }
  const Recordings recordings = SplitClips(loads);

  const std::int64_t start_ns = clock::MonotonicNs();
  const Trained trained = Train(recordings, options);
  const std::vector<learning::CascadeResult>& axes = trained.axes;
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model = NewModel("com", shared, options.model, set->DataFiles(), clips->subjects);
  nlohmann::ordered_json report = {{"subjects", clips->subjects},
                                   {"clips", clips->train.size()},
                                   {"noise_m", trained.noise_m},
                                   {"round", trained.round},
                                   {"networks", nlohmann::ordered_json::array()}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    cascade::AppendTensors(axes[axis].network, std::string(kAxes[axis]) + ".", model);
    report["networks"].push_back({{"axis", kAxes[axis]},
                                  {"hidden_units", axes[axis].hidden_units},
                                  {"epochs", axes[axis].epochs},
                                  {"train_mse", axes[axis].train_mse},
                                  {"validation_mse", axes[axis].validation_mse}});
  }
  report["seconds"] = seconds;
  report["validation"] = ScoreNetworks(trained.networks(), recordings.validation);
  if (!clips->excluded.empty()) {
    report["excluded"] =
        ScoreNetworks(trained.networks(), Loads(clips->excluded, false, options.model.seed + 1000));
  }
  AppendOwn(*set, report);
  if (auto written = WriteModel(model, options.model); !written) {
    return cli::Report(written.error());
  }
  if (shared.json) {
    std::cout << report.dump() << std::endl;
  } else {
    std::cout << options.model.out << ": " << report.dump(2) << std::endl;
  }
  return 0;
}

}  // namespace

void AddComCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ComOptions>();
  options->cascade.hidden_max = kHiddenMax;
  CLI::App* command = app.add_subcommand(
      "com", "COM model: networks for the horizontal COM, from motion files and simulated boards");
  AddMotionOptions(*command, options->motions);
  AddOwnOptions(*command, options->own);
  AddModelOptions(*command, options->model);
  command
      ->add_option("--noise", options->noises_m,
                   "Noise of the fed-back COM in training, m; may be repeated; the best in closed "
                   "loop is written")
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option("--copies", options->copies,
                   "Number of copies of each row, each with its own noise")
      ->check(CLI::Range(1, 100));
  command
      ->add_option("--rounds", options->rounds,
                   "Number of training rounds on the networks' own outputs")
      ->check(CLI::Range(0, 50));
  command->add_flag_callback(
      "--no-mirror", [options] { options->mirror = false; },
      "Leave out the mirror images of the clips");
  command->add_option("--hidden-max", options->cascade.hidden_max, "Maximum number of hidden units")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--hidden-min", options->cascade.hidden_min,
                   "Minimum number of hidden units, however the validation error grows")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--patience", options->cascade.patience,
                   "Number of hidden units without a lower validation error before training stops")
      ->check(CLI::Range(1, 256));
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
