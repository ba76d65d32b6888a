#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/stream/device.h"
#include "common/stream/sensor.h"

namespace footing::mounting {

struct SlipConfig {
  double rest_sd_mps2 = 0.5;  ///< Of a second; below it the sensor is at rest.
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
/// What can be sensed, and what a posture can fake:
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
