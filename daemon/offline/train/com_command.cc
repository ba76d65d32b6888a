#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/cli/cli.h"
#include "common/clock/clock.h"
#include "common/units/units.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/training/board_loads.h"
#include "daemon/offline/training/cascade.h"
#include "daemon/simulation/cascade/model.h"

namespace footing::train {
namespace {

using training::LoadClip;

constexpr const char* kAxes[] = {"x", "y"};
constexpr double kValidationPart = 0.2;  // The end of every clip.

struct Options {
  MotionOptions motions;
  ModelOptions model;
  training::CascadeOptions cascade;
  std::vector<double> noises_m = {0.01, 0.02, 0.04, 0.08};
  int copies = 1;
};

struct Recordings {
  std::vector<LoadClip> train, validation;
};

std::vector<LoadClip> Loads(const std::vector<Clip>& clips, std::uint64_t seed) {
  std::vector<LoadClip> loads;
  for (const Clip& clip : clips) {
    loads.push_back(training::BoardLoads(clip.motion, clip.body, {}, seed + loads.size()));
  }
  return loads;
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

training::CascadeResult TrainAxis(const Recordings& recordings, int axis, double noise_m,
                                  const Options& options) {
  training::FeedbackNoise noise{.groups = training::FeedbackColumns(),
                                .common_sd = noise_m,
                                .own_sd = noise_m / 10,
                                .copies = options.copies};
  const std::uint64_t seed = options.model.seed;
  const auto train =
      WithFeedbackNoise(training::HorizontalExamples(recordings.train, axis), noise, seed);
  noise.copies = 1;
  const auto validation =
      WithFeedbackNoise(training::HorizontalExamples(recordings.validation, axis), noise, seed + 1);
  return training::TrainCascade(train, validation, options.cascade, seed);
}

/// Mean square of the error in closed loop, both axes together.
double ClosedLoopMse(const std::vector<training::CascadeResult>& axes,
                     const std::vector<LoadClip>& clips) {
  double sum = 0, frames = 0;
  for (const LoadClip& clip : clips) {
    const auto size = static_cast<double>(clip.size());
    frames += size;
    sum += size * ClosedLoopError(axes[0].network, axes[1].network, clip).squaredNorm();
  }
  return sum / std::max(frames, 1.0);
}

struct Trained {
  std::vector<training::CascadeResult> axes;
  double noise_m = 0;
};

/// One pair of networks for each noise; the one that goes on best from its own outputs is kept. The
/// error of one step says nothing of that.
Trained Train(const Recordings& recordings, const Options& options) {
  Trained best;
  double best_mse = std::numeric_limits<double>::infinity();
  for (const double noise_m : options.noises_m) {
    Trained trained{.axes = {}, .noise_m = noise_m};
    for (int axis = 0; axis < 2; ++axis) {
      trained.axes.push_back(TrainAxis(recordings, axis, noise_m, options));
    }
    const double mse = ClosedLoopMse(trained.axes, recordings.validation);
    if (mse < best_mse) {
      best_mse = mse;
      best = std::move(trained);
    }
  }
  return best;
}

/// Root mean squares over whole clips: one step from the truth, the closed loop, and the COP.
nlohmann::ordered_json Judge(const std::vector<training::CascadeResult>& axes,
                             const std::vector<LoadClip>& clips) {
  Eigen::Vector2d one_step = Eigen::Vector2d::Zero(), loop = one_step, cop = one_step;
  double frames = 0;
  for (const LoadClip& clip : clips) {
    const auto size = static_cast<double>(clip.size());
    frames += size;
    loop += size * ClosedLoopError(axes[0].network, axes[1].network, clip).cwiseAbs2();
    cop += size * CopError(clip).cwiseAbs2();
  }
  const auto rms = [&](const Eigen::Vector2d& sum) {
    const Eigen::Vector2d value = (sum / std::max(frames, 1.0)).cwiseSqrt();
    return nlohmann::ordered_json{value.x(), value.y()};
  };
  for (int axis = 0; axis < 2; ++axis) {
    one_step(axis) = frames * MeanSquaredError(axes[static_cast<std::size_t>(axis)].network,
                                               training::HorizontalExamples(clips, axis));
  }
  return {
      {"one_step_rms_m", rms(one_step)}, {"closed_loop_rms_m", rms(loop)}, {"cop_rms_m", rms(cop)}};
}

int Run(const Options& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const Result<Clips> clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  const Recordings recordings = SplitClips(Loads(clips->train, options.model.seed));

  const std::int64_t start_ns = clock::MonotonicNs();
  const Trained trained = Train(recordings, options);
  const std::vector<training::CascadeResult>& axes = trained.axes;
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model{.kind = "com",
                     .provenance = {.program_version = cli::Version(),
                                    .command = shared.command_line,
                                    .seed = options.model.seed,
                                    .data = DataFiles(clips->train),
                                    .subjects = clips->subjects},
                     .tensors = {}};
  nlohmann::ordered_json report = {{"subjects", clips->subjects},
                                   {"clips", clips->train.size()},
                                   {"noise_m", trained.noise_m},
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
  report["validation"] = Judge(axes, recordings.validation);
  if (!clips->excluded.empty()) {
    report["excluded"] = Judge(axes, Loads(clips->excluded, options.model.seed + 1000));
  }
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
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "com", "The horizontal COM's networks from motion files, by what two boards would measure");
  AddMotionOptions(*command, options->motions);
  AddModelOptions(*command, options->model);
  command
      ->add_option("--noise", options->noises_m,
                   "Errors of the fed-back COM in training, m; the best in closed loop is kept")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--copies", options->copies, "Of each row, with other noise")
      ->check(CLI::Range(1, 100));
  command->add_option("--hidden-max", options->cascade.hidden_max, "Hidden units at most")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--patience", options->cascade.patience,
                   "Hidden units without a better validation")
      ->check(CLI::Range(1, 256));
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
