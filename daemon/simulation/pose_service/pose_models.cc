#include "daemon/simulation/pose_service/pose_models.h"

#include <string>
#include <utility>
#include <vector>

#include "common/runtime/data_file.h"
#include "common/wire/model_file.h"

namespace footing::pose_service {
namespace {

Result<reconstruction::NamedModel> Load(const char* name, const std::string& data_folder) {
  const auto path = config::FindDataFile(name, data_folder);
  if (!path) {
    return Failure(path.error().message +
                   " with --set data_folder=..., or make it with footing-train (docs/models.md)");
  }
  const auto bytes = config::ReadTextFile(*path);
  if (!bytes) return bytes.error();
  auto model = wire::FromModelFile(*bytes, *path);
  if (!model) return model.error();
  return reconstruction::NamedModel{*path, std::move(model).value()};
}

}  // namespace

Result<reconstruction::Models> LoadPoseModels(const std::string& data_folder,
                                              reconstruction::Mode mode) {
  std::vector<reconstruction::NamedModel> models;
  std::vector<const char*> names{kPoseFile};
  if (mode == reconstruction::Mode::kPaper) names.push_back(kComFile);
  if (config::FindDataFile(kArmFile, data_folder)) names.push_back(kArmFile);
  for (const char* name : names) {
    auto model = Load(name, data_folder);
    if (!model) return model.error();
    models.push_back(std::move(model).value());
  }
  return reconstruction::MakeModels(models);
}

}  // namespace footing::pose_service
