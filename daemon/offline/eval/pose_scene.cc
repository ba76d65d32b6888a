#include "daemon/offline/eval/pose_scene.h"

#include <filesystem>

#include "common/config/data_file.h"
#include "common/model/model.h"
#include "common/motion_files/load.h"
#include "common/wire/model_file.h"

namespace footing::eval {
namespace {

std::string SubjectOf(const std::string& motion) {
  const std::string stem = std::filesystem::path(motion).stem().string();
  return model::SubjectName(stem.substr(0, stem.find('_')));
}

Result<reconstruction::NamedModel> ReadModel(const std::string& path) {
  const auto bytes = config::ReadTextFile(path, model::kMostFileBytes);
  if (!bytes) return bytes.error();
  auto model = wire::FromModelFile(*bytes, path);
  if (!model) return model.error();
  return reconstruction::NamedModel{path, std::move(*model)};
}

Result<motion_files::LoadedMotion> Load(const PoseSceneOptions& options) {
  motion_files::LoadOptions load;
  load.skeleton = options.skeleton;
  load.still = options.still;
  return motion_files::LoadMotion(options.motion, load);
}

rehearsal::Settings WithHeight(const PoseSceneOptions& options,
                               const motion_files::LoadedMotion& loaded) {
  rehearsal::Settings settings = options.settings;
  if (!settings.height_m) settings.height_m = loaded.height_m;
  return settings;
}

}  // namespace

Result<rehearsal::Rehearsal> MakePoseScene(const PoseSceneOptions& options) {
  const auto loaded = Load(options);
  if (!loaded) return loaded.error();
  return rehearsal::Rehearse(loaded->motion, WithHeight(options, *loaded), options.motion);
}

Result<rehearsal::PlateRehearsal> MakePlateScene(const PoseSceneOptions& options) {
  const auto loaded = Load(options);
  if (!loaded) return loaded.error();
  const auto forces = motion_files::LoadForces(options.forces);
  if (!forces) return InvalidData(forces.error().message);
  return rehearsal::RehearseOnPlates(loaded->motion, *forces, WithHeight(options, *loaded),
                                     options.motion, options.forces);
}

Result<rehearsal::InsoleRehearsal> MakeInsoleScene(const PoseSceneOptions& options) {
  const auto loaded = Load(options);
  if (!loaded) return loaded.error();
  return rehearsal::RehearseInsoles(loaded->motion, WithHeight(options, *loaded), options.motion);
}

Result<reconstruction::Models> ReadPoseModels(const std::vector<std::string>& files,
                                              const std::string& motion) {
  std::vector<std::string> paths = files;
  if (paths.empty()) {
    for (const char* name : {"pose.fmodel", "com.fmodel"}) {
      const auto path = config::FindDataFile(name);
      if (!path) return path.error();
      paths.push_back(*path);
    }
  }
  std::vector<reconstruction::NamedModel> models;
  for (const std::string& path : paths) {
    auto model = ReadModel(path);
    if (!model) return model.error();
    const auto fresh = model::CheckNotTrainedOn(model->model, SubjectOf(motion), path);
    if (!fresh) return fresh.error();
    models.push_back(std::move(*model));
  }
  return reconstruction::MakeModels(models);
}

}  // namespace footing::eval
