#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "clients/view/scene/bird_motion.h"
#include "clients/view/scene/body_signs.h"
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
  PartList figures;  ///< Birds and people, and what they stand on.
  PartList forces;
  PartList ghosts;            ///< Figures that one sees through.
  PartList signs;             ///< Drawn through what is before them.
  PartList clear;             ///< Discs that show what is under them.
  std::vector<Label> labels;  ///< Words beside points of the world.
  bool studio = false;        ///< A floor in place of the grass.
  std::vector<Spot> spots;    ///< One a figure.
  std::vector<Blob> blobs;
  std::vector<Eigen::Vector3f> footholds;  ///< Where the next feet are meant to land.

  float floor_m = 0;   ///< Height of the ground that the first character is over.
  float ground_m = 0;  ///< Height of the ground around the track.
};

struct StageOptions {
  bool forces = false;
  bool overlay_reference = false;  ///< Over the figure in place of beside it.
};

/// Turns frames into pictures; keeps what is filtered over time.
class Stage {
 public:
  /// Moves on by dt_s and builds the picture of `frame`; without characters, of an empty ground.
  /// `now_ns` is the viewer's clock, for what is stale.
  Picture Advance(const Model& model, const WorldFrame& frame, std::int64_t now_ns, double dt_s,
                  const StageOptions& options);

 private:
  void AddCharacter(const Model& model, const CharacterPose& pose, double dt_s,
                    const StageOptions& options, Picture& picture);

  void AddReconstructed(const Model& model, const CharacterPose& pose, double time_s,
                        std::int64_t now_ns, const StageOptions& options, Picture& picture);
  Picture AdvancePeople(const Model& model, const WorldFrame& frame, std::int64_t now_ns,
                        double dt_s, const StageOptions& options);

  ChaseCamera camera_;
  double roll_rad_ = 0;  ///< Of the picture, as it follows a person's head.
  FrontCamera front_;
  std::map<std::uint32_t, ComTrail> trails_;
  std::map<std::uint32_t, BirdMotion> motions_;
};

}  // namespace footing::scene
