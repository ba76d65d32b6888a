#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/held_device.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/pose_run/extra_sensors.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_tracker.h"
#include "daemon/simulation/reconstruction/insole_walk.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// Measurements of simulated boards and hand trackers during a recorded motion, frame by frame,
/// beside the truth: to evaluate the reconstruction on, and to train its models with.
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

/// Person, devices and their errors in a simulated run.
struct Settings {
  double mass_kg = 75;
  std::optional<double> height_m = std::nullopt;
  double rate_hz = 60;   ///< Rate of the inputs.
  double loop_s = 0;     ///< Forwards and backwards for this duration; 0: once.
  bool limited = false;  ///< Boards end at their sensors; else as if they had no edge.
  bool floor = false;    ///< A foot whose COP is beyond its board's plate stands on the floor.
  bool hands = true;
  HandDevice hand_device = HandDevice::kMove;
  /// With kKinect: the joints of its skeleton, too, with what the body hides of it from the camera.
  bool joints = false;
  virtual_sensors::KinectOptions kinect = {};      ///< Options of the joints.
  double hand_noise_m = 0.01;                      ///< White, of each axis; of kMove.
  HeadDevice head = HeadDevice::kNone;             ///< A tracker of the head alone.
  std::vector<reconstruction::BodySite> segments;  ///< Segments with a Wiimote with MotionPlus.
  bool squat_before = true;  ///< So that these know which way they face; else by the motion's own.
  bool perfect_devices =
      false;  ///< For kWiimote and kStraps: they and their mounting have no errors.
  virtual_sensors::CellErrorConfig errors;
  // The boards are not quite where they are configured to be.
  double gap_error_m = 0;    ///< Configured further apart by this.
  double yaw_error_rad = 0;  ///< The right one turned to the left.
  double mass_error = 0;     ///< Excess of the T-pose's weight, as a part.
  std::uint64_t seed = 1;    ///< Seed of the hands.
};

/// Readings of the devices on each arm, by arms::Place.
using ArmReadings =
    std::array<std::array<std::vector<arms::HandReading>, arms::kPlaces>, arms::kArms>;

/// True load, COP and joints of a foot, W.
struct TrueFoot {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_m = Eigen::Vector3d::Zero();
};

/// One frame: the reconstruction's inputs beside the true pose.
struct Frame {
  reconstruction::Inputs inputs;
  Eigen::VectorXd q;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< About C, kg m^2/s.
  std::array<TrueFoot, momentum::kFeet> feet;
  ArmReadings readings;  ///< With kWiimote or kStraps: those since the frame before.
  /// With kKinect: the newest exposure's hands and joints (KinectPoints), which has not come yet.
  std::vector<virtual_sensors::KinectPoint> kinect = {};
  bool kinect_crouches = false;  ///< In it the legs are lost.
};

/// Activity of the person in each frame.
struct Activities {
  std::vector<std::string> names;
  std::vector<int> of_frame;  ///< Index of a name, or -1; empty: not given.
};

/// A simulated run of a person, frame by frame.
struct PoseRun {
  body::Body body;
  double rate_hz = 60;
  std::vector<Frame> frames;    ///< Begins with kStandS in the T-pose.
  double reading_s = 0;         ///< From one reading of a Wiimote to the next; 0: there are none.
  double outside_share = 0;     ///< Share of loaded feet whose COP is beyond the sensors.
  std::size_t judged_from = 0;  ///< The first frame after the calibration.
  double clock_offset_s = 0;    ///< Time on the motion's clock less the frames' time_s.
  Activities activities;
  std::vector<FoundHeading> headings;  ///< At the end, of Settings::segments.
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

/// The same frames without the head and the worn ones of the extra sensors; a whole skeleton stays.
PoseRun WithoutExtras(PoseRun run);

/// Vertical force and COP under each foot at one time: of the scene, and its motion's column then.
using FootForcesAt = std::function<std::array<virtual_sensors::FootForce, momentum::kFeet>(
    double time_s, Eigen::Index column)>;

/// By inverse dynamics. `scene` must outlive it.
FootForcesAt SimulatedForces(const virtual_sensors::Scene& scene);

/// Measurements of boards under these forces and of the hands in a staged scene.
PoseRun RunScene(const virtual_sensors::Scene& scene, const Settings& settings,
                 const FootForcesAt& forces_at);

/// Only the joints of the landmarks are kept (motion::WithLandmarksOnly). `origin` names the clip
/// in errors.
Result<PoseRun> RunPose(const motion::Motion& clip, const Settings& settings,
                        const std::string& origin);

/// The clip with its landmarks only, behind a T-pose of kStandS. `origin` names it in errors.
Result<virtual_sensors::Scene> Stage(const motion::Motion& clip, const Settings& settings,
                                     const std::string& origin);

/// How many frames of settings.rate_hz the scene has, and the motion's column at each.
std::size_t FrameCount(const virtual_sensors::Scene& scene, double rate_hz);
Eigen::Index ColumnAt(const virtual_sensors::Scene& scene, double time_s);

/// Less is not a crouch.
inline constexpr double kCrouchRad = 45 * kPi / 180;

/// A frame, and how far every knee and every hip is bent in it at least: from a straight leg, from
/// a thigh in line with the trunk. A bow leaves the knees straight, a raised knee the other leg.
struct Crouch {
  std::size_t frame = 0;
  double bend_rad = 0;
};

/// Deepest crouch of the true poses, from that frame on, with both feet on the ground. Frame
/// `from` where it never bends or stands.
Crouch DeepestCrouch(const PoseRun& run, std::size_t from);

/// One frame: insoles and hands beside the true pose and loads.
struct InsoleFrame {
  reconstruction::InsoleInputs inputs;
  Eigen::VectorXd q;
  std::array<double, momentum::kFeet> load_n{};
};

/// Measurements of simulated insoles and two hand trackers during a recorded motion, beside the
/// truth.
struct InsoleRun {
  body::Body body;
  double rate_hz = 60;
  std::vector<InsoleFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As RunPose; of the settings' errors, the white noise of a cell counts.
Result<InsoleRun> RunInsoles(const motion::Motion& clip, const Settings& settings,
                             const std::string& origin);

// Plates against markers, by somebody who stands still on them.

/// How far the body's centre of mass is from over the plates' centre of pressure, in the mean of a
/// trial in which a person stands still, where one must be over the other: along x and y of the
/// files' W, m. What plates, markers and the masses of segments are wrong by together. InvalidData
/// when motion and forces have less than a second in common, the person moves or is half supported
/// by something else, or both are further apart than any such error.
Result<Eigen::Vector2d> StandingOffset(const motion::Motion& still,
                                       const motion::GroundForces& forces, const Settings& settings,
                                       const std::string& origin, const std::string& forces_origin);

/// Which devices there are on each arm, by arms::Place.
using Places = std::array<bool, arms::kPlaces>;
inline constexpr Places kFists{true, false, false}, kStrapped{false, true, true};

/// Wiimotes with MotionPlus on both arms of a scene: a sample for every column of its motion.
class HeldHands {
 public:
  HeldHands(const virtual_sensors::Scene& scene, const Places& places, const Settings& settings);

  /// The samples from the last call's column up to this one.
  ArmReadings Until(Eigen::Index column);
  double step_s() const { return step_s_; }

 private:
  struct Device {
    std::size_t arm, place;
    virtual_sensors::HeldCourse course;
    virtual_sensors::HeldErrors errors;
  };
  std::vector<Device> devices_;
  Eigen::Index next_ = 0;
  double step_s_;
};

/// A frame's readings to their devices.
void Feed(const ArmReadings& readings, double reading_s, arms::ArmTracker& tracker);

/// Puts how the arms are held into the inputs, by the readings of the run's devices.
void EstimateArms(arms::ArmTracker tracker, PoseRun& run);

/// Measurements of simulated devices on the arms alone during a recorded motion, beside the truth.
struct ArmFrame {
  ArmReadings readings;
  Eigen::VectorXd q;
};
struct ArmRun {
  body::Body body;
  double rate_hz = 60;           ///< Rate of the frames,
  double reading_s = 0;          ///< and the time from one reading to the next.
  std::size_t aligned = 0;       ///< The frame at whose end the T-pose is known.
  std::vector<ArmFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As RunPose; of the settings the person, rate, loop, seed and perfect_devices count.
Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin, const Places& places = kFists);

// Activity of the person, frame by frame: scores of a clip that mostly stands say little of

/// squats. [begin_s, end_s) on the motion's clock.
struct ActivitySpan {
  double begin_s = 0, end_s = 0;
  std::string activity;
};

/// A table with the head "begin_s,end_s,activity". Spans do not overlap, names have up to 60 bytes.
/// Errors say the line and what was expected.
Result<std::vector<ActivitySpan>> ParseActivities(std::string_view text, const std::string& file);

/// The label of each frame by such a table; frames outside of it have none.
Activities LabelledActivities(const PoseRun& run, const std::vector<ActivitySpan>& spans);

/// By plain rules on the truth, the first that fits:
/// airborne: no foot carries more than 20 N;
/// one_foot: one does;
/// bent: the line from the hips' middle to the neck is more than 35 degrees from the vertical;
/// crouched: the COM is under 90 % of its height in the T-pose;
/// arms: a wrist moves faster than 0.5 m/s against the chest (the neck where there is none);
/// moving: the COM moves faster than 0.1 m/s;
/// still: what is left, upright on both feet.
/// Speeds are differences over 0.1 s around the frame. The first frame stands in the T-pose.
Activities RuledActivities(const PoseRun& run);

}  // namespace footing::pose_run
