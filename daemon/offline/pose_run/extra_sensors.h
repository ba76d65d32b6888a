#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/held_device.h"
#include "common/virtual/devices/kinect_skeleton.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "daemon/simulation/pose/hand_attitude.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::pose_run {

/// Both hands, then the joints by body::IndexOf.
using KinectPoints =
    std::array<virtual_sensors::KinectPoint, virtual_sensors::KinectSkeleton::kPoints>;

/// Hands and joints as a Kinect's skeleton tracker reports them (virtual_sensors::KinectSkeleton)
/// and as they come to the engine: predicted over their delay by reconstruction::HandTrack.
class KinectBody {
 public:
  /// `step_s` between frames.
  KinectBody(const body::Body& body, std::uint64_t seed, double step_s,
             const virtual_sensors::KinectOptions& options);

  /// The inputs get what has come while the joints are `at`: hands, and joints where
  /// `with_joints`; none of them is valid until the first exposure has come.
  void Advance(const body::Kinematics& at, bool with_joints, reconstruction::Inputs& inputs);
  /// The newest exposure, which has not come yet.
  const KinectPoints& exposed() const { return exposed_; }
  bool crouches() const { return skeleton_.crouches(); }

 private:
  struct Sample {
    double exposed_s;
    KinectPoints points;
  };

  virtual_sensors::KinectSkeleton skeleton_;
  double step_s_, now_s_ = 0, next_s_ = 0;
  KinectPoints exposed_{};
  std::deque<Sample> on_their_way_;
  std::array<reconstruction::HandTrack, virtual_sensors::KinectSkeleton::kPoints> tracks_;
};

// Sensors that a lab may add to boards and hands (docs/evaluation/pose.md). Their random numbers
// are their own: a run with them has the boards and hands of the run without. Source of the place

/// of the head.
enum class HeadDevice {
  kNone,
  kSphere,  ///< A luminous sphere on a cap, as the camera of the hands sees it.
  kKinect,  ///< The head of a Kinect's skeleton: late, with white noise and a slow offset.
};

/// Errors of a tracker of the head.
struct HeadErrors {
  double noise_m = 0.01;  ///< White, along each axis; of kSphere.
  /// For kSphere: how far above the middle of the head the cap has it in the mean, and a standard
  /// deviation along each axis of the head. Constant, and not known.
  double above_m = 0.12, seat_sd_m = 0.02;
  /// For kSphere: how far the head is in the T-pose from where the body's T-pose has it; a standard
  /// deviation along each axis of W.
  double t_pose_sd_m = 0.02;
};

/// A simulated tracker of the head.
class HeadTracker {
 public:
  /// `step_s` between frames.
  HeadTracker(const body::Body& body, HeadDevice device, const HeadErrors& errors,
              std::uint64_t seed, double step_s);

  /// The head of the inputs' joints, while the joints are `at`.
  void Advance(const body::Kinematics& at, bool in_t_pose, reconstruction::Inputs& inputs);

 private:
  HeadDevice device_;
  HeadErrors errors_;
  noise::Random random_;
  body::Point sphere_;
  Eigen::Vector3d t_pose_off_m_;
  KinectBody kinect_;
};

/// Errors of a sensor on a segment beside those of a Wiimote with MotionPlus
/// (virtual_sensors::HeldErrorConfig).
struct BodySensorErrors {
  virtual_sensors::HeldErrorConfig device;
  /// Slip about each axis of the segment, over skin, muscles and clothes: it comes and goes within
  /// such a time.
  double slip_rad = 0.05;
  double slip_s = 0.5;
  double hold_rad = 0.1;  ///< How far a hand is bent in the T-pose, about each axis.
};

/// How well a sensor on a segment has found which way it faces.
struct FoundHeading {
  reconstruction::BodySite site;
  bool known = false;
  double error_rad = 0, sd_rad = 0;  ///< Where known: the error of its mounting, and as stated.
};

/// A simulated Wiimote with MotionPlus on a segment, fastened at any angle, or in a hand.
class BodySensor {
 public:
  BodySensor(const virtual_sensors::Scene& scene, reconstruction::BodySite site,
             const BodySensorErrors& errors, std::uint64_t seed);

  reconstruction::BodySite site() const { return site_; }
  /// A T-pose and one squat before the motion: as deep as people squat, and as far from straight
  /// ahead as they differ. What follows begins in the T-pose.
  void SquatBefore();
  /// How the segment has turned, by the samples up to this column of the scene's motion, `step_s`
  /// after the call before. `squats`: the person does, now.
  arms::HandState Until(Eigen::Index column, double step_s, bool squats);
  /// The T-pose is held and was for some seconds.
  void Align();
  FoundHeading heading() const;

 private:
  void Feel(const Eigen::Vector3d& specific_force_S_mps2,
            const Eigen::Vector3d& angular_velocity_S_radps, bool squats);

  reconstruction::BodySite site_;
  virtual_sensors::HeldCourse course_;
  BodySensorErrors errors_;
  virtual_sensors::HeldErrors device_;
  noise::Random random_;
  /// From the frame S of the course to the device's.
  Eigen::Matrix3d mounting_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d held_ = Eigen::Matrix3d::Identity();  ///< How a wrist was bent in the T-pose.
  arms::SegmentAttitude attitude_;
  bool squatted_before_ = false, aligned_ = false;
  Eigen::Vector3d slip_rad_ = Eigen::Vector3d::Zero();
  Eigen::Index next_ = 0;
  double reading_s_;
};

/// Those of them that there are.
class ExtraSensors {
 public:
  /// `squat_before`: worn sensors find which way they face in a squat before the motion; else in
  /// the motion's own.
  ExtraSensors(const virtual_sensors::Scene& scene, HeadDevice head,
               const std::vector<reconstruction::BodySite>& segments, bool squat_before,
               std::uint64_t seed, double step_s);

  /// Puts what they measure into the inputs of a frame, whose joints are `at`. `in_t_pose`: it
  /// is not complete yet; `aligns`: by now it was held for some seconds; `squats`: the person does.
  void Advance(const body::Kinematics& at, Eigen::Index column, bool in_t_pose, bool aligns,
               bool squats, reconstruction::Inputs& inputs);
  std::vector<FoundHeading> headings() const;

 private:
  std::optional<HeadTracker> head_;
  std::vector<BodySensor> segments_;
  double step_s_;
};

}  // namespace footing::pose_run
