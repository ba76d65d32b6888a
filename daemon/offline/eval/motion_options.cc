#include "daemon/offline/eval/motion_options.h"

#include "common/virtual/options/sensor_options.h"

namespace footing::eval {

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
