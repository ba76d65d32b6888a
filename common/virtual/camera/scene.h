#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/virtual/devices/noise.h"

namespace footing::virtual_camera {

/// The simulated camera's lens, pinhole with radial and tangential distortion (Brown's model, the
/// order of OpenCV). Camera frame C: x right, y down, z forward; pixels: the middle of the first
/// one is (0, 0). The estimator has a lens of its own (common/camera), on purpose.
struct Lens {
  int width = 640, height = 480;
  double fx_px = 540, fy_px = 540, cx_px = 319.5, cy_px = 239.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

/// Where a point of C in front of the camera appears, px.
Eigen::Vector2d Project(const Lens& lens, const Eigen::Vector3d& p_C_m);

/// The unit vector in C that is seen at a pixel; Newton's method on the distortion.
Eigen::Vector3d RayThrough(const Lens& lens, const Eigen::Vector2d& pixel);

/// A luminous sphere, as of a PS Move. Brightness is in DN, digital numbers of the 8-bit sensor
/// before clipping, at the exposure of the scene, for red, green and blue.
struct Ball {
  Eigen::Vector3d p_C_m{0, 0, 2};  ///< Centre, while the middle row is exposed.
  Eigen::Vector3d v_C_mps = Eigen::Vector3d::Zero();
  double radius_m = 0.0225;
  Eigen::Vector3d colour_dn{170, 40, 150};
  double limb = 0.15;     ///< Brightness 1 - limb (1 - cos) at the angle from the normal.
  double limb_power = 0;  ///< Not 0: cos to this power in its place.
  double hot_spot = 0.1;  ///< Brighter towards the camera's y by this share.
  double halo = 0;        ///< Share of the light that the lens scatters around the ball.
  double halo_px = 12;    ///< Distance over which the halo falls to 1/e.
};

/// Painted over the background, beneath the balls.
struct Shape {
  enum class Kind { kRectangle, kEllipse };
  Kind kind = Kind::kRectangle;
  Eigen::Vector2d centre_px{0, 0}, half_px{10, 10};
  double turn_rad = 0;
  Eigen::Vector3d colour_dn{0, 0, 0};
};

/// Everything of the image on the far side of a line is hidden: a hand, a sleeve.
struct Occluder {
  Eigen::Vector2d point_px{0, 0};
  Eigen::Vector2d towards_hidden{1, 0};  ///< Unit vector.
  Eigen::Vector3d colour_dn{12, 10, 9};
};

/// The sensor with its optics. A pixel's variance is read_noise² + dn_per_electron * signal.
struct Sensor {
  double psf_px = 0.9;  ///< Standard deviation of the lens's point spread.
  double exposure_s = 0.004;
  double readout_s = 0.0155;  ///< From the first to the last row: a rolling shutter.
  double read_noise_dn = 1.5;
  double dn_per_electron = 0.03;
};

/// All that a rendered frame shows.
struct Scene {
  Lens lens;
  Sensor sensor;
  std::vector<Ball> balls;
  std::vector<Shape> shapes;
  std::vector<Occluder> occluders;
  Eigen::Vector3d background_dn{12, 11, 13};
  Eigen::Vector3d background_slope_dn{4, 3, 2};  ///< From the left to the right edge.
};

/// A frame as the sensor gives it: rows of bytes, mosaic G R / B G (V4L2's SGRBG8).
struct Mosaic {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

/// Time of a row's mid-exposure after that of the middle row, s.
double RowTime(const Scene& scene, double row_px);

/// Where the centre of a ball is at the mid-exposure of the row on which its centre appears, and
/// that time after the middle row's, s. Nothing when it is behind the camera.
struct Seen {
  Eigen::Vector3d p_C_m;
  double after_s = 0;
};
std::optional<Seen> Truth(const Scene& scene, const Ball& ball);

/// A point at this depth (z of C) whose image is in the central `share` of the picture, evenly.
Eigen::Vector3d PlaceInView(const Lens& lens, double depth_m, double share, noise::Random& random);

/// `count` rectangles and ellipses of saturated colours, half of them dim, none as bright as a
/// ball at a good exposure (at most 120 DN), and a white lamp that clips. Shapes that touch one of
/// the scene's balls in the picture and share its colour (less than 25 degrees of hue apart) get
/// another hue: such a ball has no edge there.
void AddClutter(Scene& scene, int count, noise::Random& random);

/// A line that hides this share of the area of a ball's disc, from a random side.
Occluder Hide(const Scene& scene, const Ball& ball, double share, noise::Random& random);

/// Frame of a camera that does not give its mosaic: missing colours as the mean of their
/// neighbours, then BT.601 luma and chroma of two pixels each, Y U Y V.
std::vector<std::uint8_t> ToYuyv(const Mosaic& mosaic);

/// A white sheet with black dots in columns and rows, as footing-camera lens prints it. Its frame:
/// x along the rows, y down the columns, the origin in the middle of the dots.
struct DotSheet {
  int columns = 13, rows = 9;
  double pitch_m = 0.02, radius_m = 0.005, margin_m = 0.02;
  Eigen::Isometry3d X_CS = Eigen::Isometry3d::Identity();
  Eigen::Vector3d paper_dn{180, 190, 170}, ink_dn{20, 22, 21};
};

/// The frame that the sensor reads of a sheet before the scene's background, each pixel 16-fold.
Mosaic RenderSheet(const Scene& scene, const DotSheet& sheet, noise::Random& random);

}  // namespace footing::virtual_camera
