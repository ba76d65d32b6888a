#pragma once

#include <Eigen/Core>

namespace footing::sphere {

/// A luminous sphere that is looked for.
struct Target {
  /// Red, green and blue as the camera shows it at the locked exposure, DN. The hue decides which
  /// sphere is which; 30 degrees apart is enough.
  Eigen::Vector3d colour_dn{170, 40, 150};
  double radius_m = 0.0225;  ///< Of a PS Move.
};

/// How a small luminous sphere looks through this camera. Calibrated per controller and camera
/// (`Calibrate`), then held to these deviations.
struct Profile {
  double blur_px = 0.945;  ///< Standard deviation of lens and pixel together.
  double blur_sd_px = 0.02;
  double limb = 0.15;  ///< Brightness falls by limb (1 - cos) from the middle to the edge.
  double limb_sd = 0.02;
};

/// Variance of a pixel: read_dn² + dn_per_electron * value, 1/12 for rounding; times `correlation`
/// where neighbours are not independent (a demosaiced image).
struct PixelNoise {
  double read_dn = 1.5;
  double dn_per_electron = 0.03;
  double correlation = 1;

  /// Of a dark pixel whose neighbours are independent.
  double DarkVariance() const { return read_dn * read_dn + 1.0 / 12; }
};

/// When the rows of a frame see the light. A hand that moves blurs the sphere along its way, and a
/// rolling shutter stretches and slants it.
struct Shutter {
  double exposure_s = 0.004;
  double row_s = 0.0155 / 479;  ///< From one row to the next one.
  double period_s = 1.0 / 60;   ///< From one frame to the next one.
  double speed_sd_mps = 1;      ///< Of a hand, along each axis, as far as nothing is known of it.
};

struct Settings {
  Profile profile;
  PixelNoise noise;
  Shutter shutter;
};

}  // namespace footing::sphere
