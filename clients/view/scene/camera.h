#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/camera/preview.h"

namespace footing::scene {

/// View point of the picture. World frame W; OpenGL's clip space.
struct Camera {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d(1, 0, 0);
  double vertical_field_rad = 0.80;
  double roll_rad = 0;  ///< Roll of the picture, clockwise positive.
  /// Point, W, about which a person turns the view; nothing: the target.
  std::optional<Eigen::Vector3d> pivot_m;

  /// World to camera: x right, y up, looking along -z. Without a roll the horizon is level.
  Eigen::Matrix4f View() const;
  /// `aspect` is width over height.
  Eigen::Matrix4f Projection(double aspect) const;
};

inline constexpr double kNearM = 0.1;
inline constexpr double kFarM = 300;

/// Subject that the camera follows, in W.
struct Subject {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double heading_rad = 0;
  double speed_mps = 0;
  double turn_radps = 0;  ///< Commanded: known before the heading turns. Left is positive.
  /// Height of the foot or feet that touch, W; nothing in flight.
  std::optional<double> support_m;
};

/// A critically damped spring, x'' = w^2 (goal - x) - 2 w x', stepped exactly.
struct Spring {
  double value = 0;
  double rate = 0;
  void Advance(double goal, double frequency_radps, double dt_s);
};

/// A chase camera: 4.5 m behind and 1.5 m above, on critically damped springs, never rolling. Its
/// look-ahead grows with speed. It looks into a curve from the command on, by what it turns in 0.8
/// s. Its height is that over the ground which carries the subject, so that it does not bob with
/// steps or jumps.
class ChaseCamera {
 public:
  /// Moves on by dt_s in [0, 0.1] (longer is cut). The first call, and a subject that jumped by
  /// more than 2 m, place the camera at once.
  void Advance(const Subject& subject, double dt_s);
  Camera Look() const;

 private:
  void Place(const Subject& subject);

  bool placed_ = false;
  Subject subject_;
  double hips_m_ = 0;  ///< Height of the hips of a subject that stands where this one last stood.
  Spring heading_;
  Spring turn_radps_;
  Spring look_ahead_;
  Spring height_;
  Spring x_, y_;
};

/// Camera from the front and a little from the side, on the boards' middle; it follows a body that
/// walks off them. `beside`: there is a second figure.
class FrontCamera {
 public:
  void Advance(const Eigen::Vector2d& body_m, bool beside, double dt_s);
  Camera Look() const;

 private:
  bool placed_ = false;
  Eigen::Vector2d middle_m_ = Eigen::Vector2d::Zero();
  double distance_m_ = 0;
};

/// Turn, zoom and shift of the view by a person with the mouse; at first none.
struct Orbit {
  double azimuth_rad = 0;    ///< Angle of the eye around the pivot, counter-clockwise from above.
  double elevation_rad = 0;  ///< Elevation of the eye, upwards.
  double distance = 1;       ///< Factor of the eye's distance from the pivot.
  /// Place of the pivot less its place without a shift, in heights of the picture, y down.
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

/// The view turned around its pivot, which goes in the picture only by the shift. The eye stays
/// above the ground and never quite overhead.
Camera Orbited(const Camera& camera, const Orbit& orbit);

/// Turns drags and the wheel of a mouse, and keys, into an orbit. Positions are in heights of the
/// picture, y down.
class MouseOrbit {
 public:
  enum class Drag { kNone, kTurn, kShift };

  void Begin(Drag drag, const Eigen::Vector2d& at);
  void End() { drag_ = Drag::kNone; }
  void Move(const Eigen::Vector2d& at);
  /// Turns as a drag by that many heights of the picture.
  void Turn(const Eigen::Vector2d& by);
  /// Notches of the wheel, positive away from the person: nearer.
  void Scroll(double notches);
  void Reset() { orbit_ = {}; }
  void Set(const Orbit& orbit) { orbit_ = orbit; }
  const Orbit& orbit() const { return orbit_; }

 private:
  Orbit orbit_;
  Drag drag_ = Drag::kNone;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

/// Position of a second figure relative to the first, W: on the floor, not on boards.
inline const Eigen::Vector3d kBesideM{-0.75, -1.30, -0.053};

/// Picture of footing-camera as it is shown in a corner.
struct CameraPreview {
  enum class State {
    kNone,     ///< It is not asked for.
    kAbsent,   ///< Nobody answers at its socket.
    kWaiting,  ///< footing-camera answers, and has sent nothing yet.
    kShown,    ///< There was a picture; its age says whether it still is one.
    kRefused,  ///< It has no picture for this viewer.
  };
  State state = State::kNone;
  std::string address;
  std::string why;  ///< Reason for kAbsent and kRefused.
  /// The last one; null before it. Whoever draws it uses its number to see that it is another one.
  std::shared_ptr<const preview::Picture> picture;
};

/// Age from which on a picture is not called live: five pictures were missed.
inline constexpr double kPreviewStaleS = 0.5;

/// Seconds since the camera saw the picture; 0 without one.
double PreviewAgeS(const CameraPreview& preview, std::int64_t now_ns);

/// Why the picture is not live, and what to do; empty when it is.
std::string PreviewTrouble(const CameraPreview& preview, std::int64_t now_ns);

/// State of a sphere, in one line.
struct PreviewLine {
  std::string text;
  bool is_good = false;  ///< Seen, and well.
};
/// One for each sphere, then one for the pose if the camera has none.
std::vector<PreviewLine> PreviewLines(const preview::Picture& picture);

/// All of it for a terminal, below "Camera"; nothing where it is not asked for.
void AddPreviewLines(const CameraPreview& preview, std::int64_t now_ns,
                     std::vector<std::string>& lines);
/// State of the preview in one line.
std::string PreviewStatus(const CameraPreview& preview, std::int64_t now_ns);

}  // namespace footing::scene
