#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace footing::scene {

enum class Shape : std::uint32_t {
  kBall,  ///< Unit sphere about the origin.
  kBox,   ///< Unit cube about the origin.
  kRod,   ///< Unit radius about z, from z = 0 to 1, its top scaled by the part's taper.
};

/// What a pixel of the id picture shows; tests count them.
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

}  // namespace footing::scene
