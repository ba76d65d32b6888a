#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/scene.h"
#include "daemon/offline/pose_run/extra_sensors.h"
#include "daemon/offline/pose_run/kinect_body.h"
#include "daemon/simulation/pose/arm_tracker.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// What a recorded motion would have given two boards and two hand trackers, frame by frame, beside
/// the truth: to evaluate the reconstruction on, and to train its models with.
namespace footing::pose_run {

/// A foot or plate under more than this is loaded: below, a centre of pressure is too coarse.
inline constexpr double kLoadedN = 20;

/// Source of the hands.
enum class HandDevice {
  kMove,     ///< Places with white noise.
  kWiimote,  ///< Readings of a Wiimote with MotionPlus in each fist,
  kStraps,   ///< or strapped on each upper arm and forearm.
  kKinect,   ///< Places 30 times a second, late, with white noise and a slow offset.
};

struct Settings {
  double mass_kg = 75;
  std::optional<double> height_m = std::nullopt;
  double rate_hz = 60;   ///< Of the inputs.
  double loop_s = 0;     ///< Forwards and backwards for this duration; 0: once.
  bool limited = false;  ///< Boards end at their sensors; else as if they had no edge.
  bool floor = false;    ///< A foot whose COP is beyond its board's plate stands on the floor.
  bool hands = true;
  HandDevice hand_device = HandDevice::kMove;
  /// Of kKinect: the joints of its skeleton, too, with what the body hides of it from the camera.
  bool joints = false;
  virtual_sensors::KinectOptions kinect = {};  ///< Of the joints.
  double hand_noise_m = 0.01;                  ///< White, of each axis; of kMove.
  HeadDevice head = HeadDevice::kNone;         ///< A tracker of the head alone.
  bool belt = false;                           ///< A Wiimote with MotionPlus on a belt.
  bool perfect_devices =
      false;  ///< Of kWiimote and kStraps: they and their mounting have no errors.
  virtual_sensors::CellErrorConfig errors;
  // The boards are not quite where they are configured to be.
  double gap_error_m = 0;    ///< Configured further apart by this.
  double yaw_error_rad = 0;  ///< The right one turned to the left.
  double mass_error = 0;     ///< What the T-pose weighs too much, as a part.
  std::uint64_t seed = 1;    ///< Of the hands.
};

/// Of the devices on each arm, by arms::Place.
using ArmReadings =
    std::array<std::array<std::vector<arms::HandReading>, arms::kPlaces>, arms::kArms>;

struct TrueFoot {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_m = Eigen::Vector3d::Zero();
};

struct Frame {
  reconstruction::Inputs inputs;
  Eigen::VectorXd q;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< About C, kg m^2/s.
  std::array<TrueFoot, momentum::kFeet> feet;
  ArmReadings readings;  ///< Of kWiimote or kStraps: those since the frame before.
  /// Of kKinect: the newest exposure's hands and joints (KinectPoints), which has not come yet.
  std::vector<virtual_sensors::KinectPoint> kinect = {};
  bool kinect_crouches = false;  ///< In it the legs are lost.
};

/// What the person does in each frame (activity.h).
struct Activities {
  std::vector<std::string> names;
  std::vector<int> of_frame;  ///< Index of a name, or -1; empty: not given.
};

struct PoseRun {
  body::Body body;
  double rate_hz = 60;
  std::vector<Frame> frames;    ///< Begins with kStandS in the T-pose.
  double reading_s = 0;         ///< From one reading of a Wiimote to the next; 0: there are none.
  double outside_share = 0;     ///< Of loaded feet whose COP is beyond the sensors.
  std::size_t judged_from = 0;  ///< The first frame after the calibration.
  double clock_offset_s = 0;    ///< Time on the motion's clock less the frames' time_s.
  Activities activities;
};

/// Duration of the T-pose,
inline constexpr double kStandS = 6;
/// then left for the clip's first frame within such a time; the feet slide over the boards by it.
inline constexpr double kLeaveS = 1.5;
/// By then devices in the hands know that it is held.
inline constexpr double kAlignedS = 5.5;

/// Where both hands are reported: the fists of the pose, with white noise along each axis.
void MeasureHands(const body::Body& body, const body::Kinematics& at, double noise_m,
                  noise::Random& random,
                  std::array<reconstruction::HandInput, reconstruction::kHands>& hands);

/// The same frames without the head and the belt of the extra sensors; a whole skeleton stays.
PoseRun WithoutExtras(PoseRun run);

/// Vertical force and COP under each foot at one time: of the scene, and its motion's column then.
using FootForcesAt = std::function<std::array<virtual_sensors::FootForce, momentum::kFeet>(
    double time_s, Eigen::Index column)>;

/// By inverse dynamics. `scene` must outlive it.
FootForcesAt SimulatedForces(const virtual_sensors::Scene& scene);

/// What boards under these forces and the hands of a staged scene measure.
PoseRun RunScene(const virtual_sensors::Scene& scene, const Settings& settings,
                 const FootForcesAt& forces_at);

/// Only the joints of the landmarks are kept (motion::WithLandmarksOnly). `origin` names the clip
/// in errors.
Result<PoseRun> RunPose(const motion::Motion& clip, const Settings& settings,
                        const std::string& origin);

}  // namespace footing::pose_run
