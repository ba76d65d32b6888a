#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/result.h"
#include "common/virtual/options/load.h"
#include "daemon/offline/pose_run/plates.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::eval {

/// A motion file, and what the boards and hands measure of it.
struct PoseSceneOptions {
  std::string motion;    ///< BVH, AMC, TRC or C3D, or a choreography (.json).
  std::string skeleton;  ///< ASF, of an AMC.
  std::optional<double> bvh_unit_m = {};
  double speed = 1;   ///< Speed of the motion, of the recorded one; forces are those of that speed.
  std::string still;  ///< TRC or C3D of the same person standing, of markers.
  std::string forces;             ///< MOT, STO or C3D of the plates under the same trial.
  std::string still_forces = {};  ///< The same of the plates under `still`; may be empty.
  std::string activities;         ///< CSV of labels (pose_run.h); empty: by rules.
  bool standard_layout = true;    ///< Fit any other skeleton to the one that the engine runs.
  pose_run::Settings settings;
};

/// The motion alone, in the standard layout if that is asked for. InvalidData when it cannot be
/// read.
Result<motion_files::LoadedMotion> LoadScene(const PoseSceneOptions& options);

/// Scene on two boards. InvalidData when a file cannot be read.
Result<pose_run::PoseRun> MakePoseScene(const PoseSceneOptions& options);

/// With the plates of options.forces, whose COPs are moved by what those of options.still_forces
/// are off from under the body that stands still. A file that cannot be read is InvalidData, too.
Result<pose_run::PlateRun> MakePlateScene(const PoseSceneOptions& options);
/// The same under a motion that LoadScene() has read.
Result<pose_run::PlateRun> MakePlateScene(const PoseSceneOptions& options,
                                          const motion_files::LoadedMotion& loaded);

/// Scene with insoles in the shoes.
Result<pose_run::InsoleRun> MakeInsoleScene(const PoseSceneOptions& options);

/// Scene with devices at these places on the arms.
Result<pose_run::ArmRun> MakeArmScene(const PoseSceneOptions& options,
                                      const pose_run::Places& places);

/// Refuses a model that was trained on the motion's subject, as the file's name has it, or on this
/// very file under any name; with `same_person` only the latter.
Result<reconstruction::NamedModel> ReadModel(const std::string& path, const std::string& motion,
                                             bool same_person);
/// Likewise. Empty: the one that the product carries.
Result<arms::ArmModel> ReadArmModel(const std::string& file, const std::string& motion,
                                    bool same_person);

/// Reads the models and refuses those that were trained on the motion's subject (the file's name up
/// to the first '_'); with `same_person`, only those that were trained on this very file: a
/// person's own model is evaluated on another of their takes. No file: those that the product
/// carries.
Result<reconstruction::Models> ReadPoseModels(const std::vector<std::string>& files,
                                              const std::string& motion, bool same_person = false);

/// Adds --motion, --skeleton and --still to a command that evaluates a motion.
void AddMotionOptions(CLI::App& command, PoseSceneOptions& scene);

}  // namespace footing::eval
