#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "common/sphere/profile_table.h"

/// The picture of a sphere as the photometric fit models it, many pixels at a time.
namespace footing::sphere::disc {

inline constexpr int kShape = 7;   // Axis s and t, tangent, blur, limb, gradient along s and t.
inline constexpr int kMotion = 2;  // Travel in the image during the exposure, px.

using Shape = Eigen::Matrix<double, kShape, 1>;

/// One number of each of so many pixels. Single precision: 1e-6 of a blur, 1e-5 DN.
inline constexpr int kBlock = 32;
using Lane = Eigen::Array<float, kBlock, 1>;

struct State {
  Shape shape;                                // As kShape lists.
  Eigen::Vector2d motion_px{0, 0};            // Zero for a sphere at rest.
  std::array<double, 3> inside{}, outside{};  // Of each channel, DN.
};

/// What pixels are in slopes, and when their rows are exposed.
class PixelScale {
 public:
  /// `rows_per_exposure`: a row's time over the exposure.
  PixelScale(const Eigen::Matrix2d& scale, double rows_per_exposure)
      : scale_(scale),
        square_(scale * scale.transpose()),
        down_(scale.inverse().row(1) * rows_per_exposure) {}

  /// Blur across the edge as it is along a direction, in slopes, for a blur of one pixel.
  double Along(const Eigen::Vector2d& unit) const { return std::sqrt(unit.dot(square_ * unit)); }
  /// Square of that, as a matrix.
  const Eigen::Matrix2d& square() const { return square_; }
  /// Of a pixel so far from the sphere's axis: how much later its row is exposed, in exposures.
  double Later(const Eigen::Vector2d& from) const { return down_.dot(from); }
  const Eigen::Vector2d& down() const { return down_; }
  const Eigen::Matrix2d& scale() const { return scale_; }

 private:
  Eigen::Matrix2d scale_, square_;
  Eigen::Vector2d down_;
};

/// What the model says of pixels, with its slopes along its own parameters.
struct Modelled {
  Lane light;   // Of the sphere, over the level inside.
  Lane cover;   // Share of the pixel that the sphere hides: it is opaque.
  Lane beyond;  // Blurs outside of the edge.
  std::array<Lane, kShape> light_slope;
  std::array<Lane, 4> cover_slope;  // Along the first four parameters.
};

/// Of pixels at slopes (s, t), at the sphere's place in the middle of the exposure of its middle.
void Model(const Lane& s, const Lane& t, const State& state, const PixelScale& scale,
           const ProfileTable& table, Modelled& result);

struct ModelledMoving : Modelled {
  std::array<Lane, kMotion> light_motion, cover_motion;  // Slopes along the motion.
};

/// The same of a sphere that moves: the mean over the exposure of the pixels' rows.
void ModelMoving(const Lane& s, const Lane& t, const State& state, const PixelScale& scale,
                 const ProfileTable& table, ModelledMoving& sum);

}  // namespace footing::sphere::disc
