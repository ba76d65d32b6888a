#include "daemon/offline/train/motions.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "common/body/kinematics.h"
#include "common/body/points.h"
#include "common/runtime/data_file.h"
#include "common/runtime/log.h"
#include "common/base/joined.h"
#include "common/base/number.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/standard_layout.h"
#include "common/virtual/options/load.h"
#include "daemon/offline/learning/alignment.h"

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

/// Of files of several layouts those of another one than the standard are fitted to it.
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
  const Result<motion_files::LoadedMotion> read = motion_files::LoadMotion(file, load);
  if (!read) return read.error();
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
                     "Folder of motion files, *.bvh, or *.amc with their *.asf; may be repeated");
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
    for (const char* ending : {".amc", ".bvh"}) {
      const Result<std::vector<fs::path>> files = FilesOf(folder, ending);
      if (!files) return files.error();
      for (const fs::path& path : *files) {
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
    return InvalidData("no *.amc or *.bvh to train on in the folders named");
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

}  // namespace footing::train
