#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/virtual/devices/held_device.h"
#include "common/virtual/devices/scene.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_tracker.h"

namespace footing::pose_run {

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

/// Puts how the arms are held into the inputs, by the readings of the run's devices. Straps need no
/// model.
void EstimateArms(const std::optional<arms::ArmModel>& model, PoseRun& run);

/// What a recorded motion would have given such devices alone, beside the truth.
struct ArmFrame {
  ArmReadings readings;
  Eigen::VectorXd q;
};
struct ArmRun {
  body::Body body;
  double rate_hz = 60;           ///< Of the frames,
  double reading_s = 0;          ///< and the time from one reading to the next.
  std::size_t aligned = 0;       ///< The frame at whose end the T-pose is known.
  std::vector<ArmFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As RunPose; of the settings the person, rate, loop, seed and perfect_devices count.
Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin, const Places& places = kFists);

}  // namespace footing::pose_run
