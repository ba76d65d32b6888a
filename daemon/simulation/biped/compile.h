#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "common/base/result.h"

namespace footing::physics {

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteState {
  void operator()(mjData* state) const { mj_deleteData(state); }
};
using ModelPointer = std::unique_ptr<mjModel, DeleteModel>;
using StatePointer = std::unique_ptr<mjData, DeleteState>;

/// Compiles MJCF text without touching a file (MuJoCo's own virtual file system), and keeps
/// MuJoCo's warnings from its log file: they are counted in mjData and read from there.
Result<ModelPointer> Compile(const std::string& mjcf);

/// The id of a named object, or an Error that says which is missing.
Result<int> IdOf(const mjModel& model, mjtObj type, const std::string& name);

}  // namespace footing::physics
