#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/signs.h"
#include "clients/view/scene/tally.h"
#include "common/board/geometry.h"

namespace footing::scene {

/// A soft dark spot on the ground: place, and how wide and how dark it is.
struct Blob {
  Eigen::Vector3f position_m;
  float radius_m = 0;
  float darkness = 0;  ///< 0 to 1.
};

/// Place where a bird marks the ground: the point under it and the ground's rise along x and y.
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

/// Options of the scene's picture.
struct StageOptions {
  bool forces = false;
  bool overlay_reference = false;  ///< Over the figure in place of beside it.
  /// Character that the camera follows; where it is not there, the first one.
  std::uint32_t followed = 0;
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
  double roll_rad_ = 0;  ///< Roll of the picture, which follows a person's head.
  FrontCamera front_;
  std::map<std::uint32_t, ComTrail> trails_;
  std::map<std::uint32_t, BirdMotion> motions_;
};

/// Adds a reconstructed person: the figure, or before its T-pose the silhouette to stand in, the
/// boards, the signs, and the reference beside it or over it.
void AddBody(const Model& model, const CharacterPose& pose, const ComTrail& trail,
             std::int64_t now_ns, const StageOptions& options, Picture& picture);

/// A reference came within the last second.
bool HasReference(const Model& model, std::int64_t now_ns);

/// The way from received ticks to what is drawn at an instant.
class Show {
 public:
  struct Shot {
    WorldFrame frame;  ///< Empty until the first character came.
    Picture picture;
    const Model& past;         ///< The model as it was when the scene was frozen, else that of now.
    std::int64_t past_ns = 0;  ///< When that was, else now.
  };

  Model& model() { return model_; }
  const Model& model() const { return model_; }

  /// Takes a tick in for display; `now_ns` is when, for its latency.
  void Take(const Update& update, std::int64_t now_ns);

  /// From now on every fall is shown again in slow motion as soon as it is over.
  void ReplayFalls() { replays_falls_ = true; }
  /// Shows the last fall again in slow motion, or ends that.
  void ToggleReplay(std::int64_t now_ns);

  /// Shot to draw at `now_ns`, which never runs back. Frozen, the world and all that slides with
  /// time stand still.
  Shot At(std::int64_t now_ns, bool frozen, const StageOptions& options);

  /// Playback moves on in steps of its own, so that what is shown depends on the time alone and not
  /// on when it was drawn: Step moves the camera and all that is filtered to `now_ns`, Peek shows
  /// an instant at or behind the last step and leaves that step as it is.
  void Step(std::int64_t now_ns, const StageOptions& options);
  Shot Peek(std::int64_t now_ns, const StageOptions& options);

 private:
  WorldFrame FrameAt(std::int64_t now_ns);
  WorldFrame ShownAt(std::int64_t now_ns) const;
  double PassedS(std::int64_t now_ns) const;

  struct Frozen {
    Model model;
    std::int64_t at_ns = 0;
  };

  Model model_;
  Stage stage_;
  WorldFrame frame_;
  std::unique_ptr<const Frozen> frozen_;
  std::int64_t last_ns_ = 0;
  bool replays_falls_ = false;
  std::uint64_t replayed_ = 0;  ///< Clips that were there at the last look.
};

/// A board as it lies, with its newest sample where there is one.
struct PlacedBoard {
  stream::BoardPose pose;
  bool live = false;  ///< A sample came within the last half second.
  stream::BoardSample sample;
  stream::BoardGeometry geometry = board::kBalanceBoard;

  /// A point of the plate frame P in W.
  Eigen::Vector2d InWorld(double right_m, double front_m) const;
  /// Sensors in the order top left, top right, bottom left, bottom right.
  std::array<Eigen::Vector2d, board::kCorners> Sensors() const;
  std::array<double, 4> Loads() const;
};

/// The left and the right board of a rig by its published layout, or by the default one.
std::array<PlacedBoard, 2> BoardsOf(const Model& model, const std::string& rig,
                                    std::int64_t now_ns);

/// The geometry in force of a board, by {source, device}.
stream::BoardGeometry GeometryOf(const Model& model, const std::pair<int, std::uint32_t>& board);

/// Two plates with their surface at z = 0.
void AddPlates(const std::array<PlacedBoard, 2>& boards, PartList& parts);
/// The same, and on each sensor a column as high as its load.
void AddBoards(const std::array<PlacedBoard, 2>& boards, PartList& parts);

/// Left is blue, right is amber, in the whole picture.
Colour SideColour(std::size_t side);

}  // namespace footing::scene
