#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "clients/view/scene/bird_motion.h"
#include "clients/view/scene/camera.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/part.h"

namespace footing::scene {

/// A soft dark spot on the ground: place, and how wide and how dark it is.
struct Blob {
  Eigen::Vector3f position_m;
  float radius_m = 0;
  float darkness = 0;  ///< 0 to 1.
};

/// Where a bird marks the ground: the point under it and the ground's rise along x and y.
struct Spot {
  Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();
  Eigen::Vector2f slope = Eigen::Vector2f::Zero();
};

/// One picture, ready to be drawn.
struct Picture {
  Camera camera;
  PartList birds;
  PartList forces;
  std::vector<Spot> spots;  ///< One a bird.
  std::vector<Blob> blobs;
  std::vector<Eigen::Vector3f> footholds;  ///< Where the next feet are meant to land.

  float floor_m = 0;   ///< Height of the ground that the first character is over.
  float ground_m = 0;  ///< Height of the ground around the track.
};

struct StageOptions {
  bool forces = false;
};

/// Turns frames into pictures; keeps what is filtered over time.
class Stage {
 public:
  /// Moves on by dt_s and builds the picture of `frame`; without characters, of an empty ground.
  Picture Advance(const Model& model, const WorldFrame& frame, double dt_s,
                  const StageOptions& options);

 private:
  void AddCharacter(const Model& model, const CharacterPose& pose, double dt_s,
                    const StageOptions& options, Picture& picture);

  ChaseCamera camera_;
  std::map<std::uint32_t, BirdMotion> motions_;
};

}  // namespace footing::scene
