#pragma once

#include <vector>

namespace footing::sphere {

/// Brightness of a blurred disc at a distance from its middle, and how it changes.
struct ProfileValue {
  float disc = 0;  ///< Of an even disc: 1 inside, 0 outside.
  float limb = 0;  ///< Of a disc whose brightness is 1 - cos, 0 in the middle, 1 at the edge.
  float disc_d = 0, limb_d = 0;        ///< Slopes along `beyond`.
  float disc_blur = 0, limb_blur = 0;  ///< Slopes along `blur`.
};

/// Both discs convolved with a Gaussian, tabulated once by numerical integration over radius, with
/// the angle done by a Bessel function. Distances are in units of the blur's deviation.
class ProfileTable {
 public:
  ProfileTable();

  /// `beyond`: distance outside of the edge, in blurs; `blur`: deviation over the disc's radius,
  /// held to 0.005 to 0.6.
  ProfileValue At(float beyond, float blur) const;

  static constexpr float kReach = 5;  ///< Beyond that, the disc is 1 or 0.

 private:
  static constexpr int kBlurs = 61, kDistances = 101;
  static constexpr float kLeastBlur = 0.005F, kBlurStep = 0.01F, kDistanceStep = 0.1F;

  struct Cell {
    float disc, limb;
  };
  std::vector<Cell> cells_;
};

}  // namespace footing::sphere
