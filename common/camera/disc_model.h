#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "common/camera/disc_fit.h"

/// The picture of a sphere as the photometric fit models it, many pixels at a time.
namespace footing::sphere::disc {

inline constexpr int kShape = 7;   // Axis s and t, tangent, blur, limb, gradient along s and t.
inline constexpr int kMotion = 3;  // During the exposure: travel in the image, px; growth.

using Shape = Eigen::Matrix<double, kShape, 1>;

/// One number of each of so many pixels. Single precision: 1e-6 of a blur, 1e-5 DN.
inline constexpr int kBlock = 32;
using Lane = Eigen::Array<float, kBlock, 1>;

/// All parameters of the model of a sphere's image.
struct State {
  Shape shape;                                // As kShape lists.
  Eigen::Vector2d motion_px{0, 0};            // Zero for a sphere at rest.
  double growth = 0;                          // Relative growth of the tangent: it comes nearer.
  std::array<double, 3> inside{}, outside{};  // Levels of each channel, DN.
};

/// Size of pixels in slopes, and the times at which their rows are exposed.
class PixelScale {
 public:
  /// `rows_per_exposure`: a row's time over the exposure.
  PixelScale(const LocalSlopes& slopes, double rows_per_exposure)
      : scale_(slopes.scale()),
        square_(scale_ * scale_.transpose()),
        down_(scale_.inverse().row(1) * rows_per_exposure) {
    const Eigen::Matrix2d to_px = scale_.inverse();
    for (int i = 0; i < 2; ++i) {
      const Eigen::Matrix2d per_slope =
          to_px(0, i) * slopes.ScaleChange(0) + to_px(1, i) * slopes.ScaleChange(1);
      square_change_[static_cast<std::size_t>(i)] =
          scale_ * per_slope.transpose() + per_slope * scale_.transpose();
    }
  }

  /// Blur across the edge as it is along a direction, in slopes, for a blur of one pixel.
  double Along(const Eigen::Vector2d& unit) const { return std::sqrt(unit.dot(square_ * unit)); }
  /// Square of that, as a matrix.
  const Eigen::Matrix2d& square() const { return square_; }
  /// How that changes per slope along s (0) or t (1): off the optical axis a pixel covers less
  /// towards the edge of the image.
  const Eigen::Matrix2d& square_change(std::size_t axis) const { return square_change_[axis]; }
  /// How much later a row is exposed per slope, in exposures, near the middle of the blob.
  const Eigen::Vector2d& down() const { return down_; }
  const Eigen::Matrix2d& scale() const { return scale_; }

 private:
  Eigen::Matrix2d scale_, square_;
  std::array<Eigen::Matrix2d, 2> square_change_;
  Eigen::Vector2d down_;
};

/// Light of pixels by the model, with its slopes along its own parameters.
struct Modelled {
  Lane light;   // Light of the sphere, over the level inside.
  Lane cover;   // Share of the pixel that the sphere hides: it is opaque.
  Lane beyond;  // Blurs outside of the edge.
  std::array<Lane, kShape> light_slope;
  std::array<Lane, 4> cover_slope;  // Along the first four parameters.
};

/// Models pixels at slopes (s, t), at the sphere's place in the middle of the exposure of its
/// middle.
void Model(const Lane& s, const Lane& t, const State& state, const PixelScale& scale,
           const ProfileTable& table, Modelled& result);

/// The same for a moving sphere, with its slopes along the motion.
struct ModelledMoving : Modelled {
  std::array<Lane, kMotion> light_motion, cover_motion;  // Slopes along the motion.
};

/// The same of a sphere that moves: the mean over the exposure of the pixels' rows, which are
/// exposed so much later than that of its axis.
void ModelMoving(const Lane& s, const Lane& t, const Lane& later, const State& state,
                 const PixelScale& scale, const ProfileTable& table, ModelledMoving& sum);

}  // namespace footing::sphere::disc
