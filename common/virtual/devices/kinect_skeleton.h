#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/stream/hands.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_sensors {

/// Errors of points as a Kinect's skeleton tracker reports them (docs/hands.md): white noise, and
/// an offset common to all of them that changes slowly. It sees 30 frames a second and reports each
/// two frames late.
class KinectErrors {
 public:
  static constexpr double kPeriodS = 1.0 / 30, kLateS = 2.0 / 30;
  static constexpr double kNoiseM = 0.015, kOffsetM = 0.04, kOffsetChangesS = 5;

  explicit KinectErrors(std::uint64_t seed);

  /// The next exposure, kPeriodS after the one before.
  void Expose();
  /// A hand of this exposure where it is reported; the left one first.
  Eigen::Vector3d Measure(const Eigen::Vector3d& p_W_m) { return Measure(p_W_m, random_); }
  /// Another point of it, with noise from elsewhere.
  Eigen::Vector3d Measure(const Eigen::Vector3d& p_W_m, noise::Random& noise) const;
  /// Along each axis, of all errors.
  static double SdM();

 private:
  noise::Random random_;
  Eigen::Vector3d offset_m_;
};

/// A point as a Kinect's skeleton tracker reports it.
struct KinectPoint {
  Eigen::Vector3d true_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  bool hidden = false;  ///< It is not seen, and inferred.
  double sd_m = 1;      ///< Standard deviation of all its errors, along each axis.
};

/// Place and weaknesses of a simulated Kinect.
struct KinectOptions {
  /// Hips below this share of their height in the T-pose: the tracker has lost the legs.
  double crouch_share = 0.85;
  bool hides = true;   ///< False: it sees every point at all times.
  double yaw_rad = 0;  ///< Yaw of the camera about W's origin: at pi/2 the person's left side.
};

/// Both hands and the other joints of a person as a Kinect in front of the boards reports them
/// (docs/skeleton.md): what a part of the body hides from it, and the hips, knees and ankles of who
/// crouches, is inferred with three times the error.
class KinectSkeleton {
 public:
  static constexpr std::size_t kHands = 2;  ///< The first points; then the joints.
  static constexpr std::size_t kPoints = kHands + stream::kBodyJoints;
  static constexpr double kInferredFactor = 3;  ///< As clients/skeleton has it of real ones.
  KinectSkeleton(const body::Body& body, std::uint64_t seed, const KinectOptions& options = {});

  /// The next exposure, KinectErrors::kPeriodS after the one before: the joints are `at`.
  const std::array<KinectPoint, kPoints>& Expose(const body::Kinematics& at);
  /// Whether the person crouched at the last exposure.
  bool crouches() const { return crouches_; }

 private:
  /// A limb: a ball that is drawn from one joint to another.
  struct Limb {
    int from = 0, to = 0;
    double radius_m = 0;
  };

  bool Crouches(const body::Kinematics& at) const;
  bool IsHidden(std::size_t point, const body::Kinematics& at) const;

  KinectOptions options_;
  Eigen::Vector3d camera_W_m_;  ///< 2.4 m away and 1 m high.
  std::array<body::Point, kPoints> points_;
  std::array<int, 2> hips_{};
  double standing_m_ = 0;
  std::vector<Limb> limbs_;
  KinectErrors errors_;
  noise::Random noise_;
  std::array<Eigen::Vector3d, kPoints> wandering_m_;  ///< Error of each point while inferred.
  std::array<KinectPoint, kPoints> seen_;
  bool crouches_ = false;
};

}  // namespace footing::virtual_sensors
