#include "daemon/offline/eval/pose/motion_options.h"

namespace footing::eval {

void AddMotionOptions(CLI::App& command, PoseSceneOptions& scene) {
  command
      .add_option("--motion", scene.motion,
                  "Motion: BVH, AMC, TRC or C3D file, or choreography script (.json)")
      ->required();
  command.add_option("--skeleton", scene.skeleton, "Skeleton of an AMC motion, ASF file");
  command
      .add_option("--bvh-unit-m", scene.bvh_unit_m,
                  "Unit of length of a BVH motion, m (default: by the height of its person)")
      ->check(CLI::Range(1e-4, 10.0));
  command.add_option("--still", scene.still,
                     "Marker file of the same person standing still, TRC or C3D");
}

}  // namespace footing::eval
