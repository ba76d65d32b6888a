#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "common/sphere/profile_table.h"

/// The picture of a sphere as the photometric fit models it, pixel by pixel.
namespace footing::sphere::disc {

inline constexpr int kShape = 7;   // Axis s and t, tangent, blur, limb, gradient along s and t.
inline constexpr int kMotion = 2;  // Travel in the image during the exposure, px.
inline constexpr int kLevels = kShape + kMotion;  // Where those of the first channel are.
inline constexpr int kParameters = kLevels + 6;
inline constexpr int kOwn = kShape + 2;  // What one pixel of a sphere at rest depends on.
inline constexpr int kOwnMoving = kOwn + kMotion;

using Shape = Eigen::Matrix<double, kShape, 1>;
using Normal = Eigen::Matrix<double, kParameters, kParameters>;
using Right = Eigen::Matrix<double, kParameters, 1>;

/// One pixel that takes part.
struct Sample {
  Eigen::Vector2d slopes;
  double value;
  int channel;
  int sector;
  double behind = 0;  // What is behind the sphere there, less the state's `outside`, DN.
  // At the state that was evaluated last.
  double beyond = 0;    // Blurs outside of the edge.
  double residual = 0;  // Over its deviation.
  double height = 0;    // Contrast of its channel, alike.
};

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
  /// Square of it beside that direction, less the square along it.
  double Excess(const Eigen::Vector2d& unit) const {
    return square_.trace() - 2 * unit.dot(square_ * unit);
  }
  /// Of a pixel so far from the sphere's axis: how much later its row is exposed, in exposures.
  double Later(const Eigen::Vector2d& from) const { return down_.dot(from); }
  const Eigen::Matrix2d& scale() const { return scale_; }

 private:
  Eigen::Matrix2d scale_, square_;
  Eigen::Vector2d down_;
};

/// What the model says of one pixel, with its slopes along its own parameters.
struct Modelled {
  double light = 0;   // Of the sphere, over the level inside.
  double cover = 0;   // Share of the pixel that the sphere hides: it is opaque.
  double beyond = 0;  // Blurs outside of the edge.
  Shape light_slope;
  Eigen::Vector4d cover_slope;  // Along the first four parameters.
};

/// Of a pixel at these slopes, at the sphere's place in the middle of the exposure of its middle.
Modelled Model(const Eigen::Vector2d& slopes, const State& state, const PixelScale& scale,
               const ProfileTable& table);

struct ModelledMoving : Modelled {
  Eigen::Vector2d light_motion{0, 0}, cover_motion{0, 0};  // Slopes along the motion.
};

/// The same of a sphere that moves: the mean over the exposure of the pixel's row.
ModelledMoving ModelMoving(const Eigen::Vector2d& slopes, const State& state,
                           const PixelScale& scale, const ProfileTable& table);

/// Normal equations; a pixel knows only its own channel's levels. `kSize` is kOwn or kOwnMoving.
template <int kSize>
class Equations {
 public:
  using Row = Eigen::Matrix<double, kSize, 1>;

  void Add(const Row& row, double residual, double weight, std::size_t channel) {
    const Row weighted = weight * row;
    per_channel_[channel].noalias() += weighted * row.transpose();
    right_[channel].noalias() += weighted * residual;
  }

  /// Of all parameters; those that take no part get a 1 on the diagonal.
  void Assemble(Normal& normal, Right& right) const {
    constexpr int kHead = kSize - 2;
    normal.setZero();
    right.setZero();
    for (int c = 0; c < 3; ++c) {
      const auto& part = per_channel_[static_cast<std::size_t>(c)];
      const auto& part_right = right_[static_cast<std::size_t>(c)];
      const int own = kLevels + 2 * c;
      normal.template topLeftCorner<kHead, kHead>() += part.template topLeftCorner<kHead, kHead>();
      normal.template block<kHead, 2>(0, own) = part.template topRightCorner<kHead, 2>();
      normal.template block<2, kHead>(own, 0) = part.template bottomLeftCorner<2, kHead>();
      normal.template block<2, 2>(own, own) = part.template bottomRightCorner<2, 2>();
      right.template head<kHead>() += part_right.template head<kHead>();
      right.template segment<2>(own) = part_right.template tail<2>();
    }
    for (int i = 0; i < kParameters; ++i)
      if (normal(i, i) <= 0) normal(i, i) = 1;
  }

 private:
  using Part = Eigen::Matrix<double, kSize, kSize>;
  std::array<Part, 3> per_channel_{Part::Zero(), Part::Zero(), Part::Zero()};
  std::array<Row, 3> right_{Row::Zero(), Row::Zero(), Row::Zero()};
};

}  // namespace footing::sphere::disc
