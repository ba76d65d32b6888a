#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/stream/device.h"
#include "common/stream/sensor.h"

/// Where a worn sensor's axes point, found from standing still and three steps.
///
/// A perfect mounting is the same for every role: while its wearer stands upright with the arms
/// hanging, the sensor's axes x, y, z point to the wearer's left, front, and down. M is the frame
/// of such a sensor, S that of the real one, fixed to the same limb: f_M = R_MS f_S.
///
/// Two of the three degrees of freedom come from gravity at rest, which is (0, 0, -g) in M. The
/// third, about the vertical, comes from the swing: a walking limb swings in the plane of front
/// and down, so the horizontal direction that holds most of the swing is M's y axis. Its sign comes
/// from the first movement, since the steps start with the left foot:
///
///   left leg, right leg   front   a shin that starts from rest swings forward, the left one first
///   right hand            front   the arm goes with the other side's leg
///   left hand             back    and against its own
///   head                  front   the body gains speed
///
/// Right sign matters: turned half about, a limb's phase would be off by half a cycle.
namespace footing::mounting {

/// Limits that the stretches of a mounting procedure must keep.
struct MountingConfig {
  double least_still_s = 1.8;
  double least_steps_s = 1.0;
  double least_rate_hz = 40;
  double longest_gap_s = 0.2;
  /// Standard deviation (root of three axes' variances) that standing still stays under. Counts of
  /// 8 bits that toggle on all axes reach 0.32.
  double still_sd_mps2 = 0.6;
  double gravity_tolerance_mps2 = 1.5;  ///< For the length of the mean at rest.
  /// rms of the steps' horizontal swing that is enough to see its direction.
  double least_swing_mps2 = 0.5;
  /// The swing's variance along its direction against across it.
  double least_ratio = 2.5;
  /// Movement begins where the swing exceeds this share of its peak; the sign there and at the
  /// second share must agree.
  double onset_share = 0.25;
  double sure_share = 0.5;
  double most_residual_rad = 0.2;  ///< 11.5 degrees.
};

/// Result of the mounting procedure: the rotation from S to M, or why it was refused.
struct Mounting {
  bool ok = false;
  std::string problem;                                              ///< Why it was refused.
  Eigen::Quaterniond rotation_MS = Eigen::Quaterniond::Identity();  ///< f_M = rotation_MS * f_S.
  /// How well the parts agree: the larger of gravity's change over the still stretch and the
  /// swing direction's change between the halves of the steps.
  double residual_rad = 0;
};

/// `still` and `steps` are samples of one device as measured (frame S), oldest first. Refused:
/// moved while still, no or too round a swing, an unclear first movement, gaps, too short.
Mounting SolveMounting(stream::DeviceRole role, std::span<const stream::MotionSample> still,
                       std::span<const stream::MotionSample> steps,
                       const MountingConfig& config = {});

/// The sample in M. An axis of M counts as clipped when most of it is an axis of S that is: what
/// lies beyond the end of the range spreads over all axes, but only that one is led by it.
stream::MotionSample Rotated(const Eigen::Quaterniond& rotation_MS,
                             const stream::MotionSample& sample);

/// Thresholds at which a mounted sensor counts as slipped.
struct SlipConfig {
  double rest_sd_mps2 = 0.5;  ///< Over one second; below it the sensor is at rest.
  double rest_s = 3;          ///< Time at rest in the wrong direction.
  double leg_rad = 0.436;     ///< 25 degrees: no standing shin leans so far.
  double upper_rad = 0.873;   ///< Head, trunk; 50 degrees: more than looking down on a screen.
  double swing_mps2 = 1.0;    ///< Horizontal rms of a second that counts as walking.
  double ratio = 4;           ///< Variance along against across that shows a direction.
  double swing_rad = 0.698;   ///< 40 degrees between the swing and M's front.
  double swing_s = 10;        ///< Time of walking, without a second that fits in between.
};

/// Whether a mounted sensor has slipped on its limb, from samples in its frame M. A plain value;
/// stays true until restarted with a new mounting.
///
/// Detectable slips, and the postures that fake them:
/// - Legs, head, trunk: gravity at rest that departs from down. A shin is near the vertical while
///   standing and sitting; kneeling, lying and legs laid up for 3 s are taken for a slip, and so is
///   a head or a trunk held down by 50 degrees.
/// - Wrists: an arm may be held anywhere, so gravity at rest says nothing and is not used.
/// - All: the way of the swing. A band that has turned about the limb swings across its front; an
///   arm that is bent or raised does not leave the plane of front and down. Ten seconds that swing
///   sideways alone are taken for a slip. A slip along the limb, or by less than these angles, is
///   not seen.
class SlipWatch {
 public:
  explicit SlipWatch(stream::DeviceRole role, const SlipConfig& config = {})
      : role_(role), config_(config) {}

  /// Takes the next sample, in M.
  void Advance(const stream::MotionSample& sample_M);
  bool slipped() const { return slipped_; }

 private:
  void CheckSecond();
  void Clear();

  stream::DeviceRole role_;
  SlipConfig config_;
  bool slipped_ = false;
  std::int64_t begin_ns_ = 0;
  std::int64_t last_ns_ = 0;
  int count_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  int wrong_rest_s_ = 0;   ///< Whole seconds in a row.
  int wrong_swing_s_ = 0;  ///< Whole seconds of walking in a row.
};

}  // namespace footing::mounting
