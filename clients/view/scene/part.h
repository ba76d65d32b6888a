#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/stream/body_state.h"
#include "common/stream/game.h"

namespace footing::scene {

/// Shape of a part before it is stretched and placed.
enum class Shape : std::uint32_t {
  kBall,  ///< Unit sphere about the origin.
  kBox,   ///< Unit cube about the origin.
  kRod,   ///< Unit radius about z, from z = 0 to 1, its top scaled by the part's taper.
};

/// Object that a pixel of the id picture shows; tests count the pixels.
enum class PartId : std::uint32_t { kNothing = 0, kBird = 1, kForce = 2 };

using Colour = Eigen::Vector3f;  ///< Linear red, green, blue, 0 to 1.

/// One drawn piece: a ball or a rod, stretched and placed. Plain floats in this order: it is also
/// the layout of an instance in the renderer's buffer.
struct Part {
  Eigen::Matrix4f X_WP = Eigen::Matrix4f::Identity();  ///< Unit shape to world.
  Colour colour = Colour::Ones();
  float taper = 1;                       ///< Top radius over bottom radius of a rod.
  Colour under_colour = Colour::Ones();  ///< Where the surface faces down in the part's own frame.
  float gloss = 0;                       ///< Strength of the highlight, 0 to 1.
};

/// Everything of one id, by shape.
struct PartList {
  std::vector<Part> balls;
  std::vector<Part> rods;
  std::vector<Part> limbs;  ///< Rods with round ends.
  std::vector<Part> boxes;  ///< Unit cubes about the origin: sides of 1.

  void AddBall(const Eigen::Matrix4f& X_WP, const Colour& colour, const Colour& under, float gloss);
  /// A rod from a to b with round ends: limbs that share an end and its radius meet without a seam.
  void AddLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a, float radius_b,
               const Colour& colour, float gloss = 0.1f);
  /// A limb that is oval across: the radii are along `x_axis`, which is made square to a-b, and
  /// `oval` times as large across it.
  void AddOvalLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                   const Eigen::Vector3f& x_axis, float radius_a, float radius_b, float oval,
                   const Colour& colour, float gloss = 0.1f);
  /// A rod from a to b with flat ends; radius_b = 0 makes a cone.
  void AddRod(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a, float radius_b,
              const Colour& colour, float gloss = 0.1f);
  /// A box of the given sides, turned by `axes` (columns) and placed at its middle.
  void AddBox(const Eigen::Vector3f& middle, const Eigen::Matrix3f& axes,
              const Eigen::Vector3f& sides_m, const Colour& colour, float gloss = 0.1f);
  /// A flat round thing on the ground: half axes along x and y, turned by `yaw_rad`.
  void AddDisc(const Eigen::Vector3f& centre, const Eigen::Vector2f& half_axes_m, float yaw_rad,
               const Colour& colour);
};

/// Ellipsoid of the given half axes, turned by `axes` (columns) and placed at `centre`.
Eigen::Matrix4f Ellipsoid(const Eigen::Vector3f& centre, const Eigen::Matrix3f& axes,
                          const Eigen::Vector3f& half_axes);

/// The colour that a screen shows for these sRGB bytes, e.g. Rgb(0xC96F4A).
Colour Rgb(std::uint32_t hex);

using stream::BodyFoot;
using stream::BodyState;

/// The true pose of a simulated body.
struct ReferencePose {
  std::int64_t received_ns = 0;  ///< On the viewer's clock, like the next.
  std::int64_t sampled_ns = 0;
  std::vector<int> parents;
  std::vector<Eigen::Vector3d> positions_m;  ///< Position of each joint, W.
};

/// The segment that the terrain game's builder holds, as a slab that one sees through; nothing
/// without one.
void AddGhostSegment(const stream::GameState& game, PartList& ghosts);

/// Linear light where the ground meets the sky, also of the fog, and straight up.
inline const Colour kHorizonLight(0.74f, 0.84f, 0.90f);
inline const Colour kZenithLight(0.09f, 0.30f, 0.66f);

/// A vertex of the sky.
struct SkyVertex {
  Eigen::Vector3f direction;  ///< From the eye, of any length.
  Colour colour;
};

/// The sky as a dome of colours with two rows of far hills before it. To be drawn in order.
struct SkyMesh {
  std::vector<SkyVertex> vertices;
  std::vector<std::uint32_t> indices;
};
/// Builds the dome and the hills.
SkyMesh BuildSky();

}  // namespace footing::scene
