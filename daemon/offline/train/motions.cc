#include "daemon/offline/train/motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/cli/cli.h"
#include "common/model/model.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/standard_layout.h"
#include "common/virtual/options/load.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/learning/time_alignment.h"
#include "daemon/offline/train/own_recordings.h"
#include "daemon/offline/train/people_score.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::train {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMotionBytes = 256u << 20;
constexpr Eigen::Index kFewestFrames = 30;
constexpr double kMostAwayM = 0.4, kLeastRootShare = 0.25;

std::string SubjectOf(const fs::path& path) { return model::SubjectOfFile(path.stem().string()); }

/// The files of one ending, by name.
Result<std::vector<fs::path>> FilesOf(const std::string& folder, const std::string& ending) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ending) files.push_back(it->path());
  }
  if (error) return Failure("cannot list " + folder + ": " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

/// SUBJECT.asf or SUBJECT_*.asf in the folder of an AMC file.
Result<std::string> SkeletonBeside(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const Result<std::vector<fs::path>> skeletons = FilesOf(folder.string(), ".asf");
  if (!skeletons) return skeletons.error();
  const auto found = std::find_if(skeletons->begin(), skeletons->end(), [&](const fs::path& asf) {
    return SubjectOf(asf) == SubjectOf(path);
  });
  if (found == skeletons->end()) {
    return InvalidData(path.string() + ": no skeleton " + SubjectOf(path) + ".asf beside it");
  }
  return found->string();
}

bool HasMarkers(const fs::path& path) {
  return path.extension() == ".trc" || path.extension() == ".c3d";
}

bool IsStill(const fs::path& path) {
  const std::string name = path.stem().string();
  return name.size() > 6 && name.ends_with("_still");
}

/// SUBJECT_still.trc or .c3d in the folder of a marker file; empty where there is none.
std::string StillBeside(const fs::path& path) {
  for (const char* ending : {".trc", ".c3d"}) {
    const fs::path still = path.parent_path() / (SubjectOf(path) + "_still" + ending);
    if (std::error_code error; fs::exists(still, error)) return still.string();
  }
  return "";
}

/// Clips of another layout than the standard are fitted to it when there are several layouts.
Result<void> UnifyLayouts(std::vector<Clip>& clips) {
  const auto of_first = [&clips](const Clip& clip) {
    return body::DofNames(clip.motion.skeleton) == body::DofNames(clips.front().motion.skeleton);
  };
  if (std::all_of(clips.begin(), clips.end(), of_first)) return {};
  for (Clip& clip : clips) {
    if (const auto fitted = FitToStandardLayout(clip); !fitted) return fitted.error();
  }
  return {};
}

}  // namespace

Result<Clip> ReadClip(const std::string& file, const std::string& skeleton) {
  const fs::path path(file);
  const Result<std::string> text = config::ReadTextFile(file, kMostMotionBytes);
  if (!text) return text.error();
  motion_files::LoadOptions load;
  load.skeleton = skeleton;
  if (load.skeleton.empty() && path.extension() == ".amc") {
    const Result<std::string> beside = SkeletonBeside(path);
    if (!beside) return beside.error();
    load.skeleton = *beside;
  }
  if (HasMarkers(path)) load.still = StillBeside(path);
  const Result<motion_files::LoadedMotion> read = motion_files::LoadMotion(file, load);
  if (!read) return read.error();
  if (!read->height_m && !read->note.empty()) log::Info(file + ": " + read->note);
  const Result<motion::Motion> motion = motion::WithLandmarksOnly(read->motion);
  if (!motion) return InvalidData(file + ": " + motion.error().message);
  if (motion->frames() < kFewestFrames) {
    return InvalidData(file + ": only " + std::to_string(motion->frames()) + " frames");
  }
  body::PersonParameters person;
  person.height_m = read->height_m;
  const Result<body::Body> body = body::MakeBody(motion->skeleton, person);
  if (!body) return InvalidData(file + ": " + body.error().message);
  const std::string name = path.filename().string();
  return Clip{.name = name,
              .subject = SubjectOf(path),
              .file = {.name = name, .sha256 = model::Sha256(*text)},
              .motion = learning::Aligned(*motion, body->landmarks),
              .body = *body};
}

Result<double> FitToStandardLayout(Clip& clip) {
  if (motion::HasStandardLayout(clip.motion)) return 0.0;
  auto standard = motion::ToStandardLayout(clip.motion);
  if (!standard) return InvalidData(clip.name + ": " + standard.error().message);
  body::PersonParameters person;
  person.height_m = standard->height_m;
  auto body = body::MakeBody(standard->motion.skeleton, person);
  if (!body) return InvalidData(clip.name + ": " + body.error().message);
  log::Info("fitted " + clip.name + " to the standard layout within " +
            text::Fixed(1e3 * standard->rms_m, 1) + " mm");
  clip.motion = learning::Aligned(standard->motion, body->landmarks);
  clip.body = *std::move(body);
  return standard->rms_m;
}

bool StaysInPlace(const Clip& clip) {
  const body::Skeleton& skeleton = clip.motion.skeleton;
  const double least_m = kLeastRootShare * body::TPose(skeleton, clip.body.landmarks)(2);
  body::Kinematics at(skeleton);
  Eigen::Matrix<double, 4, Eigen::Dynamic> feet_m(4, clip.motion.frames());
  for (Eigen::Index t = 0; t < clip.motion.frames(); ++t) {
    if (clip.motion.q(2, t) < least_m) return false;
    body::ComputeKinematics(skeleton, clip.motion.q.col(t), at);
    for (int side = 0; side < 2; ++side) {
      feet_m.block<2, 1>(2 * side, t) = body::Place(body::Ankle(clip.body, side), at).head<2>();
    }
  }
  for (int side = 0; side < 2; ++side) {
    const Eigen::Vector2d middle_m(learning::Quantile(feet_m.row(2 * side), 0.5),
                                   learning::Quantile(feet_m.row(2 * side + 1), 0.5));
    const auto off_m = feet_m.middleRows<2>(2 * side).colwise() - middle_m;
    if (off_m.colwise().norm().maxCoeff() > kMostAwayM) return false;
  }
  return true;
}

std::string Listed(const std::set<std::string>& subjects) {
  return subjects.empty() ? "none" : text::Joined(subjects);
}

void AddMotionOptions(CLI::App& command, MotionOptions& options) {
  command.add_option("--motions", options.folders,
                     "Folder of motion files: *.bvh, *.amc with their *.asf, *.trc or *.c3d with a "
                     "SUBJECT_still.trc or .c3d; may be repeated");
  command.add_option("--exclude", options.exclude,
                     "Subject to leave out of training, so that the model may be evaluated on it; "
                     "may be repeated");
}

Result<Clips> ReadClips(const MotionOptions& options) {
  std::set<std::string> exclude;
  for (const std::string& subject : options.exclude) exclude.insert(model::SubjectName(subject));
  Clips clips;
  std::set<std::string> subjects, left_out;
  for (const std::string& folder : options.folders) {
    for (const char* ending : {".amc", ".bvh", ".trc", ".c3d"}) {
      const Result<std::vector<fs::path>> files = FilesOf(folder, ending);
      if (!files) return files.error();
      for (const fs::path& path : *files) {
        if (IsStill(path)) continue;
        Result<Clip> clip = ReadClip(path.string());
        if (!clip) return clip.error();
        const bool out = exclude.count(clip->subject) != 0;
        (out ? left_out : subjects).insert(clip->subject);
        (out ? clips.excluded : clips.train).push_back(std::move(*clip));
      }
    }
  }
  for (const std::string& subject : exclude) {
    if (left_out.count(subject) == 0) {
      subjects.merge(left_out);
      return UsageError("--exclude " + subject + ": no file of that subject is there; there are " +
                        Listed(subjects));
    }
  }
  if (clips.train.empty() && !options.folders.empty()) {
    return InvalidData("no *.amc, *.bvh, *.trc or *.c3d to train on in the folders named");
  }
  clips.subjects = {subjects.begin(), subjects.end()};
  if (const auto unified = UnifyLayouts(clips.train); !unified) return unified.error();
  return clips;
}

std::vector<model::DataFile> DataFiles(const std::vector<Clip>& clips) {
  std::vector<model::DataFile> files;
  for (const Clip& clip : clips) files.push_back(clip.file);
  return files;
}

namespace {

using learning::LoadClip;

constexpr const char* kAxes[] = {"x", "y"};
constexpr double kValidationPart = 0.2;  // The end of every clip.
constexpr std::size_t kRoundsKept = 3;  // Newest rounds that are trained on, beside noisy examples.
constexpr double kEnoughComS = 180;     // Motion that the paper trains on, s (section 4.2).
constexpr double kRestartS = 10;        // Duration of a run on its own outputs in training.

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

/// Adds the recordings of the user's own boards, with their mirror images, `weight` times.
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

/// Training data of one axis.
struct Lesson {
  learning::Examples noisy, noisy_validation;
  std::vector<learning::Examples> rounds;  ///< Examples on own outputs, the latest last.
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

namespace {

using nlohmann::ordered_json;

struct PeopleOptions {
  MotionOptions motions;
  std::vector<std::string> only;
  int every = 1;
  MoreWays more;
  std::uint64_t seed = 1;
};

/// "squat1Reps" of HDM_bd_squat1Reps_001_120.amc; else the file's name without its ending.
std::string ActivityOf(const Clip& clip) {
  std::string name = clip.name.substr(0, clip.name.rfind('.'));
  if (name.rfind("HDM_", 0) != 0) return name;
  name = name.substr(clip.subject.size() + 1);
  return name.substr(0, name.find('_'));
}

/// Scores of one take; plain, since ranks share it.
struct ScoredTake {
  std::size_t take = 0;
  PoseTally tally;
};

class LeaveOneOut {
 public:
  LeaveOneOut(std::vector<Clip> clips, std::uint64_t seed)
      : clips_(std::move(clips)), seed_(seed) {}

  /// The features of hands and feet do not depend on who is left out.
  Result<void> Prepare() {
    for (const Clip& clip : clips_) all_.push_back(&clip);
    const auto basis = TrainBasis(clips_);
    if (!basis) return basis.error();
    model::Model model;
    model.kind = "basis";
    AppendBasis(basis->basis, model);
    const auto models = reconstruction::MakeModels({{"the basis", model}});
    if (!models) return models.error();
    int piece = 0;
    takes_ = TakesOf(all_, seed_, piece);
    for (const PoseTake& take : takes_) {
      postures_.emplace_back();
      const auto added = AddExamples(take, *models, learning::PoseCues::kPosture, postures_.back());
      if (!added) return added;
    }
    return {};
  }

  Result<reconstruction::Models> Train(const std::string& person) const {
    std::vector<Clip> others;
    for (const Clip& clip : clips_) {
      if (clip.subject != person) others.push_back(clip);
    }
    if (others.empty()) return UsageError("a single person: nobody to learn from");
    const auto basis = TrainBasis(others);
    if (!basis) return basis.error();
    model::Model model;
    model.kind = "basis";
    AppendBasis(basis->basis, model);
    learning::PoseExamples postures, examples;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      if (takes_[i].clip->subject == person) continue;
      postures.Append(postures_[i]);
    }
    AppendPoses(postures, learning::PoseCues::kPosture, basis->basis.scale, seed_, model);
    const auto first = reconstruction::MakeModels({{"the postures", model}});
    if (!first) return first.error();
    for (const PoseTake& take : takes_) {
      if (take.clip->subject == person) continue;
      const auto added = AddExamples(take, *first, learning::PoseCues::kMomentum, examples);
      if (!added) return added.error();
    }
    AppendPoses(examples, learning::PoseCues::kMomentum, basis->basis.scale, seed_, model);
    model.kind = "pose";
    return reconstruction::MakeModels({{"the model without " + person, model}});
  }

  /// Scores the person's clips in place, and appends each to `scored`.
  Result<PoseTally> ScorePerson(const std::string& person, const reconstruction::Models& models,
                                const MoreWays& more, std::vector<ScoredTake>& scored) const {
    PoseTally sum;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      const PoseTake& take = takes_[i];
      if (take.clip->subject != person || take.mirrored || !StaysInPlace(*take.clip)) continue;
      if (postures_[i].poses.empty()) continue;  // Its T-pose never stands still.
      const auto tally = ScoreTake(take, models, more);
      if (!tally) return tally.error();
      sum.Add(*tally);
      scored.push_back({i, *tally});
    }
    return sum;
  }

  const Clip& ClipOf(const ScoredTake& scored) const { return *takes_[scored.take].clip; }

 private:
  std::vector<Clip> clips_;
  std::uint64_t seed_;
  std::vector<const Clip*> all_;
  std::vector<PoseTake> takes_;
  std::vector<learning::PoseExamples> postures_;  ///< Examples of each take.
};

/// Keeps every `every`-th take of each activity of a person.
std::vector<Clip> Thinned(std::vector<Clip> clips, int every) {
  std::vector<Clip> kept;
  std::map<std::string, int> seen;
  for (Clip& clip : clips) {
    if (seen[clip.subject + ActivityOf(clip)]++ % every == 0) kept.push_back(std::move(clip));
  }
  return kept;
}

/// The people to leave out, one after the other.
Result<std::vector<std::string>> PeopleOf(const std::vector<Clip>& clips,
                                          const std::vector<std::string>& only) {
  std::set<std::string> people;
  for (const Clip& clip : clips) {
    if (StaysInPlace(clip)) people.insert(clip.subject);
  }
  if (people.empty()) return InvalidData("no motion in the folders stays in place");
  if (only.empty()) return std::vector(people.begin(), people.end());
  std::set<std::string> asked;
  for (const std::string& name : only) {
    asked.insert(model::SubjectName(name));
    if (people.count(model::SubjectName(name)) == 0) {
      return UsageError("--only " + name +
                        ": no motion of that subject that stays in place is there; there are " +
                        Listed(people));
    }
  }
  return std::vector(asked.begin(), asked.end());
}

/// This rank's share of the people, take by take.
Result<std::vector<ScoredTake>> ScoreOwn(const LeaveOneOut& study,
                                         const std::vector<std::string>& people,
                                         const MoreWays& more, const ranks::Ranks& ranks) {
  std::vector<ScoredTake> scored;
  for (std::size_t i = ranks.rank(); i < people.size(); i += ranks.count()) {
    const auto models = study.Train(people[i]);
    if (!models) return models.error();
    const auto tally = study.ScorePerson(people[i], *models, more, scored);
    if (!tally) return tally.error();
    log::Info("scored " + people[i] + ": " + tally->Json().dump());
  }
  return scored;
}

/// The sums, added up person after person and take after take, whoever scored them.
ordered_json ReportOf(const LeaveOneOut& study, const std::vector<std::string>& people,
                      const std::vector<std::vector<ScoredTake>>& by_rank) {
  ordered_json report;
  PoseTally sum;
  std::map<std::string, PoseTally> by_activity;
  for (std::size_t i = 0; i < people.size(); ++i) {
    PoseTally of_person;
    for (const ScoredTake& scored : by_rank[i % by_rank.size()]) {
      if (study.ClipOf(scored).subject != people[i]) continue;
      of_person.Add(scored.tally);
      by_activity[ActivityOf(study.ClipOf(scored))].Add(scored.tally);
    }
    of_person.AboutPerson();
    sum.Add(of_person);
    report["people"][people[i]] = of_person.Json();
  }
  for (const auto& [activity, tally] : by_activity) report["activities"][activity] = tally.Json();
  report["all"] = sum.Json();
  return report;
}

int Run(const PeopleOptions& options, const Shared& shared) {
  auto clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  std::vector<Clip> kept = Thinned(std::move(clips->train), options.every);
  const auto people = PeopleOf(kept, options.only);
  if (!people) return cli::Report(people.error());
  LeaveOneOut study(std::move(kept), options.seed);
  if (const auto prepared = study.Prepare(); !prepared) return cli::Report(prepared.error());
  const auto scored = ScoreOwn(study, *people, options.more, shared.ranks);
  if (!scored) return cli::Report(scored.error());
  const ordered_json report = ReportOf(study, *people, shared.ranks.Share(*scored));
  if (shared.ranks.first()) std::cout << text::ToText(report, shared.json ? -1 : 2) << "\n";
  return 0;
}

}  // namespace

void AddPeopleCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PeopleOptions>();
  CLI::App* command = app.add_subcommand(
      "people",
      "Train pose models that leave one person out each, and evaluate them on this person");
  AddMotionOptions(*command, options->motions);
  command->get_option("--motions")->required();
  command->add_option("--only", options->only,
                      "Person to leave out; may be repeated (default: all)");
  command
      ->add_option("--every", options->every, "Use every Nth of a person's takes of one activity")
      ->check(CLI::Range(1, 100));
  command->add_flag("--ablations", options->more.truth,
                    "Score with true COM, momentum, feet and all of them, too");
  command->add_flag("--sensors", options->more.sensors,
                    "Score with a tracker of the head, a belt and both, too");
  command->add_option("--seed", options->seed, "Seed of the simulated sensors and the model");
  command->footer(
      "Examples:\n"
      "  footing-train people --motions mocap/ --json\n"
      "  footing-train people --motions mocap/ --motions hdm05/ --only 14 --every 3\n"
      "  footing-train people --motions mocap/ --ablations\n"
      "  footing-train people --motions mocap/ --every 3 --sensors --json\n"
      "  mpirun -n 4 footing-train people --motions mocap/ --json");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

namespace {

constexpr double kRootHeightM = 1;

/// On the ground, and as large as a person whose root is 1 m high in the T-pose.
motion::Motion Standing(motion::Motion motion, const body::Landmarks& landmarks) {
  motion.q.row(2).array() -= motion::FloorHeight(motion, landmarks);
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
        Standing(learning::Aligned(motion::Mirrored(clip.motion), landmarks), landmarks));
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
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(clips.front().motion.skeleton.dof);
  for (const motion::Motion& motion : motions) {
    const double step = std::max(1.0, motion.rate_hz / kRateHz);
    for (double at = 0; at < static_cast<double>(motion.frames()); at += step) {
      columns.push_back(
          motion::NearestPose(motion.skeleton, motion.q.col(static_cast<Eigen::Index>(at)), zero));
    }
  }
  Eigen::MatrixXd poses(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    poses.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return poses;
}

}  // namespace

Result<TrainedBasis> TrainBasis(const std::vector<Clip>& clips) {
  const std::vector<motion::Motion> motions = WithMirrors(clips);
  const Result<Eigen::MatrixXd> poses = Poses(clips, motions);
  if (!poses) return poses.error();
  learning::PoseBasis basis = learning::MakeBasis(*poses, DofNames(clips.front().motion.skeleton));
  return TrainedBasis{std::move(basis), poses->cols()};
}

void AppendBasis(const learning::PoseBasis& basis, model::Model& model) {
  learning::AppendTensors(basis, model);
  model.tensors.push_back({.name = "root_height_m", .shape = {1}, .values = {kRootHeightM}});
}

}  // namespace footing::train
