#include "daemon/offline/eval/pose_scene.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "common/model/model.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/standard_layout.h"
#include "common/virtual/options/sensor_options.h"
#include "common/virtual/people/perform.h"
#include "common/virtual/people/script.h"
#include "common/wire/model_file.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::eval {
namespace {

constexpr std::size_t kMostLabelBytes = 1u << 20;
constexpr std::size_t kMostMotionBytes = 512u << 20;
constexpr double kPerformerHeightM = 1.75;

std::string SubjectOf(const std::string& motion) {
  return model::SubjectOfFile(std::filesystem::path(motion).stem().string());
}

/// Refuses a model that has seen this very file.
Result<void> CheckNotTrainedOnFile(const model::Model& model, const std::string& motion,
                                   const std::string& origin) {
  const auto text = config::ReadTextFile(motion, kMostMotionBytes);
  if (!text) return {};  // Its reader says why.
  const model::Digest digest = model::Sha256(*text);
  for (const model::DataFile& file : model.provenance.data) {
    if (file.sha256 != digest) continue;
    return InvalidData(origin + ": was trained on " + motion +
                       " itself; evaluate it on another take of the same person");
  }
  return {};
}

/// A choreography, by the synthetic person.
Result<motion_files::LoadedMotion> Perform(const PoseSceneOptions& options) {
  const auto text = config::ReadTextFile(options.motion);
  if (!text) return text.error();
  const auto script = choreography::ParseScript(*text, options.motion);
  if (!script) return script.error();
  const double height_m = options.settings.height_m.value_or(kPerformerHeightM);
  const auto body = choreography::Performer(height_m, options.settings.mass_kg);
  if (!body) return body.error();
  return motion_files::LoadedMotion{choreography::Perform(*script, *body).motion, "", height_m};
}

/// The same movements at another speed, at the same rate.
motion::Motion AtSpeed(double speed, const motion::Motion& clip) {
  motion::Motion paced = clip;
  paced.rate_hz *= speed;
  paced.start_s /= speed;
  return motion::Resampled(paced, clip.rate_hz);
}

Result<motion_files::LoadedMotion> LoadFile(const PoseSceneOptions& options) {
  if (options.motion.ends_with(".json")) {
    if (options.still.empty()) return Perform(options);
    return UsageError(options.motion + ": has no markers, so --still " + options.still +
                      " would have no effect; leave it out");
  }
  if (!motion_files::IsMotionFile(options.motion)) {
    return UsageError(options.motion +
                      ": not a motion: expected .bvh, .amc, .trc, .c3d, or a script, .json");
  }
  motion_files::LoadOptions load;
  load.skeleton = options.skeleton;
  load.still = options.still;
  load.bvh_unit_m = options.bvh_unit_m;
  auto loaded = motion_files::LoadMotion(options.motion, load);
  if (loaded && !loaded->height_m && !loaded->note.empty()) {  // The unit of a BVH file.
    std::fprintf(stderr, "%s: %s\n", options.motion.c_str(), loaded->note.c_str());
  }
  if (!loaded || !options.standard_layout) return loaded;
  const auto kept = motion::WithLandmarksOnly(loaded->motion);
  if (!kept) return InvalidData(options.motion + ": " + kept.error().message);
  if (motion::HasStandardLayout(*kept)) return loaded;
  auto standard = motion::ToStandardLayout(*kept);
  if (!standard) return InvalidData(options.motion + ": " + standard.error().message);
  std::fprintf(stderr, "%s: another skeleton, fitted to the standard layout within %.1f mm\n",
               options.motion.c_str(), 1e3 * standard->rms_m);
  loaded->motion = std::move(standard->motion);
  loaded->height_m = standard->height_m;
  return loaded;
}

}  // namespace

Result<motion_files::LoadedMotion> LoadScene(const PoseSceneOptions& options) {
  auto loaded = LoadFile(options);
  if (loaded && options.speed != 1) loaded->motion = AtSpeed(options.speed, loaded->motion);
  return loaded;
}

namespace {

pose_run::Settings WithHeight(const PoseSceneOptions& options,
                              const motion_files::LoadedMotion& loaded) {
  pose_run::Settings settings = options.settings;
  if (!settings.height_m) settings.height_m = loaded.height_m;
  return settings;
}

/// Reads the labels file; no spans where no such file is given.
Result<std::vector<pose_run::ActivitySpan>> ReadActivities(const PoseSceneOptions& options) {
  if (options.activities.empty()) return std::vector<pose_run::ActivitySpan>{};
  if (options.settings.loop_s > 0) {
    return UsageError("--activities are of the clip as it is: no --loop-minutes with them");
  }
  const auto text = config::ReadTextFile(options.activities, kMostLabelBytes);
  if (!text) return text.error();
  return pose_run::ParseActivities(*text, options.activities);
}

/// By somebody who stands still: what is added to a COP of the plates.
Result<Eigen::Vector2d> PlatesOffset(const PoseSceneOptions& options) {
  PoseSceneOptions still = options;
  still.motion = options.still;
  const auto loaded = LoadScene(still);
  if (!loaded) return loaded.error();
  const auto forces = motion_files::LoadForces(options.still_forces);
  if (!forces) return InvalidData(forces.error().message);
  return pose_run::StandingOffset(loaded->motion, *forces, WithHeight(still, *loaded),
                                  options.still, options.still_forces);
}

pose_run::Activities LabelActivities(const pose_run::PoseRun& run,
                                     const std::vector<pose_run::ActivitySpan>& spans) {
  return spans.empty() ? pose_run::RuledActivities(run) : pose_run::LabelledActivities(run, spans);
}

}  // namespace

Result<pose_run::PoseRun> MakePoseScene(const PoseSceneOptions& options) {
  const auto spans = ReadActivities(options);
  if (!spans) return spans.error();
  const auto loaded = LoadScene(options);
  if (!loaded) return loaded.error();
  auto run = pose_run::RunPose(loaded->motion, WithHeight(options, *loaded), options.motion);
  if (run) run->activities = LabelActivities(*run, *spans);
  return run;
}

Result<pose_run::PlateRun> MakePlateScene(const PoseSceneOptions& options) {
  const auto loaded = LoadScene(options);
  if (!loaded) return loaded.error();
  return MakePlateScene(options, *loaded);
}

Result<pose_run::PlateRun> MakePlateScene(const PoseSceneOptions& options,
                                          const motion_files::LoadedMotion& loaded) {
  const auto spans = ReadActivities(options);
  if (!spans) return spans.error();
  auto forces = motion_files::LoadForces(options.forces);
  if (!forces) return InvalidData(forces.error().message);
  if (!options.still_forces.empty()) {
    const auto offset = PlatesOffset(options);
    if (!offset) return offset.error();
    for (motion::PlateForces& plate : forces->plates) {
      plate.cop_W.topRows<2>().colwise() += *offset;
    }
  }
  auto plates = pose_run::RunOnPlates(loaded.motion, *forces, WithHeight(options, loaded),
                                      options.motion, options.forces);
  if (!plates) return plates.error();
  plates->measured.activities = LabelActivities(plates->measured, *spans);
  plates->simulated.activities = plates->measured.activities;
  return plates;
}

Result<pose_run::InsoleRun> MakeInsoleScene(const PoseSceneOptions& options) {
  const auto loaded = LoadScene(options);
  if (!loaded) return loaded.error();
  return pose_run::RunInsoles(loaded->motion, WithHeight(options, *loaded), options.motion);
}

Result<pose_run::ArmRun> MakeArmScene(const PoseSceneOptions& options,
                                      const pose_run::Places& places) {
  const auto loaded = LoadScene(options);
  if (!loaded) return loaded.error();
  return pose_run::RunArms(loaded->motion, WithHeight(options, *loaded), options.motion, places);
}

Result<reconstruction::NamedModel> ReadModel(const std::string& path, const std::string& motion,
                                             bool same_person) {
  const auto bytes = config::ReadTextFile(path, model::kMostFileBytes);
  if (!bytes) return bytes.error();
  auto model = wire::FromModelFile(*bytes, path);
  if (!model) return model.error();
  if (!same_person && model->kind != "person") {
    const auto fresh = model::CheckNotTrainedOn(*model, SubjectOf(motion), path);
    if (!fresh) return fresh.error();
  }
  const auto fresh = CheckNotTrainedOnFile(*model, motion, path);
  if (!fresh) return fresh.error();
  return reconstruction::NamedModel{path, std::move(*model)};
}

Result<arms::ArmModel> ReadArmModel(const std::string& file, const std::string& motion,
                                    bool same_person) {
  std::string path = file;
  if (path.empty()) {
    const auto found = config::FindDataFile("arm.fmodel");
    if (!found) return found.error();
    path = *found;
  }
  const auto model = ReadModel(path, motion, same_person);
  if (!model) return model.error();
  return arms::MakeArmModel(model->model, path);
}

Result<reconstruction::Models> ReadPoseModels(const std::vector<std::string>& files,
                                              const std::string& motion, bool same_person) {
  std::vector<std::string> paths = files;
  if (paths.empty()) {
    for (const char* name : {"pose.fmodel", "com.fmodel", "arm.fmodel", "arm_paper.fmodel"}) {
      const auto path = config::FindDataFile(name);
      if (!path) return path.error();
      paths.push_back(*path);
    }
  }
  std::vector<reconstruction::NamedModel> models;
  for (const std::string& path : paths) {
    auto model = ReadModel(path, motion, same_person);
    if (!model) return model.error();
    models.push_back(std::move(*model));
  }
  return reconstruction::MakeModels(models);
}

void AddMotionOptions(CLI::App& command, PoseSceneOptions& scene) {
  command
      .add_option("--motion", scene.motion,
                  "Motion: BVH, AMC, TRC or C3D file, or choreography script (.json)")
      ->required();
  sensor_options::AddMotionFile(command, scene.skeleton, scene.bvh_unit_m);
  command.add_option("--still", scene.still,
                     "Marker file of the same person standing still, TRC or C3D");
}

}  // namespace footing::eval
