#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "common/sphere/profile_table.h"

/// The picture of a sphere as the photometric fit models it, pixel by pixel.
namespace footing::sphere::disc {

inline constexpr int kShape = 7;  // Axis s and t, tangent, blur, limb, gradient along s and t.
inline constexpr int kParameters = kShape + 6;
inline constexpr int kOwn = kShape + 2;  // What one pixel depends on.

using Own = Eigen::Matrix<double, kOwn, 1>;
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
  std::array<double, 3> inside{}, outside{};  // Of each channel, DN.
};

/// Blur across the edge as it is along a direction, in slopes, for a blur of one pixel.
class BlurScale {
 public:
  explicit BlurScale(const Eigen::Matrix2d& scale) : square_(scale * scale.transpose()) {}
  double Along(const Eigen::Vector2d& unit) const { return std::sqrt(unit.dot(square_ * unit)); }
  /// Square of it beside that direction, less the square along it.
  double Excess(const Eigen::Vector2d& unit) const {
    return square_.trace() - 2 * unit.dot(square_ * unit);
  }

 private:
  Eigen::Matrix2d square_;
};

/// What the model says of one pixel, with its slopes along its own parameters.
struct Modelled {
  double light = 0;   // Of the sphere, over the level inside.
  double cover = 0;   // Share of the pixel that the sphere hides: it is opaque.
  double beyond = 0;  // Blurs outside of the edge.
  Shape light_slope;
  Eigen::Vector4d cover_slope;  // Along the first four parameters.
};

/// Of a pixel at the sample's slopes.
Modelled Model(const Sample& sample, const State& state, const BlurScale& scale,
               const ProfileTable& table);

/// Normal equations; a pixel knows only its own channel's levels.
class Equations {
 public:
  void Add(const Own& row, double residual, double weight, std::size_t channel) {
    const Own weighted = weight * row;
    per_channel_[channel].noalias() += weighted * row.transpose();
    right_[channel].noalias() += weighted * residual;
  }

  void Assemble(Normal& normal, Right& right) const;

 private:
  std::array<Eigen::Matrix<double, kOwn, kOwn>, 3> per_channel_{
      Eigen::Matrix<double, kOwn, kOwn>::Zero(), Eigen::Matrix<double, kOwn, kOwn>::Zero(),
      Eigen::Matrix<double, kOwn, kOwn>::Zero()};
  std::array<Own, 3> right_{Own::Zero(), Own::Zero(), Own::Zero()};
};

}  // namespace footing::sphere::disc
